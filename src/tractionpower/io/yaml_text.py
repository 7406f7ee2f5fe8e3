"""Plain values to YAML text: rows of a list on one line each, texts quoted wherever a reader could mistake them.

A row that holds rows itself, such as a train with its calls, and a mapping that does, such as a drive with its
magnetisation curve, is written key by key; so is a mapping that is too long for a line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

# Plain only where every YAML reader, also one of version 1.1, sees the same text.
_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_./-]*(?: [A-Za-z0-9_./-]+)*")
_LONGEST = 130
_RESERVED = {"y", "n", "yes", "no", "on", "off", "true", "false", "null", "inf", "nan"}


def scalar(value: Any) -> str:
    r"""Return a scalar as YAML.

    >>> scalar("no"), scalar("Section cabin"), scalar("12:30"), scalar(0.5), scalar(None)
    ('"no"', 'Section cabin', '"12:30"', '0.5', 'null')
    """
    if not isinstance(value, str):
        return json.dumps(value)
    if _PLAIN.fullmatch(value) and value.lower() not in _RESERVED:
        return value
    # A JSON text is a YAML text, but YAML forbids more characters unescaped.
    return "".join(_escaped(letter) for letter in json.dumps(value, ensure_ascii=False))


def _escaped(letter: str) -> str:
    if letter.isprintable():
        return letter
    code = ord(letter)
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def flow(value: Any) -> str:
    """Return a value as YAML on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{scalar(str(key))}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    return scalar(value)


def entry(key: str, value: Any, indent: str = "") -> str:
    """Return one key of a file: a list of mappings as one row per line, anything else on the line of the key if it can."""
    head = f"{indent}{scalar(key)}:"
    if _has_rows(value):
        return "\n".join([head, *(_row(item, indent + "  ") for item in value)])
    line = f"{head} {flow(value)}"
    if isinstance(value, Mapping) and value and (len(line) > _LONGEST or any(map(_has_rows, value.values()))):
        return "\n".join([head, *(entry(str(name), item, indent + "  ") for name, item in value.items())])
    return line


def _row(item: Any, indent: str) -> str:
    if not (isinstance(item, Mapping) and any(map(_has_rows, item.values()))):
        return f"{indent}- {flow(item)}"
    lines = "\n".join(entry(str(name), value, indent + "  ") for name, value in item.items())
    return f"{indent}- {lines.removeprefix(indent + '  ')}"


def _has_rows(value: Any) -> bool:
    return isinstance(value, list | tuple) and any(isinstance(item, Mapping) for item in value)


def document(data: Mapping[str, Any]) -> str:
    """Return a whole file."""
    return "".join(f"{entry(key, value)}\n" for key, value in data.items())

"""Plain values to YAML text: rows of a list on one line each, texts quoted wherever a reader could mistake them."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

# Plain only where every YAML reader, also one of version 1.1, sees the same text.
_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_./-]*(?: [A-Za-z0-9_./-]+)*")
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


def entry(key: str, value: Any) -> str:
    """Return one key of a file: a list of mappings as one row per line, anything else on the line of the key."""
    if isinstance(value, list | tuple) and any(isinstance(item, Mapping) for item in value):
        return "\n".join([f"{key}:", *(f"  - {flow(item)}" for item in value)])
    return f"{key}: {flow(value)}"


def document(data: Mapping[str, Any]) -> str:
    """Return a whole file."""
    return "".join(f"{entry(key, value)}\n" for key, value in data.items())

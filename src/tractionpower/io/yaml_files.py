"""YAML 1.2 to plain Python values, with the line of every key and list item.

The text is composed to nodes by ruamel.yaml and the values are made here: numbers, true/false and null of the YAML 1.2
core schema, everything else stays the text it is. An unquoted 12:30, n or 010 is text: none of them is a number that
everybody reads alike.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode
from ruamel.yaml.reader import ReaderError

from tractionpower.errors import InputError, Problem
from tractionpower.io.provenance import Loc, Mark, list_mark, path_of
from tractionpower.io.text_files import Source, read_text
from tractionpower.io.wording import printable, shown

LIMIT_MB = 20
MOST_ALIAS_NODES = 100_000
"""Values that aliases (``*name``) may add to a file; more is taken for an attack."""
DEEPEST = 40

_INTEGER = re.compile(r"[-+]?(?:0|[1-9]\d*)|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(?:\.\d+|\d+(?:\.\d*)?)(?:[eE][-+]?\d+)?")
_SPECIAL = {".inf": "inf", "+.inf": "inf", "-.inf": "-inf", ".nan": "nan"}
_WORDS = {"": None, "~": None, "null": None, "true": True, "false": False}
_TAGS = tuple(f"tag:yaml.org,2002:{name}" for name in ("map", "seq", "str", "int", "float", "bool", "null", "timestamp", "merge"))


@dataclass(slots=True)
class Document:
    """A file as read: its top mapping, the lines, and what was wrong without hindering the reading."""

    data: dict[str, Any]
    mark: Mark
    problems: list[Problem] = field(default_factory=list)


def read_yaml(source: Source) -> Document:
    """Read a YAML file whose top level is a mapping.

    Raises
    ------
    InputError
        With one problem, if the file cannot be read, is empty, no YAML, no mapping, nested too deeply, or grows
        beyond `MOST_ALIAS_NODES` by aliases.
    """
    node = _compose(source, read_text(source, LIMIT_MB))
    if node is None:
        remedy = "`tractionpower new DIR` writes a study to start from"
        raise source.fail("empty_file", "the file is empty", "keys and values (key: value)", remedy)
    if not isinstance(node, MappingNode):
        found = shown(node.value) if isinstance(node, ScalarNode) else "a list"
        raise source.fail("not_a_mapping", f"the file holds {found}", "keys and values (key: value)", line=_line(node))
    builder = _Builder(source)
    data, mark = builder.build(node, ())
    return Document(data, mark, builder.told(data))


def plain_value(text: str) -> Any:
    """Return the value of an unquoted scalar by the YAML 1.2 core schema; leading zeros keep it a text.

    >>> plain_value("1e3"), plain_value("0x10"), plain_value("12:30"), plain_value("010")
    (1000.0, 16, '12:30', '010')
    """
    if text in _WORDS or (text in (text.capitalize(), text.upper()) and text.lower() in _WORDS):
        return _WORDS[text.lower()]
    if _INTEGER.fullmatch(text):
        # Python refuses to convert very long digit strings; as a float they become infinite, which is told later.
        base = {"0o": 8, "0x": 16}.get(text[:2], 10)
        return int(text.removeprefix("0o"), base) if len(text) <= 300 else float("inf")
    if text.lower() in _SPECIAL:
        return float(_SPECIAL[text.lower()])
    if _FLOAT.fullmatch(text) and not re.match(r"[-+]?0\d", text):
        return float(text)
    return text


def _compose(source: Source, text: str) -> Node | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an anchor that is used again is legal YAML
            node: Node | None = YAML(typ="safe", pure=True).compose(text)
            return node
    except MarkedYAMLError as error:
        raise _syntax_error(source, text, error) from None
    except ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        found = f"a character that YAML forbids: {shown(text[error.position])}"
        raise source.fail("syntax_error", found, "text", "is it the right file? save it as plain text", line) from None
    except RecursionError:
        raise source.fail("too_deep", "the file is nested too deeply", f"at most {DEEPEST} levels") from None
    except (YAMLError, ValueError, AttributeError, TypeError) as error:  # ruamel lets some malformed texts through to Python
        raise source.fail("syntax_error", f"no YAML: {printable(str(error).splitlines()[0])}") from None


def _syntax_error(source: Source, text: str, error: MarkedYAMLError) -> InputError:
    mark = error.problem_mark or error.context_mark
    line = mark.line + 1 if mark is not None else 0
    lines = text.splitlines()
    content = lines[line - 1] if 0 < line <= len(lines) else ""
    if re.match(r" *\t", content):
        return source.fail("tab", "a tab for indentation", "blanks", "replace the tabs by blanks", line)
    words = printable(" ".join(part for part in (error.context, error.problem) if part))
    return source.fail("syntax_error", f"no YAML: {words}: {shown(content.strip())}", line=line)


def _line(node: Node) -> int:
    return int(node.start_mark.line) + 1


class _Builder:
    """Turns nodes into values and marks, and notes duplicate keys on the way."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._notes: list[tuple[Loc, str, str, str, int]] = []
        self._seen: set[int] = set()
        self._open: set[int] = set()
        self._from_aliases = 0

    def build(self, node: Node, loc: Loc) -> tuple[Any, Mark]:
        """Return value and mark of a node."""
        self._guard(node, loc)
        mark = Mark(self._source.label, _line(node))
        if node.tag not in _TAGS:
            self._notes.append((loc, "unknown_tag", f"the tag {printable(str(node.tag))}", "no tags", _line(node)))
        if isinstance(node, ScalarNode):
            is_text = node.style is not None or node.tag == _TAGS[2]
            value = node.value if is_text else plain_value(node.value)
            mark.written = node.value if isinstance(value, float) else ""
            return value, mark
        self._open.add(id(node))
        build = self._mapping if isinstance(node, MappingNode) else self._sequence
        data = build(node, loc, mark)
        self._open.discard(id(node))
        return data, mark

    def told(self, data: Any) -> list[Problem]:
        """Return what was noted, as problems with model paths."""
        source = self._source
        return [
            Problem(code, path_of(source.root, loc, data), found, allowed, place=f"{source.label}:{line}")
            for loc, code, found, allowed, line in self._notes
        ]

    def _guard(self, node: Node, loc: Loc) -> None:
        line = _line(node)
        if id(node) in self._open:
            raise self._source.fail("alias", "an alias that contains itself", line=line)
        if len(loc) > DEEPEST:
            raise self._source.fail("too_deep", "the file is nested too deeply", f"at most {DEEPEST} levels", line=line)
        self._from_aliases += id(node) in self._seen
        self._seen.add(id(node))
        if self._from_aliases > MOST_ALIAS_NODES:
            found = f"aliases (*name) add more than {MOST_ALIAS_NODES} values"
            raise self._source.fail("alias", found, f"at most {MOST_ALIAS_NODES}", "write the values out", line)

    def _sequence(self, node: Node, loc: Loc, mark: Mark) -> list[Any]:
        items = []
        for index, child in enumerate(node.value):
            value, mark.children[index] = self.build(child, (*loc, index))
            items.append(value)
        list_mark(mark, items)
        return items

    def _mapping(self, node: Node, loc: Loc, mark: Mark) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key_node, value_node in node.value:
            if not isinstance(key_node, ScalarNode):
                self._notes.append((loc, "bad_key", "a key that is a list or a mapping", "a text", _line(key_node)))
                continue
            key, line = str(key_node.value), _line(key_node)
            value, child = self.build(value_node, (*loc, key))
            if key in data:
                found = f"the key {shown(key)} a second time, first in line {mark.children[key].line}"
                self._notes.append(((*loc, key), "duplicate_key", found, "each key once", line))
                continue
            child.line = line  # the key's line is where a reader looks
            data[key], mark.children[key] = value, child
        return data

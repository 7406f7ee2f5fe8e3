"""Where a value came from: a tree from model paths to file and line, kept outside the models.

Grammar of a model path: names are joined by dots; the items of a list stand in square brackets, a thing that has an
``id`` by its id (``supply.substations[A].km``), a row of the limits by system and name (``limits[dc3000 u_max2]``), one of
the conductors by kind and name (``conductors[rail 60E1]``), any other item by its index from 0
(``line.gradients[7].to_km``), and so are items that share an id. Free keys of a mapping stand in brackets too. An index is
understood for things with an id as well, but an id wins: ``line.tracks[1]`` is the track whose id is 1.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.wording import shorten

Loc = tuple[str | int, ...]

_TOKEN = re.compile(r"\[([^\]]*)\]|\.?([^.\[\]]+)")


@dataclass(slots=True)
class Mark:
    """File and line of a value, and the marks of what it holds.

    Attributes
    ----------
    file, line
        Name of the file relative to the study's folder; line from 1, or 0 when only the file is known.
    children
        Marks by key (text) or index (whole number).
    ids
        Index of the children of a list by their identifier.
    is_row
        Whether this is a row of a CSV file: its cells share its line and are told by their column.
    written
        How a number stands in the file; empty for anything else.
    """

    file: str
    line: int = 0
    children: dict[str | int, Mark] = field(default_factory=dict)
    ids: dict[str, int] = field(default_factory=dict)
    is_row: bool = False
    written: str = ""

    @property
    def place(self) -> str:
        """File and line as people and editors read it, ``line.yaml:12``."""
        return f"{self.file}:{self.line}" if self.line else self.file

    def child(self, token: str | int) -> Mark | None:
        """Return the mark of a key, an identifier or an index; an identifier wins over an index given as text."""
        if token in self.children:
            return self.children[token]
        if isinstance(token, int):
            return None
        index = self.ids.get(token)
        if index is None and token.isdecimal() and len(token) < 10:
            index = int(token)
        if index is not None:
            return self.children.get(index)
        return self.children.get(token[:-1]) if token.endswith("_") else None

    def find(self, tokens: Iterable[str | int]) -> Mark:
        """Return the mark of the last of `tokens` that is known, starting here."""
        mark = self
        for token in tokens:
            child = mark.child(token)
            if child is None:
                break
            mark = child
        return mark


def item_name(item: Any) -> str | None:
    """Return the name by which a path addresses an item of a list, or None if that is its index."""
    if not isinstance(item, dict):
        return None
    if {"system", "name", "value"} <= item.keys():
        return f"{item['system']} {item['name']}"
    if {"kind", "name"} <= item.keys() and "id" not in item:
        return f"{item['kind']} {item['name']}"
    name = item.get("id")
    if isinstance(name, bool) or not isinstance(name, str | int):
        return None
    return None if re.search(r"[\[\]]", str(name)) else str(name)


def list_mark(mark: Mark, items: Sequence[Any]) -> Mark:
    """Fill the identifiers of `items` into the mark of their list and return it."""
    for index, item in enumerate(items):
        name = item_name(item)
        if name is not None:
            mark.ids[name] = index
    return mark


def split_path(path: str) -> list[str]:
    """Return the parts of a model path.

    >>> split_path("supply.substations[A.1].km")
    ['supply', 'substations', 'A.1', 'km']
    """
    return [bracket or name for bracket, name in _TOKEN.findall(path)]


def path_of(root: str, loc: Loc, data: Any) -> str:
    """Return the model path of the place `loc` in `data`, which stands at `root` of the model."""
    path = root
    for token in loc:
        if isinstance(token, int):
            items = data if isinstance(data, list | tuple) else ()
            data = items[token] if token < len(items) else None
            name = item_name(data)
            is_own = name is not None and sum(item_name(item) == name for item in items) == 1
            path += f"[{shorten(name) if name is not None and is_own else token}]"
        else:
            is_name = re.fullmatch(r"\w+", token) and not token[0].isdigit()
            path += (f".{token}" if path else token) if is_name else f"[{shorten(token)}]"
            data = data.get(token) if isinstance(data, dict) else None
    return path


def told_once(problems: Iterable[Problem], *, by_cell: bool = False) -> list[Problem]:
    """Return `problems` without what a CSV file that stands for several lists tells again at the same line.

    With `by_cell` the paths below the row must be equal too; else `found` names the column.
    """
    kept: dict[object, Problem] = {}
    for k, problem in enumerate(problems):
        file, _, line = problem.place.rpartition(":")
        is_row = line.isdecimal()
        cell = problem.path.rpartition("]")[2] if by_cell and is_row else ""
        key = (problem.code, problem.place, problem.found, frozenset(problem.allowed.split(", ")), cell)
        is_table = (file if is_row else problem.place).lower().endswith(".csv")
        kept.setdefault(key if is_table else k, problem)
    return list(kept.values())


def _overlay(mark: Mark, tokens: Sequence[str], place: str) -> None:
    """Let a place below `mark`, and all below it, come from `place`."""
    for k, token in enumerate(tokens):
        if token == "*":
            for child in mark.children.values():
                _overlay(child, tokens[k + 1 :], place)
            return
        found = mark.child(token)
        if found is None or k == len(tokens) - 1:
            found = Mark(place if k == len(tokens) - 1 else mark.file, 0 if k == len(tokens) - 1 else mark.line)
            mark.children[_key_of(mark, token)] = found
        mark = found


def _key_of(mark: Mark, token: str) -> str | int:
    """Return under which key a mark holds, or would hold, the child that a token names."""
    if token in mark.children:
        return token
    if token in mark.ids:
        return mark.ids[token]
    return int(token) if token.isdecimal() and int(token) in mark.children else token


class Provenance:
    """The files and lines of one scenario.

    Parameters
    ----------
    root
        Mark of the whole scenario: the study file, with the marks of the files that it names in their places.
    """

    def __init__(self, root: Mark) -> None:
        self._root = root

    def locate(self, path: str) -> str:
        """Return ``file:line`` of a model path, or of its nearest ancestor that stands in a file."""
        return self._root.find(split_path(path)).place

    def overlaid(self, places: Iterable[tuple[str, str]]) -> Provenance:
        """Return a provenance in which model paths, and all below them, come from elsewhere: from an option of a command.

        Parameters
        ----------
        places
            Path, and where it now comes from.
        """
        other = copy.copy(self)
        other._root = copy.deepcopy(self._root)
        for path, place in places:
            _overlay(other._root, split_path(path), place)
        return other

    def place(self, problems: Iterable[Problem]) -> list[Problem]:
        """Return `problems` with file and line filled in where they are still empty, each told once."""
        placed = [problem if problem.place else replace(problem, place=self.locate(problem.path)) for problem in problems]
        return told_once(placed, by_cell=True)

"""The configuration of Arshad et al. (.INI): keys as printed, with or without section headers, values with units."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from tractionpower.errors import InputError, Problem
from tractionpower.io.arshad.keys import FILLED, KEYS, PRINTED, Key
from tractionpower.io.arshad.units import Told, read_quantity
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import Source, read_text
from tractionpower.io.wording import did_you_mean, shown

LIMIT_MB = 1

OF_KEYS = ("unknown_key", "duplicate_key")
"""Codes of errors that leave every key with a value: its own, or its default."""

_COMMENT = re.compile(r"(?:^|\s)[#;].*")
_SECTION = re.compile(r"\[[^\]]*\]")
_BY_SPELLING = {" ".join(spelling.lower().split()): key for key in KEYS for spelling in key.spellings}


@dataclass(slots=True)
class Settings:
    """A configuration as read.

    Attributes
    ----------
    label
        Name of the file in messages.
    values
        Value by name of the key, in the units of the declarations; None where nothing is said or assumed.
    texts
        How the value is written, by name of the key: in the file, or the default.
    lines
        Line of each key that the file gives.
    """

    label: str
    values: dict[str, float | str | None] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)

    def is_given(self, name: str) -> bool:
        """Return whether the file gives a key."""
        return name in self.lines

    def number(self, name: str) -> float:
        """Return the value of a key that has one."""
        value = self.values[name]
        assert isinstance(value, float)
        return value

    def optional(self, name: str) -> float | None:
        """Return the value of a key, or None."""
        value = self.values[name]
        return value if isinstance(value, float) else None

    def text(self, name: str) -> str:
        """Return the text of a key; empty if it has none."""
        value = self.values[name]
        return value if isinstance(value, str) else ""

    def mark(self, name: str) -> Mark:
        """Return where a key stands; the file alone where it is left out."""
        return Mark(self.label, self.lines.get(name, 0))

    def problem(self, name: str, code: str, found: str, allowed: str = "", remedy: str = "") -> Problem:
        """Return a problem of a key."""
        return Problem(code, spelling_of(name), found, allowed, remedy, place=self.mark(name).place)

    def assumed(self) -> list[str]:
        """Return what stands in for keys that the file leaves out, each with its source."""
        return [
            f"{key.spellings[0]} {self.texts[key.name]} ({key.source})"
            for key in KEYS
            if key.kind != "file" and key.source and key.name in self.texts and not self.is_given(key.name)
        ]


def spelling_of(name: str) -> str:
    """Return how a key is written."""
    return next(key.spellings[0] for key in KEYS if key.name == name)


def read_settings(reader: Reader, source: Source) -> Settings | None:
    """Read a configuration; None if it cannot be read at all. `reader` collects what is wrong.

    Where a value is wrong the default stands in for it, so that the files that it names can be read in the same
    breath. The keys may stand under any sections, or under none as in the paper. ``#`` and ``;`` begin a comment.
    """
    try:
        entries = _entries(source)
    except InputError as error:
        reader.problems += error.problems
        return None
    settings = Settings(source.label)
    problems: list[Problem] = []
    for written, text, line in entries:
        problems += _take(settings, source, written, text, line)
    for key in KEYS:
        if key.name in settings.values:
            continue
        if key.default is None:
            told = f"no key {key.spellings[0]}"
            problems.append(source.problem("missing_key", told, remedy=f"add a line {key.spellings[0]} = ..."))
        settings.values[key.name] = _default(settings, key)
    reader.problems += problems
    return settings


def _take(settings: Settings, source: Source, written: str, text: str, line: int) -> Iterable[Problem]:
    key = _BY_SPELLING.get(written)
    if key is None:
        known = [key.spellings[0] for key in PRINTED] + [f"and {len(FILLED)} keys of ours (docs/dynamics-arshad.md)"]
        remedy = did_you_mean(written, [spelling for key in KEYS for spelling in key.spellings])
        return [source.problem("unknown_key", f"the key {shown(written)}", ", ".join(known), remedy, line)]
    if key.name in settings.lines:
        found = f"the key {key.spellings[0]} a second time, first in line {settings.lines[key.name]}"
        return [source.problem("duplicate_key", found, "each key once", "delete one", line)]
    settings.lines[key.name], settings.texts[key.name] = line, text
    value = _value(key, text)
    settings.values[key.name] = _default(settings, key) if isinstance(value, Told) else value
    if isinstance(value, Told):
        place = f"{source.label}:{line}"
        return [Problem("bad_value", key.spellings[0], value.found, value.allowed, value.remedy, place=place)]
    return []


def _default(settings: Settings, key: Key) -> float | str | None:
    if not key.default:
        return None
    settings.texts[key.name] = key.default
    value = _value(key, key.default)
    assert not isinstance(value, Told)
    return value


def _value(key: Key, text: str) -> float | str | Told:
    if key.kind in ("file", "text"):
        return text if text else Told("nothing", "a name")
    if key.kind == "choice":
        if text.lower() in key.choices:
            return text.lower()
        return Told(shown(text), ", ".join(key.choices), did_you_mean(text, key.choices))
    value = read_quantity(text, key.kind)  # type: ignore[arg-type]  # what is no dimension has been told apart
    if isinstance(value, Told):
        return value
    if not (key.least <= value <= key.most and math.isfinite(value)):
        return Told(shown(text), _bounds(key))
    return value


def _bounds(key: Key) -> str:
    # In the units of the declarations; bounds near 0 only keep 0 itself out.
    unit = {
        "time": " s",
        "length": " m",
        "stiffness": " kN/mm",
        "damping": " kN s/m",
        "angle": "°",
        "pressure": " bar",
        "speed": " m/s",
    }
    suffix = unit.get(key.kind, "")
    low = "above 0" if key.least < 1e-3 and key.least > 0 else f"at least {key.least:g}{suffix}"
    return low if math.isinf(key.most) else f"{low}, at most {key.most:g}{suffix}"


def _entries(source: Source) -> list[tuple[str, str, int]]:
    # Key as normalised, value and line of each entry, in the order of the file. Not by configparser: it forgets the lines that
    # messages name, stops at the first doubled key, and takes the indented lines of the paper for values that go on.
    entries, bad = [], []
    for number, line in enumerate(read_text(source, LIMIT_MB).splitlines(), 1):
        text = _COMMENT.sub("", line).strip()
        written, equals, value = text.partition("=")
        if not text or _SECTION.fullmatch(text):
            continue
        if not equals or not written.strip():
            found = f"a line without a key and =: {shown(text)}"
            bad.append(source.problem("syntax_error", found, "KEY = VALUE, or [SECTION]", line=number))
        entries.append((" ".join(written.lower().split()), value.strip(), number))
    if bad:
        raise InputError(bad)
    if not entries:
        raise source.fail("empty_file", "the file has no key", "lines KEY = VALUE")
    return entries

"""What is varied: paths of inputs with the values that they take, or with the range that values are drawn from.

A value is kept as the text that stands behind the ``=`` of a change, so that ``run STUDY --set`` repeats a case.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.errors import InputError, Problem, UsageError
from tractionpower.model.change import parse_scalar

_KEY = re.compile(r"(?P<path>(?:[^=\[\]]|\[[^\[\]]*\])+)=(?P<rest>.*)", re.DOTALL)
_PAIRS = {"[": "]", "{": "}"}


@dataclass(frozen=True, slots=True)
class Varied:
    """A path and the values that it takes, as they are written."""

    path: str
    values: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Range:
    """A path and the range that its values are drawn from; with `is_log` their logarithms are even."""

    path: str
    low: float
    high: float
    is_log: bool = False
    is_integer: bool = False


def parse_varied(texts: Sequence[str]) -> tuple[Varied, ...]:
    """Return what ``KEY=V1,V2,...`` stands for; a comma inside brackets, braces or quotes is part of a value.

    Raises
    ------
    InputError
        With all that cannot be read.
    """
    found, problems = [], list[Problem]()
    for text in texts:
        match = _KEY.fullmatch(text.strip())
        path, values = (match["path"].strip(), split_values(match["rest"])) if match else (text, [])
        if not values or not all(values):
            problems.append(_bad(path, f"{text!r} names no values", "KEY=V1,V2,...", "write null as a value to clear an input"))
        elif len(set(values)) < len(values):
            twice = next(value for value in values if values.count(value) > 1)
            problems.append(_bad(path, f"the value {twice} twice", "each value once"))
        else:
            found.append(Varied(path, tuple(values)))
    problems += _repeated([item.path for item in found])
    if problems:
        raise InputError(problems)
    return tuple(found)


def varied_of(vary: Mapping[str, Sequence[Any]]) -> tuple[Varied, ...]:
    """Return what a mapping from paths to values stands for; see `text_of`.

    Raises
    ------
    InputError
        If a path has no values, or one of them twice.
    """
    found, problems = [], list[Problem]()
    for path, values in vary.items():
        if isinstance(values, str) or not isinstance(values, Sequence):
            problems.append(_bad(path, f"the single value {values!r}", "a list of values", f"write [{values!r}]"))
            continue
        texts = tuple(text_of(value) for value in values)
        if not texts or len(set(texts)) < len(texts):
            problems.append(_bad(path, "no values" if not texts else "a value twice", "a list of different values"))
        found.append(Varied(path, texts))
    if problems:
        raise InputError(problems)
    return tuple(found)


def parse_ranges(texts: Sequence[str]) -> tuple[Range, ...]:
    """Return what ``KEY=LOW..HIGH`` or ``KEY=log:LOW..HIGH`` stands for; with two whole numbers, values stay whole.

    >>> parse_ranges(["supply.substations[A].units=1..4"])[0].is_integer
    True

    Raises
    ------
    InputError
        With all that cannot be read.
    """
    found, problems = [], list[Problem]()
    for text in texts:
        match = _KEY.fullmatch(text.strip())
        first, dots, last = match["rest"].strip().partition("..") if match else ("", "", "")
        if match is None or not dots:
            problems.append(_bad(match["path"] if match else text, f"{text!r} is no range", "KEY=LOW..HIGH or KEY=log:LOW..HIGH"))
            continue
        is_log = first.startswith("log:")
        path, low, high = match["path"].strip(), _number(first.removeprefix("log:")), _number(last)
        problem = _wrong_bounds(path, low, high, is_log)
        if problem is not None:
            problems.append(problem)
        elif low is not None and high is not None:
            is_whole = isinstance(low, int) and isinstance(high, int)
            found.append(Range(path, float(low), float(high), is_log, is_whole))
    problems += _repeated([item.path for item in found])
    if problems:
        raise InputError(problems)
    return tuple(found)


def range_of(path: str, bounds: Any) -> Range:
    """Return the range of a path from ``(low, high)``, ``(low, high, "log")`` or a text such as ``log:0.05..0.2``."""
    if isinstance(bounds, str):
        return parse_ranges([f"{path}={bounds}"])[0]
    low, high, *more = bounds
    prefix = "log:" if more == ["log"] else ""
    if more and not prefix:
        raise UsageError(f"range of {path}: {more[0]!r} after the bounds; allowed is 'log' or nothing")
    return parse_ranges([f"{path}={prefix}{text_of(low)}..{text_of(high)}"])[0]


def split_values(text: str) -> list[str]:
    """Return the values between commas; a comma inside brackets, braces or quotes does not split.

    >>> split_values('2, 3,{"kind": "to_time", "share": 1},"a,b"')
    ['2', '3', '{"kind": "to_time", "share": 1}', '"a,b"']
    """
    values, start, closing, quote, is_escaped = [], 0, list[str](), "", False
    for k, letter in enumerate(text):
        if quote:
            if letter == quote and not is_escaped:
                quote = ""
            is_escaped = letter == "\\" and not is_escaped and quote == '"'
        elif letter == '"' or (letter == "'" and not text[start:k].strip()):  # an apostrophe within a word is no quote
            quote = letter
        elif letter in _PAIRS:
            closing.append(_PAIRS[letter])
        elif closing and letter == closing[-1]:
            closing.pop()
        elif letter == "," and not closing:
            values.append(text[start:k].strip())
            start = k + 1
    return [*values, text[start:].strip()]


def text_of(value: Any) -> str:
    """Return a value of Python as it is written behind the ``=`` of a change.

    >>> [text_of(value) for value in (2, 0.1, None, True, "bypassed", "3", [1, 2])]
    ['2', '0.1', 'null', 'true', 'bypassed', '"3"', '[1, 2]']
    """
    if isinstance(value, str):
        is_plain = value.strip() == value != "" and value[0] not in "[{\"'" and parse_scalar(value) == value
        return value if is_plain else json.dumps(value, ensure_ascii=False)
    if hasattr(value, "item"):  # a number of numpy
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        raise UsageError(f"the value {value!r} is no number that an input may have")
    return json.dumps(value, ensure_ascii=False)


def _number(text: str) -> float | int | None:
    value = parse_scalar(text) if text.strip()[:1] not in {"'", '"'} else None  # a number in quotes is a text
    return value if isinstance(value, int | float) and not isinstance(value, bool) else None


def _wrong_bounds(path: str, low: float | None, high: float | None, is_log: bool) -> Problem | None:
    if low is None or high is None:
        return _bad(path, "a bound of the range that is no number", "LOW..HIGH, two numbers")
    if not low < high:
        return _bad(path, f"the range {low:g}..{high:g}", "LOW below HIGH")
    if is_log and low <= 0.0:
        return _bad(path, f"log:{low:g}..{high:g}", "bounds above 0 for an even logarithm", "leave log: out")
    return None


def _repeated(paths: Sequence[str]) -> list[Problem]:
    twice = sorted({path for path in paths if paths.count(path) > 1})
    return [_bad(path, "the path twice", "each path once", "name all its values together") for path in twice]


def _bad(path: str, found: str, allowed: str = "", remedy: str = "") -> Problem:
    return Problem("bad_variation", path, found, allowed, remedy)

"""The cases of a sweep: grids, lists, random samples; what is varied twice or not at all is told before anything runs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from tractionpower.errors import InputError, Problem
from tractionpower.model.change import parse_scalar
from tractionpower.studies.runner.case import Case
from tractionpower.studies.sweep.keys import Range, Varied, text_of

BASE = "base"
MOST_CASES = 100_000
"""Cases beyond which a sweep is taken for a slip."""

Values = Mapping[str, str]
"""What one case sets: texts by path."""


def grid(varied: Sequence[Varied]) -> list[dict[str, str]]:
    """Return all combinations of the values, the last key varying fastest."""
    count = math.prod(len(item.values) for item in varied)
    if count > MOST_CASES:
        sizes = " x ".join(str(len(item.values)) for item in varied)
        remedy = "draw some of them with --sample and --range"
        raise InputError([Problem("too_many_cases", "", f"{count} cases: {sizes}", f"up to {MOST_CASES}", remedy)])
    paths = [item.path for item in varied]
    return [dict(zip(paths, values, strict=True)) for values in itertools.product(*(item.values for item in varied))]


def drawn(ranges: Sequence[Range], count: int, seed: int) -> list[dict[str, str]]:
    """Return `count` cases with values drawn evenly from ranges.

    Each path has a stream of its own, made of the seed and its place among the sorted paths; so more cases begin with the same
    ones, and the order in which ranges are given does not matter.
    """
    order = sorted(item.path for item in ranges)
    streams = {path: np.random.default_rng([seed, k]) for k, path in enumerate(order)}
    columns = {item.path: _draw(item, streams[item.path].random(count)) for item in ranges}
    return [{path: values[k] for path, values in columns.items()} for k in range(count)]


def _draw(item: Range, shares: np.ndarray) -> list[str]:
    """Return values at `shares` (0 to 1) of a range; whole numbers are equally likely, or their logarithms even."""
    low, high = (item.low - 0.5, item.high + 0.5) if item.is_integer else (item.low, item.high)
    if item.is_log:
        low, high = math.log(low), math.log(high)
    values = low + (high - low) * shares
    values = np.exp(values) if item.is_log else values
    if item.is_integer:
        return [str(int(value)) for value in np.clip(np.rint(values), item.low, item.high)]
    return [text_of(float(f"{value:.6g}")) for value in np.clip(values, item.low, item.high)]


def crossed(*lists: Sequence[Values]) -> list[dict[str, str]]:
    """Return every combination of cases of several lists; a list without cases has no say.

    Raises
    ------
    InputError
        If two lists set the same path.
    """
    told = [cases for cases in lists if cases]
    problems = []
    for first, second in itertools.combinations(told, 2):
        shared = sorted({path for case in first for path in case} & {path for case in second for path in case})
        problems += [Problem("bad_variation", path, "it is varied in two ways at once", "one of them") for path in shared]
    if problems:
        raise InputError(problems)
    return [dict(itertools.chain.from_iterable(case.items() for case in cases)) for cases in itertools.product(*told)]


def as_cases(values: Sequence[Values], names: Sequence[str] = ()) -> tuple[Case, ...]:
    """Return the base case and one case for each of `values`, numbered where they have no names."""
    width = max(len(str(len(values))), 2)
    short = short_names(path for case in values for path in case)
    cases = [Case(BASE, (), kind=BASE, subject="nothing is changed", base=True)]
    for number, each in enumerate(values, 1):
        name = names[number - 1] if names else f"{number:0{width}d}"
        subject = ", ".join(f"{short[path]}={value}" for path, value in each.items())
        cases.append(Case(name, tuple(f"{path}={value}" for path, value in each.items()), subject=subject))
    return tuple(cases)


def short_names(paths: Iterable[str]) -> dict[str, str]:
    """Return the shortest end of each path that tells it from the others, and says of which item it is.

    >>> short_names(["supply.substations[A].units", "supply.substations[B].units", "clock.step_s"])
    {'supply.substations[A].units': 'A units', 'supply.substations[B].units': 'B units', 'clock.step_s': 'step_s'}
    >>> short_names(["supply.contact_lines[0].wear_percent"])
    {'supply.contact_lines[0].wear_percent': 'contact_lines[0] wear_percent'}
    """
    unique = list(dict.fromkeys(paths))
    short = {path: _ending(path) for path in unique}
    return {path: name if list(short.values()).count(name) == 1 else path for path, name in short.items()}


def _ending(path: str) -> str:
    head, dot, last = path.rpartition(".")
    if "[" in last or "]" in last:  # an item as a whole, or a dot within the brackets of an identifier
        return path
    item = head.rpartition("[")[2].removesuffix("]") if dot and head.endswith("]") else ""
    if item.isdecimal() or item == "*":
        item = head.rpartition(".")[2]
    return f"{item} {last}".strip()


def number_of(text: str) -> float | None:
    """Return the number that a value stands for, or None."""
    try:
        value = parse_scalar(text)
    except ValueError:
        return None
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None

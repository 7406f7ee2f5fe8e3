"""Which inputs of two scenarios differ, by model path: what ``--set`` would change to get from the one to the other."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from tractionpower.model.scenario import Scenario
from tractionpower.studies.sweep.keys import text_of

MOST_ROWS = 30
"""Differences within one list beyond which it is told as a whole."""

LONGEST = 300
"""Characters of a value that is told."""


class InputDifference(NamedTuple):
    """An input with its values in the base and in the other scenario; an empty text where it is not there."""

    path: str
    base: str
    value: str

    def __str__(self) -> str:
        """Return the difference as a line.

        >>> str(InputDifference("supply.substations[A].units", "2", "3"))
        'supply.substations[A].units: 2 -> 3'
        """
        return f"{self.path}: {self.base or 'not there'} -> {self.value or 'not there'}"


def input_differences(base: Scenario, other: Scenario) -> list[InputDifference]:
    """Return the inputs that differ between two scenarios, in the order in which the model declares them."""
    plain, changed = (scenario.model_dump(mode="json", by_alias=True) for scenario in (base, other))
    return list(_walk(plain, changed, ""))


def _walk(base: Any, other: Any, path: str) -> Iterator[InputDifference]:
    if base == other:
        return
    if isinstance(base, dict) and isinstance(other, dict) and base.get("kind") == other.get("kind"):
        for key in {**base, **other}:
            yield from _walk(base.get(key), other.get(key), _joined(path, key))
    elif isinstance(base, list) and isinstance(other, list) and any(isinstance(item, dict) for item in (*base, *other)):
        found = list(_walk_list(base, other, path))
        if len(found) > MOST_ROWS:
            yield InputDifference(path, f"{len(base)} rows", f"{len(other)} rows, {len(found)} differences")
        else:
            yield from found
    else:
        yield InputDifference(path, _told(base), _told(other))


def _walk_list(base: list[Any], other: list[Any], path: str) -> Iterator[InputDifference]:
    """Yield the differences of two lists of rows: by identifier where all have one, else as runs of equal rows match."""
    ids, others = _by_id(base), _by_id(other)
    if ids is not None and others is not None:
        found: list[InputDifference] = []
        for name in {**ids, **others}:
            if name in ids and name in others:
                found += _walk(ids[name], others[name], f"{path}[{name}]")
            else:
                found.append(InputDifference(f"{path}[{name}]", _row(ids.get(name)), _row(others.get(name))))
        yield from _gathered(found, path, [*ids] if [*ids] == [*others] else [])
        return
    texts, changed = ([json.dumps(item, sort_keys=True) for item in items] for items in (base, other))
    for tag, i, until, j, to in difflib.SequenceMatcher(None, texts, changed, autojunk=False).get_opcodes():
        if tag == "equal":
            continue
        paired = min(until - i, to - j)
        for k in range(paired):
            yield from _walk(base[i + k], other[j + k], f"{path}[{i + k}]")
        for k in range(i + paired, until):
            yield InputDifference(f"{path}[{k}]", _row(base[k]), "")
        for k in range(j + paired, to):
            yield InputDifference(f"{path}[+]", "", _row(other[k]))


def _gathered(found: list[InputDifference], path: str, names: list[str]) -> Iterator[InputDifference]:
    """Yield differences, those that all items of a list have alike as one of ``[*]``."""
    alike: dict[tuple[str, str, str], int] = {}
    keys = []
    for item in found:
        name = next((name for name in names if item.path.startswith(f"{path}[{name}]")), "")
        key = (item.path[len(f"{path}[{name}]") :], item.base, item.value)
        keys.append(key if name else ("", "", ""))
        alike[key] = alike.get(key, 0) + bool(name)
    told = set()
    for item, key in zip(found, keys, strict=True):
        if len(names) < 2 or alike.get(key) != len(names):
            yield item
        elif key not in told:
            told.add(key)
            yield InputDifference(f"{path}[*]{key[0]}", item.base, item.value)


def _by_id(items: list[Any]) -> dict[str, Any] | None:
    """Return items by identifier; None if one has none, or two have the same."""
    if not all(isinstance(item, dict) and "id" in item for item in items):
        return None
    found = {str(item["id"]): item for item in items}
    return found if len(found) == len(items) else None


def _row(item: Any) -> str:
    """Return a row as it would be added, without what it leaves out."""
    if item is None:
        return ""
    plain = {key: value for key, value in item.items() if value not in (None, [])} if isinstance(item, dict) else item
    return _told(plain)


def _told(value: Any) -> str:
    text = text_of(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


def _joined(path: str, key: str) -> str:
    step = key if key.isidentifier() else f"[{key}]"
    return step if not path else f"{path}{step}" if step.startswith("[") else f"{path}.{step}"

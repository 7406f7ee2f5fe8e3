"""Inputs by their paths, in words: what ``supply.substations[A].grid_voltage_pu`` is called, and a row of it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

from tractionpower.model.quantity import Quantity
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.studies.sweep.keys import text_of

ROOMS = ("supply", "line", "timetable")
"""Parts of a scenario that go without saying before the list that they hold."""

ITEMS = {
    "substations": mark("substation {id}"),
    "section_cabins": mark("section cabin {id}"),
    "feeders": mark("feeder {id}"),
    "return_feeders": mark("return feeder {id}"),
    "switches": mark("switch {id}"),
    "loads": mark("load {id}"),
    "earthings": mark("earthing {id}"),
    "stations": mark("station {id}"),
    "tracks": mark("track {id}"),
    "trains": mark("train {id}"),
    "services": mark("service {id}"),
    "vehicles": mark("vehicle {id}"),
}
"""What an item of a list is called that has an identifier."""

SAME_AS = {"units_in_service": "units"}
"""Inputs that have the value of another one where they are left out."""

CUT = "…"
"""What stands at the end of a value that was too long to be kept whole."""

DIGITS = 9
"""Decimals of a number, zeros at its end left out."""

_STEP = re.compile(r"(?:^|\.)(?P<name>[^.\[\]]+)|\[(?P<key>[^\[\]]+)\]")
_CLOSES = {"{": "}", "[": "]"}


def input_in_words(path: str) -> str:
    """Return what an input is called, with its unit: first what it belongs to, then the quantity.

    >>> input_in_words("supply.substations[A].internal_resistance_ohm"), input_in_words("supply.substations[*].grid_voltage_pu")
    ('substation A: internal resistance [Ω]', 'all substations: grid voltage [p.u.]')
    >>> input_in_words("supply.contact_lines[0].to_km"), input_in_words("clock.step_s"), input_in_words("supply.bonds[+]")
    ('contact lines, row 1: to [km]', 'clock: step [s]', 'bonds, new row')
    """
    steps = [(match["name"], match["key"]) for match in _STEP.finditer(path)]
    if len(steps) > 1 and steps[0][0] in ROOMS and steps[1][0]:
        del steps[0]
    parts: list[str] = []
    for place, (name, key) in enumerate(steps):
        if key is not None:
            parts[-1:] = [_item(steps[place - 1][0] or "", key)]
        else:
            quantity, is_last = Quantity(name, ""), place == len(steps) - 1
            parts.append(recorded(quantity.words) + (f" [{quantity.unit}]" if quantity.unit and is_last else ""))
    return ": ".join(parts)


def part_of(path: str) -> str:
    """Return the part of the inputs that a path leads into, in words.

    >>> part_of("supply.contact_lines[3].to_km"), part_of("name"), part_of("sizing.search.most_units")
    ('contact lines', 'name', 'sizing')
    """
    names = [match["name"] for match in _STEP.finditer(path) if match["name"]]
    return recorded(Quantity(names[1] if len(names) > 1 and names[0] in ROOMS else names[0], "").words)


def names_of_inputs(paths: Iterable[str]) -> dict[str, str]:
    """Return what inputs are called; two that are called alike by their paths."""
    words = {path: input_in_words(path) for path in paths}
    told = list(words.values())
    return {path: name if told.count(name) == 1 else path for path, name in words.items()}


def bare_unit(name: str) -> tuple[str, str]:
    """Return the name of an input and its unit.

    >>> bare_unit("all substations: grid voltage [p.u.]")
    ('all substations: grid voltage', 'p.u.')
    """
    head, bracket, unit = name.rpartition(" [")
    return (head, unit.removesuffix("]")) if bracket and unit.endswith("]") else (name, "")


def value_in_words(text: str) -> str:
    """Return a value as it stands behind the ``=`` of a change in words: rows as names with values and units.

    >>> value_in_words('{"from_km": 20.5, "type": "2C120-2C", "tracks": ["1", "2"]}')
    'from 20.5 km, type 2C120-2C, tracks 1, 2'
    >>> value_in_words('{"id": "ed250", "name": "ED2…'), value_in_words('"3"'), value_in_words("bypassed")
    ('id ed250, …', '3', 'bypassed')
    """
    if text in ("null", "~"):
        return tr("left out")
    whole, more = text.removesuffix(CUT), text.endswith(CUT)
    if text[:1] not in ("{", "[", '"'):
        return text
    try:
        value = json.loads(_closed(whole) if more else text)
    except ValueError:
        return text
    return _told(value) + (f", {CUT}" if more else "")


def value_at(scenario: Scenario, path: str) -> str | None:
    """Return the value that an input has, as it stands behind the ``=`` of a change; of several items one that all share.

    None where there is none or it is left out, or where items differ.
    """
    found: list[Any] = [scenario.model_dump(mode="json", by_alias=True)]
    for match in _STEP.finditer(path):
        found = [part for one in found for part in _below(one, match["name"], match["key"])]
    texts = {text_of(one) for one in found}
    if texts == {"null"}:
        head, dot, last = path.rpartition(".")
        return value_at(scenario, f"{head}.{SAME_AS[last]}") if dot and last in SAME_AS else None
    return texts.pop() if len(texts) == 1 else None


def _below(container: Any, name: str | None, key: str | None) -> list[Any]:
    """Return what a step of a path leads to."""
    step = name or key or ""
    if isinstance(container, dict):
        return [container[step]] if step in container else []
    if not isinstance(container, list):
        return []
    if step == "*":
        return container
    own = [item for item in container if isinstance(item, dict) and item.get("id") == step]
    return own or (container[int(step) : int(step) + 1] if step.isdecimal() else [])


def _item(name: str, key: str) -> str:
    """Return what an item of a list is called."""
    items = recorded(Quantity(name, "").words)
    if key == "*":
        return tr("all {items}", items=items)
    if key == "+":
        return tr("{items}, new row", items=items)
    if key.isdecimal() and name not in ITEMS:
        return tr("{items}, row {row}", items=items, row=int(key) + 1)
    return tr(ITEMS[name], id=key) if name in ITEMS else f"{items} {key}"


def _told(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(_part(str(name), part) for name, part in value.items() if part is not None and part != [])
    if isinstance(value, list):
        return ("; " if any(isinstance(part, dict) for part in value) else ", ").join(map(_told, value))
    if isinstance(value, bool):
        return tr("yes") if value else tr("no")
    if isinstance(value, float):
        return number(value, DIGITS) if abs(value) < 1e12 else f"{value:g}"
    return "" if value is None else str(value)


def _part(name: str, value: Any) -> str:
    """Return name, value and unit of a part of a row."""
    quantity = Quantity(name, "")
    is_number = isinstance(value, float | int) and not isinstance(value, bool)
    unit = quantity.unit if is_number and quantity.words != quantity.unit else ""
    return f"{recorded(quantity.words)} {_told(value)} {unit}".strip()


def _closed(text: str) -> str:
    """Return the beginning of a text of JSON up to the last part that is whole, with all that is open closed."""
    opened: list[str] = []
    best, in_text, escaped = "", False, False
    for k, letter in enumerate(text):
        if in_text:
            in_text, escaped = letter != '"' or escaped, letter == "\\" and not escaped
        elif letter == '"':
            in_text = True
        elif letter in _CLOSES:
            opened.append(_CLOSES[letter])
        elif opened and letter == opened[-1]:
            opened.pop()
        elif letter == "," and len(opened) == 1:
            best = text[:k] + opened[0]
    return best

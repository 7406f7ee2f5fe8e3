"""Key figures of several folders side by side, matched by name and place, with differences from the base."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.model.quantity import unit_of
from tractionpower.results.words import yes_or_no
from tractionpower.studies.compare.folders import Variant
from tractionpower.studies.sweep.differences import FIGURES, change_of, figure_of

WORST = ("lowest_", "highest_", "longest_")
"""How the names of figures begin whose place, where a run has one of them only, says where it came about."""

NOWHERE = math.nan


@dataclass(frozen=True, slots=True)
class Told:
    """A figure as one folder tells it: its value, and where and when."""

    name: str
    place: str
    value: float
    time: str = ""


Key = tuple[str, str]
"""Name and place of a figure."""


def compared(variants: Sequence[Variant]) -> list[dict[str, Any]]:
    """Return the rows of table ``compare``: for each figure one for each folder that has it, the base folder first.

    A figure is matched by its name and place. One that a run has once, such as its lowest voltage, may have come about at
    another place in each folder: it is matched by its name, and ``at`` tells where.
    """
    told = [list(_told(variant)) for variant in variants]
    wandering = _wandering(told)
    matched: dict[Key, dict[int, Told]] = {}
    for number, figures in enumerate(told):
        for figure in figures:
            place = "" if figure.name in wandering else figure.place
            matched.setdefault((figure.name, place), {})[number] = figure
    rows = []
    for (name, place), found in matched.items():
        reference = found[0].value if 0 in found else NOWHERE
        for number, figure in found.items():
            difference, percent = change_of(reference, figure.value) if number and 0 in found else (NOWHERE, NOWHERE)
            at = ", ".join(text for text in (figure.place if name in wandering else "", figure.time) if text)
            row = {"figure": name, "place": place, "unit": unit_of(name), "folder": variants[number].name}
            rows.append(row | {"value": figure.value, "at": at, "difference": difference, "percent": percent})
    return rows


def _wandering(told: Sequence[Sequence[Told]]) -> set[str]:
    """Return the names of figures of which no folder has more than one, and which came about somewhere along the line."""
    places: dict[str, list[list[str]]] = {}
    for number, figures in enumerate(told):
        for figure in figures:
            places.setdefault(figure.name, [[] for _ in told])[number].append(figure.place)
    return {
        name
        for name, found in places.items()
        if name.startswith(WORST) and max(map(len, found)) == 1 and _differ([one for own in found for one in own])
    }


def _differ(places: Sequence[str]) -> bool:
    return len(set(places)) > 1 or " km " in places[0]


def _told(variant: Variant) -> Iterator[Told]:
    """Yield the figures of a folder: those of a run and its devices, or those of each case."""
    for figure in variant.results.key_figures:
        if figure["value"] is not None and not math.isnan(figure["value"]):
            yield Told(figure["name"], figure.get("place") or "", float(figure["value"]), figure.get("time") or "")
    if "ratings" in variant.results.tables:
        ratings = variant.results.table("ratings")
        ruling = ratings[ratings["ruling"] & ratings["utilisation_percent"].notna()]
        for row in ruling.to_dict("records"):
            yield Told("utilisation_percent", f"{row['kind']} {row['device']}", float(row["utilisation_percent"]))
    if variant.has_cases and "cases" in variant.results.tables:
        for row in variant.results.table("cases").to_dict("records"):
            for name in FIGURES:
                value = figure_of({name: row[name]}, name)
                if value is not None:
                    yield Told(name, f"case {row['case']}", value)


def profiles(variants: Sequence[Variant]) -> list[dict[str, Any]]:
    """Return the rows of table ``compare_profile``: the lowest voltages along the line, of all cases where there are many."""
    rows = []
    for variant in variants:
        tables = variant.results.tables
        if "profile" in tables:
            found = variant.results.table("profile")
        elif "envelope" in tables:
            found = variant.results.table("envelope")
            found = found[found["quantity"] == "voltage"].rename(columns={"worst_v": "lowest_voltage_v"})
        else:
            continue
        names = [name for name in ("track", "km", "where", "lowest_voltage_v") if name in found]
        rows += [{"folder": variant.name, **dict(zip(names, row, strict=True))} for row in found[names].itertuples(index=False)]
    return rows


def compared_verdicts(variants: Sequence[Variant]) -> list[dict[str, Any]]:
    """Return the rows of table ``compare_verdicts``, in the order of the base folder's verdicts."""
    matched: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for variant in variants:
        for verdict in variant.results.run.get("verdicts", ()):
            met = verdict.get("met")
            at = ", ".join(str(verdict[key]) for key in ("place", "time") if verdict.get(key))
            row = {"figure": str(verdict.get("name", "")), "limit": str(verdict.get("limit") or ""), "folder": variant.name}
            row |= {"value": verdict.get("value"), "limit_value": verdict.get("limit_value"), "at": at}
            row |= {"met": yes_or_no(met), "status": verdict.get("status")}
            matched.setdefault((row["figure"], row["limit"]), []).append(row)
    return [row for rows in matched.values() for row in rows]

"""``TrackProfile.csv`` of Arshad et al. (Tables 5 and 6): grades and curves in any order; the rest is level and straight."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.arshad.columns import Cells, Column, number, read_sheet
from tractionpower.io.arshad.units import FOOT_M, Told, read_quantity
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import Source
from tractionpower.io.wording import did_you_mean, shown

CHORD_M = 100.0 * FOOT_M
"""Chord whose angle is the degree of a curve (section 5.2)."""

_TANGENT_DEG = 1e-6
"""Curves of fewer degrees are straight."""

_FROM = Column("from", ("Start Point", "Start"), "length")
_TO = Column("to", ("End Point", "End"), "length")
_ELEMENT = Column("element", ("Track Element", "Element"))
_VALUE = Column("value", ("Value",))
_ELEMENTS = {"grade": "grade", "gradient": "grade", "curve": "curve", "curvature": "curve"}


@dataclass(frozen=True, slots=True)
class Element:
    """A row: a stretch of track [m] with a grade [permille] or a curve [degree]."""

    from_m: float
    to_m: float
    value: float
    line: int
    cells: Cells


@dataclass(frozen=True, slots=True)
class Profile:
    """A profile as read, by kind and place; `feet`: whether its places are in feet."""

    grades: tuple[Element, ...]
    curves: tuple[Element, ...]
    label: str
    feet: bool


def radius_of(degrees: float) -> float:
    """Return the radius [m] of a curve of some degrees, by a chord of 100 ft; 1 degree: 1746.4 m."""
    return CHORD_M / (2.0 * math.sin(math.radians(abs(degrees)) / 2.0))


def read_track(reader: Reader, source: Source) -> Profile | None:
    """Read a profile; None if it has errors, which `reader` collects.

    A gap of a foot at most between two rows of a kind, or before the first, is how the paper writes neighbours (3000 and
    3001): it is closed. Rows of a kind may overlap only where they say the same.
    """
    sheet = read_sheet(reader, source, (_FROM, _TO, _ELEMENT, _VALUE))
    if sheet is None:
        return None
    problems: list[Problem] = []
    by_kind: dict[str, list[Element]] = {"grade": [], "curve": []}
    for cells in sheet.rows:
        kind, element = _element(cells, problems)
        if element is not None:
            by_kind[kind].append(element)
    grades, curves = (_joined(by_kind[kind], problems) for kind in ("grade", "curve"))
    reader.problems += problems
    feet = sheet.units["from"] in ("ft", "feet", "foot", "mi", "mile", "miles")
    return None if problems else Profile(grades, curves, source.label, feet)


def track_data(profile: Profile, start_m: float, length_m: float, curve_n_per_kn: float) -> tuple[dict[str, Any], Mark]:
    """Return the track as plain data of `model.dynamics.case.CaseTrack`, by the distance from where the front starts.

    Parameters
    ----------
    profile
        The profile.
    start_m
        Place of the front on it at the start.
    length_m
        Length of the train; what of it stands before the profile stands on the first grade of it.
    curve_n_per_kn
        Curve resistance of one degree [N/kN].
    """
    mark = Mark(profile.label)
    grades = [(each, each.from_m, each.to_m) for each in profile.grades]
    if grades and grades[0][1] <= 0.0:
        # Twice the train: with its slack, and should it roll back.
        grades[0] = (grades[0][0], min(0.0, start_m - 2.0 * length_m), grades[0][2])
    lists: dict[str, list[dict[str, Any]]] = {
        "gradients": [{"from_m": a - start_m, "to_m": b - start_m, "permille": each.value} for each, a, b in grades],
        "curves": [
            {
                "from_m": each.from_m - start_m, "to_m": each.to_m - start_m, "radius_m": radius_of(each.value),
                "turns": "right" if each.value > 0.0 else "left",
            }
            for each in profile.curves if abs(each.value) > _TANGENT_DEG
        ],
    }  # fmt: skip
    for name, rows in (
        ("gradients", profile.grades),
        ("curves", tuple(each for each in profile.curves if abs(each.value) > _TANGENT_DEG)),
    ):
        children: dict[str | int, Mark] = {k: Mark(profile.label, each.line) for k, each in enumerate(rows)}
        mark.children[name] = Mark(profile.label, 0, children)
    # a / R with R = 1746.4 m / degrees, so that one degree has the resistance of the configuration.
    bend = {"a_n_m_per_kn": curve_n_per_kn * radius_of(1.0)}
    return {**lists, "rounding_radius_m": 0.0, "curve_resistance": bend}, mark


def _element(cells: Cells, problems: list[Problem]) -> tuple[str, Element | None]:
    before = len(problems)
    for column in (_FROM, _TO, _ELEMENT, _VALUE):
        if column.name not in cells.texts:
            problems.append(cells.problem(column.name, "missing_value", "nothing", column.spellings[0]))
    from_m, to_m = (number(cells, column, problems) for column in (_FROM, _TO))
    word = cells.texts.get("element", "")
    kind = _ELEMENTS.get(word.lower(), "")
    if word and not kind:
        remedy = did_you_mean(word, ("Grade", "Curve"))
        problems.append(cells.problem("element", "unknown_word", shown(word), "Grade, Curve", remedy))
    value = read_quantity(cells.texts.get("value", "0"), "degrees" if kind == "curve" else "grade") if kind else 0.0
    if isinstance(value, Told):
        example = "degrees, such as 2 Deg" if kind == "curve" else "per cent, such as 1 %"
        problems.append(cells.problem("value", "bad_value", value.found, example, value.remedy))
    elif abs(value) > (90.0 if kind == "curve" else 200.0):
        most = "90 Deg" if kind == "curve" else "20 %"
        problems.append(cells.problem("value", "out_of_bounds", shown(cells.texts["value"]), f"-{most} to {most}"))
    if from_m is not None and to_m is not None and from_m >= to_m:
        found = f"{cells.texts['from']} to {cells.texts['to']}"
        problems.append(cells.problem("to", "reversed", found, "the end behind the start", "swap the two"))
    if len(problems) > before or from_m is None or to_m is None or isinstance(value, Told):
        return kind, None
    return kind, Element(from_m, to_m, value, cells.line, cells)


def _joined(rows: list[Element], problems: list[Problem]) -> tuple[Element, ...]:
    # Sorted, without overlaps; the small gaps of rows that mean to be neighbours closed.
    joined: list[Element] = []
    near = FOOT_M * (1.0 + 1e-6)
    end_m, last = 0.0, None
    for row in sorted(rows, key=lambda each: (each.from_m, each.line)):
        from_m = row.from_m
        if last is not None and from_m < end_m - near and row.value != last.value:
            texts = row.cells.texts
            found = f"{texts['value']} from {texts['from']} to {texts['to']} overlaps line {last.line} with another value"
            problems.append(row.cells.problem("from", "overlap", found, "one value of a kind at a place", "mend one of the rows"))
        if abs(from_m - end_m) <= near or (last is not None and from_m < end_m):
            from_m = end_m
        if row.to_m > from_m:
            joined.append(Element(from_m, row.to_m, row.value, row.line, row.cells))
        if row.to_m > end_m:
            end_m, last = row.to_m, row
    return tuple(joined)

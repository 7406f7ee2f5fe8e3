"""``DynamicParameter.csv`` of Arshad et al. (Tables 4 and 7): what the driver sets, by time."""

from __future__ import annotations

from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.arshad.columns import Cells, Column, number, read_sheet
from tractionpower.io.arshad.units import Told, allowed_units, read_quantity
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import Source
from tractionpower.io.wording import did_you_mean, shown

ELECTRIC_LEVELS = 8
"""Positions of the dynamic brake where it is given by notches."""

_WORDS = {
    "charge": "charge",
    "release": "release",
    "uc": "unchanged",
    "unchanged": "unchanged",
    "uc (unchanged)": "unchanged",
    "full service": "full_service",
    "emergency": "emergency",
}
_TIME = Column("time", ("Time", "Time instant"), "time", unit="s")
_NOTCH = Column("notch", ("Notch", "Throttle Notch", "Throttle Noch"), "count", unit="")
_PIPE = Column("pipe", ("Brake Pipe Pressure", "Automatic Braking"), "pressure", unit="psi")
# Table 7 heads the dynamic brake as a notch; Table 4 has no unit and values up to 25, which no notch has.
_ELECTRIC_NOTCH = Column("electric_notch", ("Dynamic Braking Notch", "Dynamic Brake Notch"), "number", False, "")
_ELECTRIC = Column("electric", ("Dynamic Brake", "Dynamic Braking"), "share", False, "%")
_INDEPENDENT = Column("independent", ("Independent Brake", "Independent Braking"), "pressure", False, "psi")


def read_commands(reader: Reader, source: Source, notches: int) -> tuple[list[dict[str, Any]], Mark]:
    """Return the commands as plain data of `model.dynamics.case.Command`, and their lines; `reader` collects problems.

    A row holds until the next one changes it; a cell that is empty changes nothing.
    """
    mark = Mark(source.label)
    sheet = read_sheet(reader, source, (_TIME, _NOTCH, _PIPE, _ELECTRIC_NOTCH, _ELECTRIC, _INDEPENDENT))
    if sheet is None:
        return [], mark
    problems: list[Problem] = []
    if {"electric", "electric_notch"} <= sheet.units.keys():
        found = "the dynamic brake by notches and by per cent"
        problems.append(source.problem("contradiction", found, "one column for it", "delete one", 1))
    commands: list[dict[str, Any]] = []
    for cells in sheet.rows:
        mark.children[len(commands)] = Mark(source.label, cells.line)
        commands.append(_command(cells, notches, problems))
    reader.problems += problems
    return commands, mark


def _command(cells: Cells, notches: int, problems: list[Problem]) -> dict[str, Any]:
    time_s = number(cells, _TIME, problems)
    if time_s is None and _TIME.name not in cells.texts:
        problems.append(cells.problem(_TIME.name, "missing_value", "nothing", "a time", "every row has its time"))
    elif time_s is not None and time_s < 0.0:
        problems.append(cells.problem(_TIME.name, "out_of_bounds", shown(cells.texts["time"]), "at least 0"))
    command: dict[str, Any] = {"time_s": time_s}
    level = number(cells, _NOTCH, problems)
    if level is not None:
        if not 0 <= level <= notches:
            remedy = "the configuration may say Notches = ..." if 0 <= level <= 100 else ""
            found = shown(cells.texts[_NOTCH.name])
            problems.append(cells.problem(_NOTCH.name, "out_of_bounds", found, f"0 to {notches}", remedy))
        command["drive"] = int(level)
    command |= _pipe(cells, problems)
    electric = _electric(cells, problems)
    if electric is not None:
        command["electric"] = electric
    independent = number(cells, _INDEPENDENT, problems)
    if independent is not None:
        command["independent_bar"] = independent
    return command


def _pipe(cells: Cells, problems: list[Problem]) -> dict[str, Any]:
    text = cells.texts.get(_PIPE.name)
    if text is None:
        return {}
    word = _WORDS.get(" ".join(text.lower().split()))
    if word is not None:
        return {"brake": word}
    value = read_quantity(text, "pressure", cells.units[_PIPE.name])
    if isinstance(value, Told):
        words = "Charge, Release, Uc (Unchanged), Full Service, Emergency"
        allowed = f"a reduction in {allowed_units('pressure')}, or {words}"
        remedy = did_you_mean(text, ("Charge", "Release", "Uc", "Unchanged", "Full Service", "Emergency")) or value.remedy
        problems.append(cells.problem(_PIPE.name, "unknown_word", shown(text), allowed, remedy))
        return {}
    if value < 0.0:
        remedy = "a reduction is positive; Charge and Release fill the pipe"
        problems.append(cells.problem(_PIPE.name, "out_of_bounds", shown(text), "at least 0", remedy))
        return {}
    return {"reduction_bar": value}


def _electric(cells: Cells, problems: list[Problem]) -> float | None:
    # Level of the dynamic brake, 0 to ELECTRIC_LEVELS.
    column, most = (_ELECTRIC_NOTCH, ELECTRIC_LEVELS) if _ELECTRIC_NOTCH.name in cells.texts else (_ELECTRIC, 100)
    value = number(cells, column, problems)
    if value is None:
        return None
    if column is _ELECTRIC:
        value *= 100.0  # [%]
    if not -1e-9 <= value <= most * (1.0 + 1e-9):
        remedy = "for per cent head the column Dynamic Brake (%)" if column is _ELECTRIC_NOTCH and value <= 100.0 else ""
        unit = " %" if column is _ELECTRIC else ""
        found = shown(cells.texts[column.name])
        problems.append(cells.problem(column.name, "out_of_bounds", found, f"0 to {most}{unit}", remedy))
        return None
    return min(max(value, 0.0) * ELECTRIC_LEVELS / most, float(ELECTRIC_LEVELS))

"""What was driven, kept so that `dynamics run` does the same again: the commands as rows, and the case with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from tractionpower.io.csv_files import csv_text
from tractionpower.io.file_names import file_names
from tractionpower.io.text_files import write_files
from tractionpower.io.yaml_text import document
from tractionpower.model.dynamics.case import Command, DynamicsScenario

COMMANDS_FILE = "commands.csv"
CASE_FILE = "case.yaml"
COLUMNS = ("time_s", "drive", "brake", "reduction_bar", "electric", "independent_bar")


class Driven:
    """What the driver has set, by time; what is set at one time is one row.

    Parameters
    ----------
    first
        Rows that hold before the driver does anything.
    """

    def __init__(self, first: Iterable[Command] = ()) -> None:
        self._rows: dict[float, Command] = {row.time_s: row for row in first}

    def note(self, time_s: float, setting: Mapping[str, Any]) -> None:
        """Note what was set at a time [s]; the later word holds."""
        row = self._rows.get(time_s, Command(time_s=time_s))
        changed = dict(setting)
        if "brake" in changed:
            changed["reduction_bar"] = None
        self._rows[time_s] = row.model_copy(update=changed)

    def commands(self) -> tuple[Command, ...]:
        """Return all rows, by time."""
        return tuple(self._rows[time_s] for time_s in sorted(self._rows))


def as_driven(scenario: DynamicsScenario, commands: tuple[Command, ...], time_s: float) -> DynamicsScenario:
    """Return a case with what was driven, up to the time [s] that was reached."""
    case = scenario.case
    changed = {"duration_s": max(time_s, case.run.step_s), "ends": "duration", "rows_limit": None}
    run = case.run.model_copy(update=changed)
    return scenario.model_copy(update={"case": case.model_copy(update={"commands": commands, "run": run})})


def commands_text(commands: Sequence[Command]) -> str:
    """Return commands as the text of a CSV file."""
    rows = [[getattr(row, name) for name in COLUMNS] for row in commands]
    kept = [place for place, name in enumerate(COLUMNS) if name == "time_s" or any(row[place] is not None for row in rows)]
    return csv_text([COLUMNS[place] for place in kept], [[row[place] for place in kept] for row in rows])


def write_case(scenario: DynamicsScenario, folder: Path, *, with_stock: bool = True) -> Path:
    """Write a case into a folder, so that it can be run again, with all that it names (`with_stock`); return its file."""
    case = _declared(scenario.case)
    if scenario.case.commands:
        case["commands"] = COMMANDS_FILE
    texts = {CASE_FILE: document(case)}
    if scenario.case.commands:
        texts[COMMANDS_FILE] = commands_text(scenario.case.commands)
    shelves = (("vehicles", scenario.vehicles), ("couplings", scenario.couplings)) if with_stock else ()
    for shelf, things in shelves:
        names = file_names(thing.id for thing in things)
        for thing in things:
            texts[f"rollingstock/{shelf}/{names[thing.id]}"] = document(_declared(thing))
    write_files(folder, texts)
    return folder / CASE_FILE


def _declared(thing: BaseModel) -> dict[str, Any]:
    """Return a declaration as its file says it, without what is as by default."""
    return {"format": 1} | thing.model_dump(mode="json", by_alias=True, exclude_defaults=True)

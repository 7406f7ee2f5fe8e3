"""Reference cases: studies with expected figures, their tolerance and their source.

A case is a folder with a study and a ``case.yaml`` that lists checks. A check may change inputs first, and names the
figures that must come out by table, device and column: ``loads.train.voltage_v``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from tractionpower.cosimulation.run import Run
from tractionpower.errors import InputError, Problem
from tractionpower.io.documents import read_document
from tractionpower.io.finder import data_folder
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.base import Declaration, Format, Real, Text
from tractionpower.model.change import apply_changes
from tractionpower.model.scenario import Scenario
from tractionpower.results.store import MemoryWriter

CASE_FILE = "case.yaml"


class Check(Declaration):
    """One set of inputs and what must come out."""

    title: Text
    set: tuple[Text, ...] = Field(default=(), description="Changes of the study, as for --set.")
    expect: dict[str, Real] = Field(description="Expected figures by table.device.column.")
    tolerance: Annotated[float, Field(gt=0)] | None = Field(default=None, description="In place of the tolerance of the case.")
    status: Text = Field(default="complete", description="Status that the run must have.")


class Case(Declaration):
    """A reference case."""

    format: Format = 1
    title: Text
    source: Text
    tolerance: Annotated[float, Field(gt=0)] = 1e-3
    checks: Annotated[tuple[Check, ...], Field(min_length=1)]


@dataclass(frozen=True, slots=True)
class Finding:
    """An expected figure beside the computed one."""

    case: str
    check: str
    figure: str
    expected: float | str
    computed: float | str
    tolerance: float
    source: str

    @property
    def met(self) -> bool:
        """Whether the computed figure lies within the tolerance."""
        if isinstance(self.expected, str) or isinstance(self.computed, str):
            return self.expected == self.computed
        return abs(self.computed - self.expected) <= self.tolerance


def find_cases(folder: Path | None = None) -> list[Path]:
    """Return the folders of the reference cases, by name; those that ship when `folder` is left out."""
    root = data_folder("validation") if folder is None else folder
    return sorted(path.parent for path in root.glob(f"*/{CASE_FILE}"))


def run_case(folder: Path) -> Iterator[Finding]:
    """Run a reference case and yield its findings, check by check.

    Raises
    ------
    InputError
        If the case or its study has errors.
    """
    case = read_document(folder / CASE_FILE, Case)
    base = load_scenario(folder).scenario
    for check in case.checks:
        figures, status = _compute(apply_changes(base, check.set))
        name = folder.name
        tolerance = check.tolerance or case.tolerance
        yield Finding(name, check.title, "status", check.status, status, tolerance, case.source)
        for figure, expected in check.expect.items():
            if figure not in figures:
                raise InputError([_unknown(folder, figure, figures)])
            yield Finding(name, check.title, figure, expected, figures[figure], tolerance, case.source)


def _compute(scenario: Scenario) -> tuple[dict[str, float], str]:
    """Return the figures of the first step of every device, the factor of an event, and the status of the run."""
    writer = MemoryWriter()
    outcome = Run(scenario, writer).execute()
    figures: dict[str, float] = {}
    for table, key in (("substations", "substation"), ("loads", "load"), ("events", "kind")):
        rows: list[dict[str, Any]] = writer.tables()[table].to_pylist() if table in writer.tables() else []
        for row in rows:
            for column, value in row.items():
                if isinstance(value, float) and f"{table}.{row[key]}.{column}" not in figures:
                    figures[f"{table}.{row[key]}.{column}"] = value
    figures |= {f"energy.{name}": value for name, value in outcome.run["ledgers"]["electric"].items()}
    return figures, str(outcome.run["status"])


def _unknown(folder: Path, figure: str, figures: dict[str, float]) -> Problem:
    known = ", ".join(sorted(figures)[:8])
    return Problem("unknown_figure", f"expect.{figure}", "no such figure comes out", known, "name one", place=str(folder))

"""Reference cases: studies with expected figures, their tolerance and their source.

A case is a folder with a study and a ``case.yaml`` that lists checks. A check may change inputs first, and names the
figures that must come out by table, train, device or place, and column: ``loads.depot.voltage_v``, ``trains.ic.current_a``,
``feeders.A 1 high_km.current_a`` (substation, track, side; likewise ``cabins``), ``rails.1 12.5.potential_v`` (track, km);
those of theoretical journeys by train and figure: ``journeys.ic.running_time_s``, in both forms of the equations of motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from tractionpower.cosimulation.run import Run
from tractionpower.errors import InputError, Problem
from tractionpower.io.documents import read_document
from tractionpower.io.finder import data_folder
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.base import Declaration, Format, Real, Text
from tractionpower.model.scenario import Scenario
from tractionpower.results.store import MemoryWriter
from tractionpower.studies.journeys import Form
from tractionpower.studies.validation_journeys import PREFIX, journey_figures

CASE_FILE = "case.yaml"

FIGURE_KEYS = {
    "trains": ("train",),
    "substations": ("substation",),
    "feeders": ("substation", "track", "side"),
    "cabins": ("section_cabin", "track", "side"),
    "switches": ("switch",),
    "loads": ("load",),
    "rails": ("track", "km"),
    "events": ("kind",),
}
"""Tables whose first rows are figures, and the columns that name the subject: ``feeders.A 1 high_km.current_a``."""


class Check(Declaration):
    """One set of inputs and what must come out."""

    title: Text
    set: tuple[Text, ...] = Field(default=(), description="Changes of the study, as for --set.")
    voltage_v: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="Voltage at the pantograph in journeys; left out: the nominal one."
    )
    forms: tuple[Form, ...] = Field(default=("time", "speed"), min_length=1, description="Forms in which journeys are computed.")
    expect: dict[str, Real] = Field(description="Expected figures by table.device.column, or journeys.train.figure.")
    tolerance: Annotated[float, Field(gt=0)] | None = Field(default=None, description="In place of the tolerance of the case.")
    tolerance_percent: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="As a share of each expected figure; in place of other tolerances."
    )
    status: Text = Field(default="complete", description="Status that the run must have.")

    @property
    def passes(self) -> tuple[Form | Literal[""], ...]:
        """Forms in which theoretical journeys are computed; a single empty one for a run in their place."""
        return self.forms if any(figure.startswith(PREFIX) for figure in self.expect) else ("",)


class Case(Declaration):
    """A reference case."""

    format: Format = 1
    title: Text
    source: Text
    tolerance: Annotated[float, Field(gt=0)] = 1e-3
    checks: Annotated[tuple[Check, ...], Field(min_length=1)]


@dataclass(frozen=True, slots=True)
class Finding:
    """An expected figure beside the computed one; `form` is that of the equations of motion, empty without a journey."""

    case: str
    check: str
    figure: str
    expected: float | str
    computed: float | str
    tolerance: float
    source: str
    form: str = ""

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
    base = load_scenario(folder)
    for check in case.checks:
        scenario = base.changed(check.set, f"{CASE_FILE} set")
        for form in check.passes:
            yield from _find(folder, case, check, form, scenario)


def _find(folder: Path, case: Case, check: Check, form: Form | Literal[""], scenario: Scenario) -> Iterator[Finding]:
    figures, status = journey_figures(scenario, check.voltage_v, form) if form else _compute(scenario)
    absolute = check.tolerance or case.tolerance
    share = (check.tolerance_percent or 0.0) / 100.0
    yield Finding(folder.name, check.title, "status", check.status, status, absolute, case.source, form)
    for figure, expected in check.expect.items():
        if figure not in figures:
            raise InputError([_unknown(folder, figure, figures)])
        tolerance = share * abs(expected) if share else absolute
        yield Finding(folder.name, check.title, figure, expected, figures[figure], tolerance, case.source, form)


def _compute(scenario: Scenario) -> tuple[dict[str, float], str]:
    """Return the figures of the first step of every train and device, the factor of an event, and the status of the run."""
    writer = MemoryWriter()
    outcome = Run(scenario, writer).execute()
    figures: dict[str, float] = {}
    tables = writer.tables()
    for table, keys in FIGURE_KEYS.items():
        rows: list[dict[str, Any]] = tables[table].to_pylist() if table in tables else []
        for row in rows:
            subject = " ".join(f"{row[key]:g}" if isinstance(row[key], float) else row[key] for key in keys)
            for column, value in row.items():
                if isinstance(value, float) and f"{table}.{subject}.{column}" not in figures:
                    figures[f"{table}.{subject}.{column}"] = value
    figures |= {f"energy.{name}": value for name, value in outcome.run["ledgers"]["electric"].items()}
    return figures, str(outcome.run["status"])


def _unknown(folder: Path, figure: str, figures: dict[str, float]) -> Problem:
    known = ", ".join(sorted(figures)[:8])
    return Problem("unknown_figure", f"expect.{figure}", "no such figure comes out", known, "name one", place=str(folder))

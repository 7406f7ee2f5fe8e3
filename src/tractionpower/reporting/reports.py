"""All reports of a run or of a study of many runs, from its results alone: after the run, or later again."""
# ruff: noqa: PLC0415 - matplotlib and openpyxl are slow to import

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tractionpower.errors import OutputError
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.characters import unturned
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.texts import language, tr
from tractionpower.results.disk import reason_of
from tractionpower.results.results import Results

MOST_NAME_LETTERS = 80
"""Letters of the name of a case at the foot of a figure."""

FIGURES = "figures"
WORKBOOK = "report.xlsx"
WORKBOOKS = {"compare": "compare.xlsx"}
"""Other names of the workbook, by what ``run.json`` says that results are."""

PARTS = frozenset({"workbook", "figures"})
"""Parts of the reports that can be written alone."""


def write_reports(
    results: Results,
    scenario: Scenario | DynamicsScenario | StationsCase,
    folder: Path,
    report: Report | None = None,
    *,
    only: frozenset[str] | None = None,
) -> list[Path]:
    """Write figures and workbook of a run, of a study of many or of train dynamics, into `folder` and return their paths.

    One report that cannot be written does not hinder the others; tables are not touched. `report` is the template: language,
    choice of sheets and figures; None: English, all of them. `only` names the `PARTS` to write; None: all.

    Raises
    ------
    OutputError
        If a report cannot be written, or the template chooses a figure that there is none of; all that hinders is told.
    """
    report, parts = report or Report(), PARTS if only is None else only
    kind = str(results.run.get("kind") or "")
    paths: list[Path] = []
    hindrances: list[str] = []
    if "figures" in parts:
        try:
            drawn, hindrance = _write_figures(results, scenario, folder, report)
            paths += drawn
            hindrances += hindrance
        except OSError as error:
            hindrances.append(f"figures cannot be written into {folder / FIGURES}: {reason_of(error)}")
    if "workbook" in parts:
        from tractionpower.reporting.workbook import write_workbook

        workbook = folder / WORKBOOKS.get(kind, WORKBOOK)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            paths.append(write_workbook(results, scenario, workbook, report))
        except OSError as error:
            hindrances.append(f"{workbook} cannot be written: {reason_of(error)}")
    if hindrances:
        raise OutputError(f"the tables are complete, but {'; '.join(hindrances)}")
    return paths


def _write_figures(
    results: Results, scenario: Scenario | DynamicsScenario | StationsCase, folder: Path, report: Report
) -> tuple[list[Path], Sequence[str]]:
    """Write the figures that the template chooses; return their paths, and in words which of its names no figure has."""
    from tractionpower.reporting.figures.base.drawing import drawing
    from tractionpower.reporting.figures.registry import figure_names, figure_writer, remove_others, unknown_names

    folder.mkdir(parents=True, exist_ok=True)
    with language(report.language), drawing(report.figures, source_of(results)):
        paths = figure_writer(str(results.run.get("kind") or ""))(results, scenario, folder / FIGURES)
    remove_others(folder / FIGURES, {*paths})
    unknown = unknown_names(report.figures.names or (), scenario)
    if not unknown:
        return paths, ()
    known = ", ".join(sorted({*figure_names(), "trains/ID"}))
    return paths, [f"the template chooses figures that there are none of: {', '.join(unknown)}; figures.names takes {known}"]


def source_of(results: Results) -> str:
    """Return the line at the foot of each figure: study, inputs by the beginning of their hash, program; no date.

    Figures of train dynamics have the name of their case there, which would take two lines of a title.
    """
    run = results.run
    version = str(run.get("versions", {}).get("tractionpower", ""))
    is_case = run.get("kind") in ("dynamics", "stations") and run.get("name")
    study = unturned(shortened(" ".join(str(run["name"]).split()), MOST_NAME_LETTERS)) if is_case else ""
    parts = [
        study or (tr("study {study}", study=str(run["study"])[:60]) if run.get("study") else ""),
        tr("inputs {hash}", hash=str(run["input_hash"])[:12]) if run.get("input_hash") else "",
        f"tractionpower {version}" if version else "",
    ]
    return ", ".join(part for part in parts if part)

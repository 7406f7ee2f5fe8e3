"""All reports of a run or of a study of many runs, from its results alone: after the run, or later again."""
# ruff: noqa: PLC0415 - matplotlib and openpyxl are slow to import

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from tractionpower.errors import OutputError
from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import language
from tractionpower.results.disk import reason_of
from tractionpower.results.results import Results

FIGURES = "figures"
WORKBOOK = "report.xlsx"
WORKBOOKS = {"compare": "compare.xlsx"}
"""Other names of the workbook, by what ``run.json`` says that results are."""

FigureWriter = Callable[[Results, Scenario, Path], list[Path]]


def write_reports(results: Results, scenario: Scenario, folder: Path, report: Report | None = None) -> list[Path]:
    """Write figures and workbook of a run, or of a study of many, into `folder` and return their paths.

    One report that cannot be written does not hinder the others; tables are not touched. `report` is the template: language,
    choice of sheets and figures; None: English, all of them.

    Raises
    ------
    OutputError
        If a report cannot be written; all that hinders is told.
    """
    from tractionpower.reporting.workbook import write_workbook

    report = report or Report()
    kind = str(results.run.get("kind") or "")
    workbook = folder / WORKBOOKS.get(kind, WORKBOOK)
    paths: list[Path] = []
    hindrances = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with language(report.language):
            paths += _figure_writer(kind)(results, scenario, folder / FIGURES)
        _remove_other_figures(folder / FIGURES, {*paths})
    except OSError as error:
        hindrances.append(f"figures cannot be written into {folder / FIGURES}: {reason_of(error)}")
    try:
        paths.append(write_workbook(results, scenario, workbook, report))
    except OSError as error:
        hindrances.append(f"{workbook} cannot be written: {reason_of(error)}")
    if hindrances:
        raise OutputError(f"the tables are complete, but {'; '.join(hindrances)}")
    return paths


def _remove_other_figures(folder: Path, drawn: set[Path]) -> None:
    """Remove the figures that another command left in a folder of figures; files that no command writes stay."""
    from tractionpower.reporting.figures import of_run as figures
    from tractionpower.reporting.figures.many import compare_figures, sweep_figures
    from tractionpower.reporting.figures.many.outage_map import MAP

    single = (*figures.SINGLE, *figures.GRAPHS, *figures.OUTAGES, *sweep_figures.NAMES, *compare_figures.NAMES)
    ours = {*folder.glob(f"{MAP}*.png"), *folder.glob(f"{figures.TRAINS}/*.png"), *(folder / f"{name}.png" for name in single)}
    for stale in ours - drawn:
        with suppress(OSError):
            stale.unlink()
    with suppress(OSError):  # unless something is in it
        (folder / figures.TRAINS).rmdir()


def _figure_writer(kind: str) -> FigureWriter:
    """Return what writes the figures of results of a kind."""
    from tractionpower.reporting.figures.many.compare_figures import write_compare_figures
    from tractionpower.reporting.figures.many.sweep_figures import write_sweep_figures
    from tractionpower.reporting.figures.of_run import write_figures, write_outage_figures

    writers = {"contingency": write_outage_figures, "sweep": write_sweep_figures, "compare": write_compare_figures}
    return writers.get(kind, write_figures)

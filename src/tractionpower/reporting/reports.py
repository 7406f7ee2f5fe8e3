"""All reports of a run or of a study of outages, from its results alone: after the run, or later again."""

from __future__ import annotations

from pathlib import Path

from tractionpower.errors import OutputError
from tractionpower.model.scenario import Scenario
from tractionpower.results.disk import reason_of
from tractionpower.results.results import Results

FIGURES = "figures"
WORKBOOK = "report.xlsx"


def write_reports(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write figures and workbook of a run, or of a study of outages, into `folder` and return their paths.

    One report that cannot be written does not hinder the others; tables are not touched.

    Raises
    ------
    OutputError
        If a report cannot be written; all that hinders is told.
    """
    from tractionpower.reporting.figures import write_figures, write_outage_figures  # noqa: PLC0415 - matplotlib and openpyxl are slow to import
    from tractionpower.reporting.workbook import write_workbook  # noqa: PLC0415

    paths: list[Path] = []
    hindrances = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write = write_outage_figures if results.run.get("kind") == "contingency" else write_figures
        paths += write(results, scenario, folder / FIGURES)
    except OSError as error:
        hindrances.append(f"figures cannot be written into {folder / FIGURES}: {reason_of(error)}")
    try:
        paths.append(write_workbook(results, scenario, folder / WORKBOOK))
    except OSError as error:
        hindrances.append(f"{folder / WORKBOOK} cannot be written: {reason_of(error)}")
    if hindrances:
        raise OutputError(f"the tables are complete, but {'; '.join(hindrances)}")
    return paths

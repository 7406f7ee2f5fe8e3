"""The reports of a comparison with a measurement, from its tables alone."""

from __future__ import annotations

from pathlib import Path

from tractionpower.errors import OutputError
from tractionpower.model.report import Report
from tractionpower.reporting.reports import PARTS, source_of
from tractionpower.reporting.texts import language
from tractionpower.results.disk import reason_of
from tractionpower.results.results import Results

FIGURES = "figures"
WORKBOOK = "compare.xlsx"


def write_measured_reports(
    results: Results, folder: Path, report: Report | None = None, *, only: frozenset[str] | None = None
) -> list[Path]:
    """Write figures and workbook of a comparison with a measurement into `folder` and return their paths.

    `report` is the template, None: English, all figures as PNG; `only` names the parts to write, as in `write_reports`.

    Raises
    ------
    OutputError
        If a report cannot be written; the other one is written all the same.
    """
    from tractionpower.reporting.figures.base.drawing import drawing  # noqa: PLC0415
    from tractionpower.reporting.figures.measured_figures import write_measured_figures  # noqa: PLC0415 - matplotlib is slow to import
    from tractionpower.reporting.workbook.measured import write_measured_workbook  # noqa: PLC0415

    report, parts = report or Report(), PARTS if only is None else only
    paths: list[Path] = []
    hindrances = []
    try:
        if "figures" in parts:
            with language(report.language), drawing(report.figures, source_of(results)):
                paths += write_measured_figures(results, folder / FIGURES)
    except OSError as error:
        hindrances.append(f"figures cannot be written into {folder / FIGURES}: {reason_of(error)}")
    try:
        if "workbook" in parts:
            with language(report.language):
                paths.append(write_measured_workbook(results, folder / WORKBOOK))
    except OSError as error:
        hindrances.append(f"{folder / WORKBOOK} cannot be written: {reason_of(error)}")
    if hindrances:
        raise OutputError(f"the tables are complete, but {'; '.join(hindrances)}")
    return paths

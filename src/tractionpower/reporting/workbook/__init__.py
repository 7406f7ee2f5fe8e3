"""Workbooks for people, of a run or of outages: cover with verdicts in words, inputs as used, tables, charts, definitions."""
# ruff: noqa: PLC0415 - openpyxl is imported when a workbook is written

from __future__ import annotations

from pathlib import Path

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import language
from tractionpower.results.results import Results


def write_workbook(
    results: Results, scenario: Scenario | DynamicsScenario | StationsCase, path: Path, report: Report | None = None
) -> Path:
    """Write the workbook of a run, of a study of many or of train dynamics, and return where it is.

    The file gets its name when it is complete. Where another program holds the earlier one open, the new one stands
    beside it, with ``.new`` before its suffix.

    Parameters
    ----------
    results
        What the run found; tables that it did not write are left out.
    scenario
        What was run.
    path
        Name of the file, ``report.xlsx``.
    report
        The template; None: English, all sheets.
    """
    from tractionpower.reporting.workbook.dynamics import book as dynamics_book
    from tractionpower.reporting.workbook.frame.saving import save_as
    from tractionpower.reporting.workbook.outages import outage_book
    from tractionpower.reporting.workbook.run import book
    from tractionpower.reporting.workbook.stations import book as stations_book
    from tractionpower.reporting.workbook.variants import compare, sweep

    report = report or Report()
    builders = {"contingency": outage_book.build, "sweep": sweep.build, "compare": compare.build}
    build = builders.get(str(results.run.get("kind") or ""), book.build)
    with language(report.language):
        if isinstance(scenario, DynamicsScenario):
            return save_as(dynamics_book.build(results, scenario, report), path)
        if isinstance(scenario, StationsCase):
            return save_as(stations_book.build(results, scenario, report), path)
        return save_as(build(results, scenario, report), path)

"""``tractionpower compare``: results folders side by side, or a run beside a measurement."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tractionpower.cli.look import Look, look_of
from tractionpower.cli.messages import tell, tell_results
from tractionpower.cli.options import Force, NoReports, ReportLanguage, Template

if TYPE_CHECKING:
    from tractionpower.studies.compare.study import Comparison


def compare(
    folders: Annotated[list[str], typer.Argument(metavar="DIR DIR ...", help="Folders of results; NAME=DIR names one.")],
    *,
    base: Annotated[
        str | None, typer.Option("--base", metavar="DIR", help="The one that the others are compared with; default the first.")
    ] = None,
    measured: Annotated[
        Path | None, typer.Option("--measured", metavar="FILE", help="CSV file of a measurement to hold one run against.")
    ] = None,
    map_file: Annotated[
        Path | None, typer.Option("--map", metavar="MAP.yaml", help="What the columns of the measured file are.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder of the comparison; default reports/<study>-compare/, or -measured/.")
    ] = None,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the errors against a measurement as JSON.")] = False,
) -> None:
    """Compare the results of several runs, or a run and a measurement."""
    from tractionpower.errors import UsageError

    if measured is None and map_file is None:
        if as_json:
            raise UsageError("--json prints the errors against a measurement; of folders, run.json and tables hold all")
        _compare_folders(folders, base, out, None if no_reports else look_of(template, language), force=force)
        return
    from tractionpower.cli.compare_measured import compare_measured

    if measured is None or map_file is None:
        raise UsageError("a measurement needs both: --measured FILE and --map MAP.yaml")
    if len(folders) != 1:
        raise UsageError(f"{len(folders)} folders: a measurement is held against one run")
    look = None if no_reports else look_of(template, language)
    compare_measured(Path(folders[0]), measured, map_file, out, force=force, look=look, as_json=as_json)


def _compare_folders(folders: list[str], base: str | None, out: Path | None, look: Look | None, *, force: bool) -> None:
    from tractionpower.cli.compare_summary import show
    from tractionpower.studies.compare.study import compare_folders, write_comparison

    comparison = compare_folders(folders, base)
    folder = out if out is not None else Path("reports") / f"{comparison.study}-compare"
    for note in comparison.notes:
        tell(f"note: {note}")
    writer = write_comparison(comparison, folder, force=force)
    show(comparison)
    reports = [] if look is None else _write_reports(comparison, folder, look)
    tell_results(folder, reports, writer.beside)


def _write_reports(comparison: Comparison, folder: Path, look: Look) -> list[Path]:
    from tractionpower.reporting.reports import write_reports
    from tractionpower.results.results import Results

    if comparison.scenario is None:
        tell("no figures and no workbook: the inputs of the base are not kept with its results")
        return []
    tell("writing figures and workbook")
    return write_reports(Results.open(folder), comparison.scenario, folder, look.report(folder))

"""``tractionpower compare``: a run beside a measurement."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def compare(
    folders: Annotated[list[Path], typer.Argument(metavar="DIR", help="Folder that a run has written.")],
    measured: Annotated[
        Path | None, typer.Option("--measured", metavar="FILE", help="CSV file of a measurement to hold the run against.")
    ] = None,
    map_file: Annotated[
        Path | None, typer.Option("--map", metavar="MAP.yaml", help="What the columns of the measured file are.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>-measured/ here.")
    ] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the errors as JSON.")] = False,
) -> None:
    """Hold a run against a measurement."""
    from tractionpower.cli.compare_measured import compare_measured
    from tractionpower.errors import UsageError

    if measured is None or map_file is None:
        raise UsageError("a measurement needs both: --measured FILE and --map MAP.yaml")
    if len(folders) != 1:
        raise UsageError(f"{len(folders)} folders: a measurement is held against one run")
    compare_measured(folders[0], measured, map_file, out, force=force, no_reports=no_reports, as_json=as_json)

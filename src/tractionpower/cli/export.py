"""``tractionpower export DIR``: the tables of a run as CSV, Excel, NetCDF."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def export(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.")],
    to: Annotated[str, typer.Option("--to", metavar="FORMAT,...", help="csv, xlsx, netcdf, or several of them.")],
    out: Annotated[Path | None, typer.Option("--out", help="Folder of the files; default DIR/export.")] = None,
    tables: Annotated[str | None, typer.Option("--tables", metavar="TABLE,...", help="Tables; left out: all.")] = None,
) -> None:
    """Write the tables of a run as CSV, Excel or NetCDF."""
    from tractionpower.cli.messages import tell, tell_beside
    from tractionpower.results.export import export_tables
    from tractionpower.results.results import Results

    results = Results.open(folder)
    target = folder / "export" if out is None else out
    wanted = None if tables is None else _listed(tables)
    paths = export_tables(results, target, _listed(to), wanted)
    for path in paths:
        tell(f"tables: {path}")
    tell_beside(paths)


def _listed(text: str) -> list[str]:
    return [word for word in (part.strip() for part in text.split(",")) if word]

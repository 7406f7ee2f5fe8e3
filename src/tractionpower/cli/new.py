"""``tractionpower new``: a commented study to start from."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from typing import Annotated

import typer


def new(folder: Annotated[str, typer.Argument(metavar="DIR", help="A new or empty folder.")]) -> None:
    """Write a commented study to start from."""
    from tractionpower.io.templates import write_template

    for file in write_template(folder):
        typer.echo(f"wrote {file}")
    typer.echo(f"next: tractionpower check {folder}")

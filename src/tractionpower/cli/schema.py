"""``tractionpower schema``: JSON schemas of the input files."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
from typing import Annotated

import typer


def schema(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="Kind of file; left out: all kinds.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, which this command does anyway.")] = False,
) -> None:
    """Print the JSON schemas of the input files."""
    from tractionpower.io import schemas

    made = schemas.schema(name) if name is not None else {each: schemas.schema(each) for each in schemas.schema_names()}
    typer.echo(json.dumps(made, indent=2))

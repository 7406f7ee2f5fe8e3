"""Arguments and options that several commands share, so that they read the same everywhere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from typer.models import OptionInfo

Study = Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")]
WorkersOfCases = Annotated[int | None, typer.Option("--workers", min=1, help="Cases at a time; default: the cores.")]
SchedulerOfCases = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Dask scheduler whose workers run the cases.")
]
FullTables = Annotated[
    bool, typer.Option("--full-tables", help="Also write the whole results of each case, into DIR-cases/<case>/.")
]
NoReports = Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")]
Force = Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")]
Template = Annotated[
    Path | None,
    typer.Option("--template", metavar="FILE", help="Template of the reports (report.yaml): company, sheets, figures, language."),
]
ReportLanguage = Annotated[str | None, typer.Option("--language", metavar="en|pl", help="Language of the reports.")]
VerdictAsJson = Annotated[bool, typer.Option("--json", help="Print the verdict as JSON.")]


def out_option(default: str) -> OptionInfo:
    """Return ``--out``; `default` is the folder that is taken without it."""
    option: OptionInfo = typer.Option("--out", help=f"Folder of the results; default {default} here.")
    return option


def set_option(words: str) -> OptionInfo:
    """Return ``--set``; `words` say of what it changes an input, or give an example."""
    option: OptionInfo = typer.Option("--set", metavar="KEY=VALUE", help=f"Change an input{words}.")
    return option


def strict_option(when: str) -> OptionInfo:
    """Return ``--strict``; `when` says what makes the command exit with 4."""
    option: OptionInfo = typer.Option("--strict", help=f"Exit with 4 when {when}.")
    return option


Changes = Annotated[list[str] | None, set_option(", e.g. supply.substations[A].state=bypassed")]
ChangesOfCases = Annotated[list[str] | None, set_option(" in all cases, the base included")]

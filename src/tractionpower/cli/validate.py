"""``tractionpower validate``: run the reference cases that ship."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tractionpower.studies.validation import Finding

WIDTH = 120
"""Columns of a table at least; narrower terminals wrap [characters]."""


def validate(
    folder: Annotated[Path | None, typer.Argument(help="Folder with own cases; left out: those that ship.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Run the reference cases; print computed against expected, tolerance, source."""
    from tractionpower.cli.messages import DONE, NOT_COMPLETED
    from tractionpower.errors import UsageError
    from tractionpower.studies.validation import find_cases, run_case

    cases = find_cases(folder)
    if not cases:
        raise UsageError(f"{folder}: no folder with a case.yaml is there")
    findings = []
    for case in cases:
        found = list(run_case(case))
        findings += found
        if not as_json:
            _show(case.name, found)
    missed = sum(not finding.met for finding in findings)
    if as_json:
        typer.echo(json.dumps([asdict(finding) | {"met": finding.met} for finding in findings], indent=1, ensure_ascii=False))
    else:
        typer.echo(f"{len(findings)} figures of {len(cases)} cases: {len(findings) - missed} met, {missed} missed")
    raise typer.Exit(NOT_COMPLETED if missed else DONE)


def _show(case: str, findings: list[Finding]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("check", overflow="fold")
    table.add_column("figure", no_wrap=True)
    for heading in ("expected", "computed", "tolerance"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("")
    last = ""
    for finding in findings:
        if finding.figure == "status" and finding.met:
            continue
        title = f"{finding.check} ({finding.form} form)" if finding.form else finding.check
        first = "" if title == last else title
        numbers = [_shown(value, finding.tolerance) for value in (finding.expected, finding.computed)]
        table.add_row(first, finding.figure, *numbers, f"{finding.tolerance:g}", "met" if finding.met else "MISSED")
        last = title
    console = Console(highlight=False, markup=False)
    console.width = max(console.width, WIDTH)
    console.print(f"{case}: {findings[0].source}", soft_wrap=True, style="bold")
    console.print(table)
    console.print()


def _shown(value: float | str, tolerance: float) -> str:
    """Return a figure with one digit more than its tolerance."""
    if isinstance(value, str):
        return value
    return f"{value:.{max(0, 1 - math.floor(math.log10(tolerance)))}f}"

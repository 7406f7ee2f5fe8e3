"""``tractionpower dynamics check``: every problem of a case of train dynamics at once, and nothing computed."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import dataclasses
from typing import Annotated

import typer

from tractionpower.cli.case_call import CaseName, find_problems
from tractionpower.cli.messages import DONE, INPUT_ERRORS, echo_json, has_errors, summary, tell_problems


def check(case: CaseName, as_json: Annotated[bool, typer.Option("--json", help="Print the problems as JSON.")] = False) -> None:
    """List every problem of a case at once, without computing it."""
    from tractionpower.io.dynamics_files import read_case

    loaded, problems = read_case(case)
    if loaded is not None:
        problems = [*problems, *find_problems(loaded)]
    if as_json:
        echo_json({"format": 1, "case": case, "problems": [dataclasses.asdict(problem) for problem in problems]})
    else:
        tell_problems(problems)
        typer.echo(summary(problems))
    raise typer.Exit(INPUT_ERRORS if has_errors(problems) else DONE)

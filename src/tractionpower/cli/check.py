"""``tractionpower check``: every problem of the inputs at once."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import dataclasses
import json
from typing import Annotated

import typer

from tractionpower.cli.messages import DONE, INPUT_ERRORS, has_errors, summary, tell_problems
from tractionpower.errors import Problem


def check(
    study: Annotated[str, typer.Argument(metavar="STUDY", help="Folder of a study, a study file, or a shipped line.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the problems as JSON.")] = False,
) -> None:
    """List every problem of the inputs at once."""
    problems = find_problems(study)
    if as_json:
        listed = [dataclasses.asdict(problem) for problem in problems]
        typer.echo(json.dumps({"format": 1, "study": study, "problems": listed}, indent=2))
    else:
        tell_problems(problems)
        typer.echo(summary(problems))
    raise typer.Exit(INPUT_ERRORS if has_errors(problems) else DONE)


def find_problems(study: str) -> list[Problem]:
    """Return all problems of a study, each with its file and line.

    Raises
    ------
    UsageError
        If there is no such study.
    """
    from tractionpower.cosimulation.check import check_scenario
    from tractionpower.io.scenario_files import read_scenario

    loaded, problems = read_scenario(study)
    if loaded is None:
        return problems
    return [*problems, *loaded.provenance.place(check_scenario(loaded.scenario))]

"""What the command line says: problems grouped by file, and exceptions as a message and an exit code."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import IO, TYPE_CHECKING, Any, Protocol, runtime_checkable

import typer

from tractionpower.errors import InputError, OutputError, Problem, UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from rich.console import Console
    from rich.text import Text

DONE = 0
INPUT_ERRORS = 1
WRONG_USAGE = 2
NOT_COMPLETED = 3
LIMIT_VIOLATED = 4

_NO_PLACE = "the study as a whole"

_SENTENCE = re.compile(r"^(there|no|neither|begins|ends)\b|^[^:]* (is|are|has|have|lies|say|both say|all say)\b")
"""What was found in words that say themselves that something is so, or is not there."""


@runtime_checkable
class _CommandLineError(Protocol):
    # Newer typer carries its own copy of click, so its errors are known by what they can do.
    exit_code: int

    def show(self) -> None: ...


def exit_code_of(error: BaseException) -> int | None:
    """Tell an exception on stderr and return its exit code; None, and nothing said, if it is a defect of the program."""
    if isinstance(error, InputError):
        tell_problems(error.problems)
        tell(summary(error.problems))
        return INPUT_ERRORS
    if isinstance(error, UsageError | OutputError):
        tell(f"tractionpower: {error}")
        return WRONG_USAGE if isinstance(error, UsageError) else NOT_COMPLETED
    if isinstance(error, KeyboardInterrupt | typer.Abort):
        tell("tractionpower: interrupted")
        return NOT_COMPLETED
    if isinstance(error, BrokenPipeError):
        # The reader of a pipe, such as head, has enough.
        close_quietly(sys.stdout)
        return DONE
    if isinstance(error, _CommandLineError):
        error.show()
        return error.exit_code
    return None


def close_quietly(stream: IO[str]) -> None:
    """Let what a stream still holds, and what is yet to come, go nowhere, so that the end of the process is quiet."""
    with suppress(OSError, ValueError):  # a stream of a test or a notebook has no file
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, stream.fileno())
        finally:
            os.close(nowhere)


def tell(text: str) -> None:
    """Print one line on stderr; nobody has to read it."""
    try:
        print(text, file=sys.stderr)
    except BrokenPipeError:
        close_quietly(sys.stderr)


def echo_json(document: Mapping[str, Any]) -> None:
    """Print what a command has found as JSON."""
    typer.echo(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))


def tell_results(folder: Path, reports: Sequence[Path], beside: Iterable[Path]) -> None:
    """Say where results and reports are; `beside` are files of the results that another program held open."""
    tell(f"results: {folder}")
    tell_reports(reports)
    tell_beside(beside)


FIGURES = (".png", ".svg", ".pdf")
"""Suffixes of figures."""


def tell_reports(paths: Sequence[Path]) -> None:
    """Say where the reports are, and which of them stands beside one that is held open."""
    figures = [path for path in paths if path.suffix in FIGURES]
    if figures:
        tell(f"figures: {len(figures)} in {figures[0].parent}")
    for path in paths:
        if path not in figures:
            tell(f"report: {path}")
    tell_beside(paths)


def tell_beside(paths: Iterable[Path]) -> None:
    """Say of which of the files that were written another program holds the earlier one open."""
    from tractionpower.results.disk import is_beside

    for path in paths:
        if is_beside(path):
            tell(f"{path.name} was written beside a file that another program holds open")


def tell_problems(problems: Iterable[Problem]) -> None:
    """Print problems on stderr, grouped by file, errors and warnings told apart."""
    console = _console()
    for file, group in _by_file(problems).items():
        console.print(_plain(file, "bold"))
        for problem in group:
            _print_problem(console, problem)


def summary(problems: Sequence[Problem]) -> str:
    """Return how many errors and warnings there are.

    >>> summary([])
    'no problems'
    """
    errors = sum(problem.severity == "error" for problem in problems)
    counts = (errors, "error"), (len(problems) - errors, "warning")
    texts = [f"{count} {word}{'s' if count > 1 else ''}" for count, word in counts if count]
    return ", ".join(texts) or "no problems"


def has_errors(problems: Iterable[Problem]) -> bool:
    """Return whether one of `problems` stops a run."""
    return any(problem.severity == "error" for problem in problems)


def _by_file(problems: Iterable[Problem]) -> dict[str, list[Problem]]:
    groups: dict[str, list[Problem]] = {}
    for problem in problems:
        file, _, line = problem.place.rpartition(":")
        groups.setdefault((file if line.isdecimal() else problem.place) or _NO_PLACE, []).append(problem)
    return groups


def _print_problem(console: Console, problem: Problem) -> None:
    text = _plain(f"  {problem.severity}", "bold red" if problem.severity == "error" else "bold yellow")
    text.append(": ")
    if problem.place:
        text.append(f"{problem.place}: ", "cyan")
    if problem.path:
        text.append(f"{problem.path}: ")
    text.append(f"found {problem.found}" if problem.allowed and not _SENTENCE.search(problem.found) else problem.found)
    for word, value in (("allowed", problem.allowed), ("remedy", problem.remedy)):
        if value:
            text.append(f"\n      {word}: {value}")
    console.print(text)


def _console() -> Console:
    # Imported here: rich is not needed by those who only ask for help.
    from tractionpower.cli.closed_pipes import PatientConsole

    return PatientConsole(stderr=True, soft_wrap=True, highlight=False, markup=False, emoji=False)


def _plain(text: str, style: str) -> Text:
    # A Text is printed as it is: brackets in a user's names are no markup.
    from rich.text import Text

    return Text.assemble((text, style))

"""The command line: thin commands over the library.

A command is a function in a module of its own; it imports numba, pandas and the models inside itself, so that ``--help``
answers at once. To add one: import its module and add a line to the list below.
"""

from __future__ import annotations

import importlib.metadata
import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from tractionpower.cli import (
    check,
    compare,
    contingency,
    curves,
    dynamics,
    export,
    feasibility,
    import_,
    journey,
    new,
    report,
    run,
    schema,
    size,
    sweep,
    validate,
)
from tractionpower.cli.messages import DONE, exit_code_of

app = typer.Typer(
    name="tractionpower",
    help="Co-simulation of electric-traction power supply and train movement.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # plain help needs no rich and answers faster
    pretty_exceptions_enable=False,
)
app.command("run")(run.run)
app.command("check")(check.check)
app.command("journey")(journey.journey)
app.command("curves")(curves.curves)
app.command("feasibility")(feasibility.feasibility)
app.command("contingency")(contingency.contingency)
app.command("size")(size.size)
app.command("sweep")(sweep.sweep)
app.command("compare")(compare.compare)
app.add_typer(dynamics.app)
app.command("report")(report.report)
app.command("export")(export.export)
app.command("import")(import_.import_)
app.command("validate")(validate.validate)
app.command("schema")(schema.schema)
app.command("new")(new.new)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0 done, 1 errors in the input, 2 wrong usage, 3 not completed, 4 a limit is violated (with ``--strict`` only).
    """
    command = typer.main.get_command(app)
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        # Not command.main(): it has exit codes of its own for Ctrl-C.
        with command.make_context("tractionpower", given) as context:
            command.invoke(context)
        sys.stdout.flush()
    except typer.Exit as leave:
        return leave.exit_code
    except (Exception, KeyboardInterrupt) as error:
        code = exit_code_of(error)
        if code is None:
            raise
        return code
    return DONE


def _show_version(wanted: bool) -> None:
    if not wanted:
        return
    try:
        version = importlib.metadata.version("tractionpower")
    except importlib.metadata.PackageNotFoundError:  # run from a source folder
        version = "(not installed)"
    typer.echo(f"tractionpower {version}")
    raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and leave.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    pass


if __name__ == "__main__":
    sys.exit(main())

"""``tractionpower dynamics drive CASE``: drive a train from a page in the browser, in real time."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tractionpower.cli.case_call import CaseName, ChangesOfCase, call_case
from tractionpower.cli.look import look_of
from tractionpower.cli.messages import tell
from tractionpower.cli.options import Force, NoReports, Template, out_option
from tractionpower.cli.study_call import exit_code

if TYPE_CHECKING:
    from tractionpower.results.store import RunWriter
    from tractionpower.web.live import LiveRun

Language = Annotated[
    str | None, typer.Option("--language", metavar="en|pl", help="Language of the reports; the driving page is in English.")
]

NEEDED = "the driving page needs the package aiohttp: pip install tractionpower[drive]"


def drive(
    case: CaseName,
    *,
    out: Annotated[Path | None, out_option("reports/dynamics-<case>-driven/")] = None,
    changes: ChangesOfCase = None,
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port of the page; 0: one that is free.")] = 0,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only, open no browser.")] = False,
    stay: Annotated[bool, typer.Option("--stay", help="Go on when the page is closed; without it the drive ends then.")] = False,
    no_reports: NoReports = False,
    template: Template = None,
    language: Language = None,
    force: Force = False,
) -> None:
    """Drive a train from a page in the browser, in real time, and write the results."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.dynamics_summary import show

    _need_aiohttp()
    call = call_case(case, changes or (), out, look_of(template, language))
    _refuse_others(call.kind, case)
    driven = f"{call.name}-driven"
    call = replace(call, folder=call.folder if out is not None else Path("reports") / f"dynamics-{driven}")
    call.greet()
    warn_of_compilation("advance_chain")
    with call.preparing(force=force, study=driven) as writer:
        from tractionpower.web.live import LiveRun

        live = LiveRun(call.scenario, writer, driven, call.loaded.problems)
    call.warn(live.warnings)
    failure = _drive(live, writer, port=port, no_browser=no_browser, leave_s=None if stay else 15.0)
    if not live.has_driven:
        writer.discard()
        tell("nothing was driven, so nothing is written")
        raise typer.Exit(exit_code(flagged=bool(failure), holds=True, strict=False))
    outcome = live.finish(failure)
    show(outcome.run, outcome.key_figures, call.units)
    tell(f"as it was driven: {live.folder}; `tractionpower dynamics run {live.folder}` computes it again")
    call.leave(writer, exit_code(flagged=outcome.flagged, holds=True, strict=False), no_reports=no_reports)


def _drive(live: LiveRun, writer: RunWriter, *, port: int, no_browser: bool, leave_s: float | None) -> str:
    """Serve the page until the drive ends; return what has ended it where it could not be computed on."""
    from tractionpower.dynamics.session import NotComputableError
    from tractionpower.web.controls import Controls
    from tractionpower.web.drive import Drive, drive
    from tractionpower.web.hello import has_independent_brake, hello, highest_levels

    compiled = live.session.compiled
    failure = ""
    try:
        live.begin()
        controls = Controls(highest_levels(compiled), independent=has_independent_brake(compiled))
        what = Drive(live.session, controls, live, hello(compiled, str(writer.folder)))
        ended = drive(what, lambda address: _tell_address(address, no_browser=no_browser), port=port, leave_s=leave_s)
        given_up = f", {ended.given_up_s:.1f} s could not be caught up" if ended.given_up_s > 0.0 else ""
        tell(f"driven for {live.session.time_s:.1f} s; longest lag behind the clock {1e3 * ended.longest_lag_s:.1f} ms{given_up}")
    except NotComputableError as error:
        failure = str(error)
    except BaseException:
        live.abandon()
        raise
    live.close()
    return failure


def _tell_address(address: str, *, no_browser: bool) -> None:
    import threading
    import webbrowser

    tell(f"driving page: {address}")
    tell("Finish on the page, or Ctrl-C here, ends the drive and writes its results")
    has_screen = sys.platform in {"win32", "darwin"} or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    if has_screen and not no_browser:  # without a screen it would be a browser in this very terminal
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


def _refuse_others(kind: str, case: str) -> None:
    from tractionpower.errors import UsageError

    if kind != "dynamics":
        raise UsageError(
            f"{case} is no train as many vehicles, which alone can be driven; `tractionpower dynamics run` computes it"
        )


def _need_aiohttp() -> None:
    from importlib.util import find_spec

    from tractionpower.errors import UsageError

    if find_spec("aiohttp") is None:
        raise UsageError(NEEDED)

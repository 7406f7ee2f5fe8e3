"""``tractionpower report DIR``: the reports of an earlier run again, of all of it or of a part, without a simulation."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import look_of
from tractionpower.cli.options import ReportLanguage, Template

if TYPE_CHECKING:
    from tractionpower.model.report import Report
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.results import Results
    from tractionpower.results.selection.selection import Selection

SELECTED = "selected"
"""Folder beside the reports of the whole run for those of a part."""


def report(  # noqa: PLR0917 - typer gives each option by name
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Read what a run that broke off has left; the reports go into DIR/partial.")
    ] = False,
    trains: Annotated[list[str] | None, typer.Option("--train", metavar="ID", help="Only this train; may be repeated.")] = None,
    tracks: Annotated[list[str] | None, typer.Option("--track", metavar="ID", help="Only this track; may be repeated.")] = None,
    begin: Annotated[str | None, typer.Option("--from", metavar="HH:MM[:SS]", help="Only from this time of day on.")] = None,
    end: Annotated[str | None, typer.Option("--to", metavar="HH:MM[:SS]", help="Only until this time of day.")] = None,
    from_km: Annotated[float | None, typer.Option("--from-km", help="Only from this kilometre on.")] = None,
    to_km: Annotated[float | None, typer.Option("--to-km", help="Only up to this kilometre.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help=f"Folder of the reports; default DIR, of a part DIR/{SELECTED}/<what>.")
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only", metavar="WHAT", help="Only the workbook, the figures, or the figure of this name; may be repeated."
        ),
    ] = None,
    formats: Annotated[
        list[str] | None, typer.Option("--format", metavar="png|svg|pdf", help="Kind of files of figures; may be repeated.")
    ] = None,
    template: Template = None,
    language: ReportLanguage = None,
) -> None:
    """Write the reports of an earlier run again, of all of it or of a part."""
    from tractionpower.cli.messages import tell, tell_reports
    from tractionpower.errors import UsageError
    from tractionpower.reporting.measured import write_measured_reports
    from tractionpower.reporting.reports import write_reports
    from tractionpower.results.results import Results

    look, choice = look_of(template, language), _choice(only, formats)
    selection = _selection(trains, tracks, (begin, end), (from_km, to_km))
    results = Results.open(folder, partial=partial)
    if results.run.get("kind") == "measured" and selection.is_everything:
        report = choice.of(look.report(folder, is_new=False, keep=out is None))
        tell_reports(write_measured_reports(results, out or folder, report, only=choice.parts))
        return
    scenario = _scenario(results, folder)
    choice.check(scenario)
    target = out or _folder(folder, selection, partial=partial)
    status = results.run.get("status")
    if not selection.is_everything:
        from tractionpower.results.selection.select import select

        results, scenario = select(results, scenario, selection)
        tell(f"a part of the run: {', '.join(f'{name} {results.row_count(name)} rows' for name in results.tables)}")
        for train in results.run["selection"].get("without_rows", ()):
            tell(f"train {train} has no row in this part")
    elif target.exists() and not target.is_dir():
        raise UsageError(f"{target} is no folder")
    report = choice.of(look.report(folder, is_new=False, keep=target == folder))
    tell_reports(write_reports(results, scenario, target, report, only=choice.parts))
    if status != "complete":
        tell(f"the run is {status}: the reports hold what is in its tables")


@dataclass(frozen=True, slots=True)
class Choice:
    """What the options choose to write: parts (None: all), names of figures and kinds of files (none: as the template says)."""

    parts: frozenset[str] | None = None
    names: tuple[str, ...] = ()
    formats: tuple[str, ...] = ()

    def check(self, scenario: Scenario) -> None:
        """Refuse names that no figure has."""
        if not self.names:
            return
        from tractionpower.errors import UsageError
        from tractionpower.reporting.figures.registry import figure_names, unknown_names

        unknown = unknown_names(self.names, scenario)
        if unknown:
            known = ", ".join(["workbook", "figures", *sorted({*figure_names(), "trains/ID"})])
            raise UsageError(f"--only {unknown[0]}: there is no such figure; known are {known}")

    def of(self, report: Report) -> Report:
        """Return the template with the figures that the options choose; beside those chosen, others stay as they are."""
        from tractionpower.model.report import ReportFigures

        names = self.names or report.figures.names
        figures = ReportFigures.model_validate({"formats": self.formats or report.figures.formats, "names": names})
        return report.model_copy(update={"figures": figures})


def _choice(only: list[str] | None, formats: list[str] | None) -> Choice:
    from typing import get_args

    from tractionpower.errors import UsageError
    from tractionpower.model.report import FigureFormat

    known = get_args(FigureFormat)
    unknown = [each for each in formats or () if each not in known]
    if unknown:
        raise UsageError(f"--format {unknown[0]}: figures are written as {', '.join(known)}")
    wanted = {*(only or ())}
    names = tuple(sorted(wanted - {"workbook", "figures"}))
    parts = frozenset(wanted - {*names} | ({"figures"} if names else set()))
    return Choice(parts or None, names, tuple(dict.fromkeys(formats or ())))


def _selection(
    trains: list[str] | None,
    tracks: list[str] | None,
    times: tuple[str | None, str | None],
    places_km: tuple[float | None, float | None],
) -> Selection:
    from tractionpower.errors import UsageError
    from tractionpower.model.base import parse_time
    from tractionpower.results.selection.selection import Selection

    given: dict[str, Any] = {"trains": tuple(trains or ()), "tracks": tuple(tracks or ())}
    for name, option, text in zip(("from_s", "to_s"), ("--from", "--to"), times, strict=True):
        if text is not None:
            given[name] = parse_time(text)
            if given[name] is None:
                raise UsageError(f"{option} {text!r}: a time is HH:MM or HH:MM:SS, beyond 24:00:00 for the next day")
    given |= {name: km for name, km in zip(("from_km", "to_km"), places_km, strict=True) if km is not None}
    return Selection(**given)


def _scenario(results: Results, folder: Path) -> Scenario:
    """Return what was computed, of results that reports can be made of."""
    from tractionpower.errors import UsageError

    if "journeys" in results.run:
        raise UsageError(f"{folder} holds theoretical journeys, not a run; `tractionpower journey` draws them")
    scenario: Scenario | None = results.scenario
    if scenario is None:
        raise UsageError(f"{folder}: the inputs are not kept with these results (scenario.json); run the study again")
    if not results.tables:
        raise UsageError(f"{folder}: no table is there to report on; run the study again")
    return scenario


def _folder(folder: Path, selection: Selection, *, partial: bool) -> Path:
    """Return where the reports go: to the results, or of a part into a folder that says of which."""
    from tractionpower.io.file_names import ENDING, file_names
    from tractionpower.results.store import PARTIAL

    base = folder / PARTIAL if partial else folder
    if selection.is_everything:
        return base
    told = selection.as_dict()
    words = [*(f"train {name}" for name in told.get("trains", ())), *(f"track {name}" for name in told.get("tracks", ()))]
    words += [f"{key} {told[key].replace(':', '.')}" for key in ("from", "to") if key in told]
    words += [f"{key} {told[f'{key}_km']:g} km" for key in ("from", "to") if f"{key}_km" in told]
    name = " ".join(words)
    return base / SELECTED / file_names([name])[name].removesuffix(ENDING)

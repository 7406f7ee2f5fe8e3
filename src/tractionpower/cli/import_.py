"""``tractionpower import KIND SRC DIR``: lines, trains and timetables of other formats."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tractionpower.io.imports.imported import Notes


def import_(  # noqa: PLR0917 - typer makes options of them
    kind: Annotated[str, typer.Argument(metavar="KIND", help="gtfs, timetable (CSV, Excel), ttobench, trainruns, railtoolkit.")],
    source: Annotated[Path, typer.Argument(metavar="SRC", help="The file or folder to read.")],
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the study that is written.")],
    repair: Annotated[bool, typer.Option("--repair", help="Mend what is wrong where it can be, and say what.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Write into a folder with files; those of the same name go.")] = False,
    train: Annotated[
        str | None, typer.Option("--train", metavar="ID", help="Train of runs that name none; ttobench, railtoolkit: its file.")
    ] = None,
    dwell: Annotated[
        float | None, typer.Option("--dwell", metavar="S", min=0, help="gtfs, timetable: shortest dwell at stops [s].")
    ] = None,
    line: Annotated[
        str | None, typer.Option("--line", metavar="STUDY", help="timetable: study with its line and supply.")
    ] = None,
    tracks: Annotated[
        str | None, typer.Option("--tracks", metavar="T1,T2", help="timetable: tracks of rising and falling kilometres.")
    ] = None,
    sheet: Annotated[str | None, typer.Option("--sheet", help="timetable: the only sheet to read.")] = None,
    date: Annotated[str | None, typer.Option("--date", help="gtfs: the day of operation, YYYY-MM-DD.")] = None,
    day: Annotated[str | None, typer.Option("--day", help="gtfs: a day of the week, mon to sun.")] = None,
    routes: Annotated[str | None, typer.Option("--routes", metavar="ID,...", help="gtfs: routes; left out: all by rail.")] = None,
    agencies: Annotated[str | None, typer.Option("--agencies", metavar="ID,...", help="gtfs: agencies; left out: all.")] = None,
    stops: Annotated[str | None, typer.Option("--stops", metavar="FILE.csv", help="gtfs: places of stops that override.")] = None,
    double: Annotated[
        str | None, typer.Option("--double", metavar="A..B,...", help="gtfs: stretches of double track, or all, or none.")
    ] = None,
    speed: Annotated[float | None, typer.Option("--speed", metavar="KMH", help="gtfs: speed limit of the line [km/h].")] = None,
    stop_tolerance: Annotated[
        float | None, typer.Option("--stop-tolerance", metavar="M", help="gtfs: how far a stop may lie off the shape [m].")
    ] = None,
    name: Annotated[str | None, typer.Option("--name", help="gtfs: name of the line.")] = None,
    track: Annotated[str | None, typer.Option("--track", metavar="FILE", help="ttobench: file of a journey's track.")] = None,
) -> None:
    """Read lines, trains and timetables of other formats into a study."""
    from tractionpower.cli.messages import DONE, INPUT_ERRORS, has_errors, summary, tell, tell_problems
    from tractionpower.io.imports.kinds import KINDS, read_source
    from tractionpower.io.text_files import write_files

    _refuse_files(folder, force or kind not in KINDS or KINDS[kind].adds)
    options = {
        "repair": repair, "train": train, "dwell": dwell, "line": line, "tracks": tracks, "sheet": sheet, "date": date,
        "day": day, "routes": routes, "agencies": agencies, "stops": stops, "double": double, "speed": speed,
        "stop-tolerance": stop_tolerance, "name": name, "track": track,
    }  # fmt: skip
    imported = read_source(kind, source, folder, options)
    notes = imported.notes
    if not has_errors(notes.problems):
        _refuse_overwriting(folder, imported.texts, force)
    _show(notes)
    tell_problems(notes.problems)
    if has_errors(notes.problems):
        tell(f"{summary(notes.problems)}; nothing was written")
        raise typer.Exit(INPUT_ERRORS)
    write_files(folder, imported.texts)
    typer.echo(f"wrote {len(imported.texts)} files into {folder}: {', '.join(_few(list(imported.texts)))}")
    typer.echo(f"next: {_next(folder, list(imported.texts))}")
    raise typer.Exit(DONE)


def _next(folder: Path, names: list[str]) -> str:
    """Return what to do with the files: check a study, look at rolling stock, which is none by itself."""
    from tractionpower.io.finder import STUDY_FILE

    if (folder / STUDY_FILE).is_file():
        return f"tractionpower check {folder}"
    trains = [name for name in names if "/trains/" in name] or [name for name in names if "/vehicles/" in name]
    if not trains:
        return f"add {STUDY_FILE} to {folder}"
    return f"tractionpower curves {folder / trains[0]}; there is no {STUDY_FILE} in {folder}, rolling stock is part of a study"


def _refuse_files(folder: Path, force: bool) -> None:
    from tractionpower.errors import UsageError

    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder} is a file; give a folder")
    if not force and folder.is_dir() and any(folder.iterdir()):
        raise UsageError(f"the folder {folder} is not empty; give a new one, or --force to write into it")


def _refuse_overwriting(folder: Path, texts: dict[str, str], force: bool) -> None:
    from tractionpower.errors import UsageError

    there = [name for name in texts if (folder / name).exists()]
    if there and not force:
        raise UsageError(f"{folder} holds {', '.join(_few(there))} already; --force replaces them")


def _show(notes: Notes) -> None:
    for word, texts in (
        ("read", notes.read),
        ("assumed", notes.assumed),
        ("repaired", notes.repaired),
        ("ignored", notes.ignored),
    ):
        for number, text in enumerate(texts):
            typer.echo(f"{word + ':' if number == 0 else '':<10} {text}")


def _few(names: list[str], most: int = 6) -> list[str]:
    return names if len(names) <= most else [*names[: most - 1], f"{len(names) - most + 1} more"]

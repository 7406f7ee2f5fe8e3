"""The importers by the name of what they read; each is loaded when it is asked for."""

from __future__ import annotations

import importlib
import inspect
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.io.imports.imported import Imported
from tractionpower.io.wording import did_you_mean, printable, shown


@dataclass(frozen=True, slots=True)
class Kind:
    """An importer: its module and function, what it reads in words, and whether it adds to a folder that holds a study."""

    module: str
    function: str
    words: str
    adds: bool = False


KINDS = {
    "gtfs": Kind("gtfs", "read_gtfs", "a GTFS feed, a folder or a .zip: line, stations and timetable"),
    "timetable": Kind(
        "table_timetables", "read_table_timetable", "a timetable as CSV or Excel, for a line that exists", adds=True
    ),
    "ttobench": Kind("ttobench", "read_ttobench", "a track, or a track and a train, of TTOBench (JSON)"),
    "trainruns": Kind("railtoolkit", "read_trainruns", "a running path and a train of TrainRuns (YAML)"),
    "railtoolkit": Kind("railtoolkit", "read_railtoolkit", "paths and rolling stock of railtoolkit (YAML)"),
}
"""Kinds of sources by name."""

OPTIONS = {"dwell_s": "--dwell"}
"""Options whose name on the command line is not that of the argument."""


def read_source(kind: str, source: Path, folder: Path, options: dict[str, Any]) -> Imported:
    """Read a source for a folder.

    Parameters
    ----------
    kind
        What it is, a key of `KINDS`.
    source, folder
        The file or folder to read, and the folder that the files are for.
    options
        What the user chose; those left out are None or False. The importer takes what its function names.

    Raises
    ------
    UsageError
        If there is no such kind or source, or an option is none of this kind.
    """
    if kind not in KINDS:
        hint = did_you_mean(kind, KINDS)
        raise UsageError("; ".join(part for part in (f"no kind {shown(kind)}", hint, f"kinds: {', '.join(KINDS)}") if part))
    if not source.exists():
        raise UsageError(f"there is no file or folder {printable(str(source))}")
    read = getattr(importlib.import_module(f"tractionpower.io.imports.{KINDS[kind].module}"), KINDS[kind].function)
    taken = inspect.signature(read).parameters
    given = {name: value for name, value in options.items() if value is not None and value is not False}
    for name in given:
        if name not in taken:
            raise UsageError(f"{OPTIONS.get(name, '--' + name)} is no option of kind {kind}")
    where = (source, folder) if "folder" in taken else (source,)
    imported: Imported = read(*where, **given)
    return imported

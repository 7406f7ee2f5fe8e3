"""The importers by the name of what they read; each is loaded when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.io.imports.imported import Imported
from tractionpower.io.wording import did_you_mean, printable, shown

Option = tuple[str, Callable[[Any], Any]]
"""Name of an argument, and what makes its value of that of the command line."""


@dataclass(frozen=True, slots=True)
class Kind:
    """An importer.

    Attributes
    ----------
    module, function
        Where it is.
    options
        Its options by their names on the command line.
    adds
        Whether it adds to a folder that holds a study, and is told which.
    folder
        Name of the argument by which another one is told the folder of the study, for its rolling stock.
    """

    module: str
    function: str
    options: Mapping[str, Option]
    adds: bool = False
    folder: str | None = None


def _listed(text: str) -> tuple[str, ...]:
    return tuple(word for word in (part.strip() for part in text.split(",")) if word)


_RAILTOOLKIT: Mapping[str, Option] = {"repair": ("repair", bool), "train": ("train", Path)}

KINDS: Mapping[str, Kind] = {
    "gtfs": Kind(
        "gtfs.reading",
        "read_gtfs",
        {
            "repair": ("repair", bool),
            "date": ("date", str),
            "day": ("day", str),
            "routes": ("routes", _listed),
            "agencies": ("agencies", _listed),
            "stops": ("stops", Path),
            "train": ("train", str),
            "dwell": ("min_dwell_s", float),
            "speed": ("speed_kmh", float),
            "double": ("double", _listed),
            "stop-tolerance": ("stop_tolerance_m", float),
            "name": ("name", str),
        },
        folder="folder",
    ),
    "timetable": Kind(
        "tables.reading",
        "read_table_timetable",
        {
            "line": ("line", str),
            "train": ("train", str),
            "tracks": ("tracks", str),
            "sheet": ("sheet", str),
            "dwell": ("dwell_s", float),
        },
        adds=True,
    ),
    "ttobench": Kind("ttobench.reading", "read_ttobench", {**_RAILTOOLKIT, "track": ("track", Path)}),
    "trainruns": Kind("railtoolkit.reading", "read_railtoolkit", _RAILTOOLKIT),  # its files are of railtoolkit's format
    "railtoolkit": Kind("railtoolkit.reading", "read_railtoolkit", _RAILTOOLKIT),
}
"""Kinds of sources by name."""


def read_source(kind: str, source: Path, folder: Path, options: Mapping[str, Any]) -> Imported:
    """Read a source for a folder.

    Parameters
    ----------
    kind
        What it is, a key of `KINDS`.
    source, folder
        The file or folder to read, and the folder that the files are for.
    options
        What the user chose, by the names of the command line; those left out are None or False.

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
    found = KINDS[kind]
    given: dict[str, Any] = {} if found.folder is None else {found.folder: folder}
    for name, value in options.items():
        if value is None or value is False:
            continue
        if name not in found.options:
            known = ", ".join(f"--{each}" for each in found.options)
            raise UsageError(f"--{name} is no option of kind {kind}; it has {known}")
        argument, made = found.options[name]
        given[argument] = made(value)
    read = getattr(importlib.import_module(f"tractionpower.io.imports.{found.module}"), found.function)
    imported: Imported = read(source, folder, **given) if found.adds else read(source, **given)
    return imported

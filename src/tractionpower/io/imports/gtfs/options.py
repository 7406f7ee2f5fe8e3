"""What a GTFS import can be told; the command line takes names, defaults and texts from here."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tractionpower.io.imports.gtfs.shapes import OFF_SHAPE_M

HELP = {
    "date": "Day whose trips are read, YYYYMMDD or YYYY-MM-DD; left out: the first Wednesday with most trips.",
    "day": "Day of the week in place of Wednesday: mon, tue, wed, thu, fri, sat, sun.",
    "routes": "Routes to read, by route_id or short name; left out: all routes by rail.",
    "agencies": "Agencies to read, by agency_id or name; left out: all.",
    "repair": "Mend what can be mended, and tell it, instead of refusing.",
    "stops": "CSV file with stop_id, km and perhaps track (number of the line): places in place of those found.",
    "train": "Train of the rolling stock that runs every trip.",
    "min_dwell_s": "Shortest dwell at stops on the way [s].",
    "speed_kmh": "Speed limit of the whole line [km/h].",
    "double": "Stretches of double track as FROM..TO by stop_id, or `all`, or `none`; each track has one direction.",
    "stop_tolerance_m": "Distance of a stop from its shape from which on it is off the shape [m].",
    "folder": "Folder of the study, whose own rolling stock counts first.",
    "name": "Name of the line; left out: that of the agency.",
}
"""What each field of `GtfsOptions` means."""


@dataclass(frozen=True, slots=True)
class GtfsOptions:
    """Options of `read_gtfs`; `HELP` says what each means."""

    date: str | None = None
    day: str | None = None
    routes: tuple[str, ...] = ()
    agencies: tuple[str, ...] = ()
    repair: bool = False
    stops: Path | None = None
    train: str = "en57"
    min_dwell_s: float = 20.0
    speed_kmh: float = 120.0
    double: tuple[str, ...] = ("all",)
    stop_tolerance_m: float = OFF_SHAPE_M
    name: str = ""
    folder: Path | None = None

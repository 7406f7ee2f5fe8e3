"""Small GTFS feeds: a line of four stops along a circle of latitude, every file of which can be replaced."""

from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from tractionpower.io.imports.gtfs.reading import read_gtfs
from tractionpower.io.imports.imported import Imported

LAT = 50.0
STEP = 0.02  # degrees of longitude between stops
KM = 0.02 * 71.696  # of one degree of longitude at 50 degrees, as tables of the ellipsoid have it


def stop(name: str, step: float, north: float = 0.0, **more: str) -> dict[str, str]:
    return {"stop_id": name, "stop_name": f"Stop {name}", "stop_lat": f"{LAT + north}", "stop_lon": f"{20 + STEP * step}", **more}


def calls(trip: str, *rows: str) -> list[dict[str, str]]:
    """Return rows of stop_times; each is `STOP ARRIVAL DEPARTURE`, `STOP TIME` for both, or `STOP` for none."""
    found = []
    for k, row in enumerate(rows):
        name, arrival, departure = [*row.split(), "", ""][:3]
        departure = departure or arrival
        times = {"arrival_time": arrival, "departure_time": departure}
        found.append({"trip_id": trip, "stop_id": name, "stop_sequence": str(10 * k), **times})
    return found


def shape(name: str, *points: tuple[float, float]) -> list[dict[str, str]]:
    """Return rows of shapes; points are steps to the east and degrees to the north."""
    return [
        {"shape_id": name, "shape_pt_sequence": str(k), "shape_pt_lat": f"{LAT + north}", "shape_pt_lon": f"{20 + STEP * step}"}
        for k, (step, north) in enumerate(points)
    ]


def trip(name: str, shape_id: str = "east", route: str = "R1", service: str = "D", **more: str) -> dict[str, str]:
    return {"route_id": route, "service_id": service, "trip_id": name, "shape_id": shape_id, "direction_id": "0", **more}


WEEK = {day: "1" for day in ("monday", "tuesday", "wednesday", "thursday", "friday")} | {"saturday": "0", "sunday": "0"}


def tables() -> dict[str, list[dict[str, str]]]:
    """Return the tables of a sound feed: T1 runs to the east, T2 to the west, B1 is a bus, S1 runs on Saturdays only."""
    east = calls("T1", "A 06:00:00", "B 06:02:00", "C 06:04:00 06:05:00", "D 06:07:00")
    west = calls("T2", "D 07:00:00", "C 07:02:00", "B 07:04:00", "A 07:06:00")
    others = calls("S1", "A 08:00:00", "D 08:09:00") + calls("B1", "A 09:00:00", "D 09:30:00")
    validity = {"start_date": "20230601", "end_date": "20230630"}
    return {
        "agency": [{"agency_id": "0", "agency_name": "Small railway"}],
        "routes": [
            {"route_id": "R1", "agency_id": "0", "route_short_name": "R", "route_type": "2"},
            {"route_id": "Z1", "agency_id": "0", "route_short_name": "Z", "route_type": "3"},
        ],
        "trips": [trip("T1"), trip("T2", "west", direction_id="1"), trip("S1", service="S"), trip("B1", route="Z1")],
        "stops": [stop("A", 0), stop("B", 1), stop("C", 2), stop("D", 3)],
        "stop_times": east + west + others,
        "shapes": shape("east", (0, 0), (1.4, 0), (3, 0)) + shape("west", (3, 0), (0, 0)),
        "calendar": [
            {"service_id": "D", **WEEK, **validity},
            {"service_id": "S", **dict.fromkeys(WEEK, "0"), "saturday": "1", **validity},
        ],
        "calendar_dates": [{"service_id": "D", "date": "20230608", "exception_type": "2"}],
    }


def text_of(rows: list[dict[str, str]]) -> str:
    columns = list(dict.fromkeys(name for row in rows for name in row))
    return "".join(",".join(cells) + "\n" for cells in [columns, *([row.get(name, "") for name in columns] for row in rows)])


def write_feed(folder: Path, **changed: Any) -> Path:
    """Write a feed; `changed` replaces tables by rows or by the text or bytes of a file, None leaves the file out."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in (tables() | changed).items():
        if isinstance(rows, bytes):
            (folder / f"{name}.txt").write_bytes(rows)
        elif rows is not None:
            (folder / f"{name}.txt").write_text(rows if isinstance(rows, str) else text_of(rows), encoding="utf-8")
    return folder


def with_trip(name: str, *rows: str, **more: str) -> dict[str, list[dict[str, str]]]:
    """Return the tables that add a trip to the sound feed."""
    given = tables()
    return {"trips": [*given["trips"], trip(name, **more)], "stop_times": [*given["stop_times"], *calls(name, *rows)]}


def plain(found: Imported, name: str) -> Any:
    """Return a file of an import as plain data, read without the package."""
    assert not [problem for problem in found.notes.problems if problem.severity == "error"], found.notes.problems
    return YAML(typ="safe", pure=True).load(found.texts[name])


def trains(found: Imported) -> dict[str, Any]:
    return {train["id"]: train for train in plain(found, "timetable.yaml").get("trains", [])}


def read(folder: Path, options: dict[str, Any] | None = None, **changed: Any) -> Imported:
    """Write a feed and read it."""
    return read_gtfs(write_feed(folder / "feed", **changed), **(options or {}))


def codes(found: Imported) -> list[str]:
    return [problem.code for problem in found.notes.problems]

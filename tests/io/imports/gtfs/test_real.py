"""The real feed that ships with the line wkd: every rail trip of a day once, counted anew from its files."""

import csv
from pathlib import Path

import numpy as np
import pytest
from small_feeds import codes, plain, trains

from tractionpower.io.imports.gtfs.reading import read_gtfs

SOURCE = Path(__file__).parents[4] / "lines" / "wkd" / "source"


def rows(name):
    with (SOURCE / f"{name}.txt").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def expected(service):
    """Return the rail trips of a service with their stops and departures, without the importer."""
    rail = {row["route_id"] for row in rows("routes") if row["route_type"] == "2"}
    found = {row["trip_id"]: [] for row in rows("trips") if row["route_id"] in rail and row["service_id"] == service}
    for row in rows("stop_times"):
        if row["trip_id"] in found:
            found[row["trip_id"]].append((int(row["stop_sequence"]), row["stop_id"], row["arrival_time"], row["departure_time"]))
    return {name: [call[1:] for call in sorted(calls)] for name, calls in found.items()}


@pytest.mark.parametrize(
    ("options", "service", "count"),
    [({"date": "20230614"}, "D", 170), ({"day": "sat"}, "C", 114), ({"date": "20230815"}, "C", 114)],
)
def test_every_rail_trip_once(options, service, count):
    found = read_gtfs(SOURCE, **options)
    assert codes(found) == []
    wanted = expected(service)
    assert len(wanted) == count
    names = [train["id"] for train in plain(found, "timetable.yaml")["trains"]]
    assert sorted(names) == sorted(wanted)
    for name, train in trains(found).items():
        calls = [
            (call["station"], call.get("arrival", call.get("departure")), call.get("departure", call.get("arrival")))
            for call in train["calls"]
        ]
        assert calls == wanted[name]


def test_kilometres():
    stations = {row["id"]: row["km"] for row in plain(read_gtfs(SOURCE), "line.yaml")["stations"]}
    assert len(stations) == 26
    assert 32.0 < stations["gmrad"] < 33.0  # 32 to 33 km are told of the line
    assert 24.5 < stations["plglo"] < 25.5  # and some 25 km to where the second track ends
    # along the shape, on a sphere
    points = np.radians(
        [[float(row["shape_pt_lat"]), float(row["shape_pt_lon"])] for row in rows("shapes") if row["shape_id"] == "5"]
    )
    first, second = points[:-1], points[1:]
    half = np.sin((second - first) / 2.0) ** 2
    root = half[:, 0] + np.cos(first[:, 0]) * np.cos(second[:, 0]) * half[:, 1]
    length = np.sum(2.0 * 6371.0 * np.arcsin(np.sqrt(root)))
    assert stations["gmrad"] == pytest.approx(length, rel=0.004)


def test_the_buses_are_told():
    ignored = read_gtfs(SOURCE).notes.ignored
    assert "route ZA1 (ZA1), route_type 3, is no rail: 14 trips" in ignored
    assert "route ZA12 (ZA12), route_type 3, is no rail: 74 trips" in ignored


def test_a_branch_leaves_the_trunk_at_podkowa(tmp_path):
    # as if the buses to Milanowek were the trains that they replace
    for file in SOURCE.glob("*.txt"):
        text = file.read_text(encoding="utf-8")
        text = text.replace("Grudów (ZKA),3,", "Grudów (ZKA),2,") if file.stem == "routes" else text
        (tmp_path / file.name).write_text(text, encoding="utf-8")
    found = read_gtfs(tmp_path, date="20230614")
    assert codes(found) == []
    assert len(trains(found)) == 170 + 38
    line = plain(found, "line.yaml")
    tracks = {row["id"]: row["tracks"] for row in line["stations"]}
    assert {name for name, on in tracks.items() if on == ["3", "4"]} == {"poles", "milgr"}
    branch = [train["route"] for train in trains(found).values() if len(train["route"]) == 2]
    assert len(branch) == 38
    for route in branch:
        assert [leg["track"] for leg in route] in (["1", "3"], ["4", "2"])
        # some 3 km from Podkowa to Milanowek
        assert 2.5 < sum(abs(leg["to_km"] - leg["from_km"]) for leg in route) < 3.5

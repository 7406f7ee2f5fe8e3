"""The WKD that ships: its timetable is that of the feed in its folder, and it holds on the assumed supply with real sections."""

from pathlib import Path

import pytest
from ruamel.yaml import YAML
from small_studies import run_in_memory

import tractionpower
from tractionpower.io.imports.gtfs.reading import read_gtfs

FOLDER = Path(__file__).parents[2] / "lines" / "wkd"


@pytest.fixture(scope="module")
def wkd():
    return tractionpower.load(FOLDER)


@pytest.fixture(scope="module")
def run(wkd):
    results, outcome, _ = run_in_memory(wkd)
    return results, outcome


@pytest.fixture(scope="module")
def imported():
    return read_gtfs(FOLDER / "source", date="2023-06-14", double=("wsrod..plglo",), train="en97", min_dwell_s=15.0)


def plain(text):
    return YAML(typ="safe", pure=True).load(text)


def test_nothing_is_wrong_or_doubtful(wkd):
    assert tractionpower.check(wkd) == []


def test_the_timetable_is_that_of_the_feed(imported):
    shipped = plain((FOLDER / "timetable.yaml").read_text(encoding="utf-8"))["trains"]
    read = plain(imported.texts["timetable.yaml"])["trains"]
    assert len(shipped) == 170
    assert [train | {"train": "en97"} for train in shipped] == read
    assert {train["train"] for train in shipped} == {"en97", "en100"}


def test_stations_and_tracks_are_those_of_the_feed(wkd, imported):
    read = plain(imported.texts["line.yaml"])
    assert [(each.id, each.name, each.km, list(each.tracks)) for each in wkd.line.stations] == [
        (row["id"], row["name"], row["km"], row["tracks"]) for row in read["stations"]
    ]
    assert [(track.id, track.from_km, track.to_km) for track in wkd.line.tracks] == [
        (row["id"], row["from_km"], row["to_km"]) for row in read["tracks"]
    ]


def test_the_clock_holds_the_whole_day(wkd):
    first = min(run.calls[0].departure for run in wkd.timetable.trains)
    last = max(run.calls[-1].arrival for run in wkd.timetable.trains)
    assert wkd.clock.start < first
    assert last > 25 * 3600.0
    assert wkd.clock.end > last + 1800.0


def test_the_licence_of_the_feed_is_told():
    told = (FOLDER / "source" / "README_upstream.md").read_text(encoding="utf-8")
    assert "every file in the `gtfs` subdirectory" in told
    assert "CC0 1.0" in (FOLDER / "README.md").read_text(encoding="utf-8")


def test_nobody_is_late(run):
    results, outcome = run
    assert outcome.run["status"] == "complete"
    assert len(outcome.run["trains"]) == 170
    assert {note["status"] for note in outcome.run["trains"]} == {"left"}
    assert results.table("calls")["late_s"].max() < 1.0


def test_each_stop_lasts_fifteen_seconds(run):
    calls = run[0].table("calls")
    on_the_way = calls[(calls["kind"] == "departure") & (calls["dwell_s"] > 0.0)]
    assert len(on_the_way) > 3000
    assert on_the_way["dwell_s"].min() >= 15.0 - 1e-6


def test_the_supply_holds(run):
    results, outcome = run
    assert all(ledger["closes"] for ledger in outcome.run["ledgers"].values())
    assert results.table("trains")["voltage_v"].min() > 2900.0
    assert set(results.table("events")["kind"]).isdisjoint(
        {"line_dead", "voltage_lost", "tripped", "limit_violated", "not_servable"}
    )
    assert outcome.run["overlaps"]["count"] == 0


def test_trains_towards_warszawa_change_to_the_second_track(run):
    trains = run[0].table("trains")
    rows = trains[trains["train"] == "D-100"]
    assert list(dict.fromkeys(rows["track"])) == ["1", "2"]
    assert rows["distance_m"].max() == pytest.approx(32531.0, abs=15.0)

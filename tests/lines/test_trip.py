"""The shipped study of a breaker that trips and recloses: what its README tells happens, and the section behind it is dead."""

from pathlib import Path

import pytest
from small_studies import run_in_memory

import tractionpower

STUDY = Path(__file__).parents[2] / "lines" / "two-substations" / "trip.yaml"
FEEDER = "A 1 high_km"
LIMIT_A, DEAD_TIME_S = 1800.0, 15.0
OPENS_S, CLOSES_S = 120.0, 600.0  # the section cabin


@pytest.fixture(scope="module")
def study():
    return tractionpower.load(STUDY)


@pytest.fixture(scope="module")
def run(study):
    results, outcome, _ = run_in_memory(study)
    return results, outcome


@pytest.fixture(scope="module")
def dead(run):
    """Return the times from each trip to the reclosure [s]."""
    events = run[0].table("events")
    own = events[events["subject"] == FEEDER]
    trips, closings = (own.loc[own["kind"] == kind, "time_s"].tolist() for kind in ("tripped", "switched"))
    return [*zip(trips, closings, strict=True)]


def during(table, spells):
    return table[[any(start <= time < end for start, end in spells) for time in table["time_s"]]]


def feeder_current(results, station, track, side):
    table = results.table("feeders")
    own = table[(table["substation"] == station) & (table["track"] == track) & (table["side"] == side)]
    return own.set_index("time_s")["current_a"]


def test_nothing_is_wrong_or_doubtful(study):
    assert tractionpower.check(study) == []


def test_it_trips_twice_and_then_holds(run, dead):
    assert len(dead) == 2
    assert all(end - start == DEAD_TIME_S for start, end in dead)
    assert run[1].run["status"] == "complete"
    current = feeder_current(run[0], "A", "1", "high_km")
    for start, end in dead:
        assert current[start - 1.0] > LIMIT_A  # the step before, whose mean it saw
        assert current[start : end - 1.0].eq(0.0).all()
        assert current[end] > 0.0
    assert current[dead[-1][1] :].max() < LIMIT_A


def test_no_other_breaker_trips(run):
    events = run[0].table("events")
    assert set(events.loc[events["kind"] == "tripped", "subject"]) == {FEEDER}
    for station, track, side in (("A", "2", "high_km"), ("B", "1", "low_km"), ("B", "2", "low_km")):
        assert feeder_current(run[0], station, track, side).abs().max() < LIMIT_A


def test_trains_on_the_dead_section_coast_without_voltage(run, dead):
    trains = run[0].table("trains")
    there = during(trains[trains["track"] == "1"], dead)
    without, beyond = there[there["position_km"] < 10.0], there[there["position_km"] >= 10.0]
    assert without["train"].value_counts()["2"] == 2 * DEAD_TIME_S
    assert set(beyond["train"]) == {"1"}  # it rolls past the cabin into the half that is fed from B
    assert beyond["voltage_v"].min() > 2500.0
    assert without[["voltage_v", "current_a", "power_kw", "auxiliary_power_kw", "tractive_force_kn"]].eq(0.0).all(axis=None)
    first = without[without["train"] == "1"].groupby(without["time_s"] > dead[0][1])["speed_kmh"]
    assert (first.last() < first.first()).all()  # resistance alone slows it down
    assert (first.first() - first.last() < 10.0).all()
    events = run[0].table("events")
    for kind in ("voltage_lost", "voltage_back"):
        assert events.loc[events["kind"] == kind, "subject"].tolist() == ["1", "2", "1", "2"]


def test_the_other_track_stays_alive(run, dead):
    trains = run[0].table("trains")
    third = during(trains[trains["train"] == "3"], dead)
    assert len(third) == 2 * DEAD_TIME_S
    assert third["voltage_v"].min() > 2500.0
    assert third["current_a"].min() > 500.0


def test_the_open_cabin_feeds_from_one_end(run):
    results, _ = run
    trains = results.table("trains")
    alone = trains[(trains["time_s"] >= OPENS_S) & (trains["time_s"] < 285.0) & (trains["train"] == "1")].set_index("time_s")
    current = feeder_current(results, "A", "1", "high_km")
    assert current[alone.index].to_numpy() == pytest.approx(alone["current_a"].to_numpy(), abs=1e-3)  # all of it
    before = trains[(trains["time_s"] >= 60.0) & (trains["time_s"] < OPENS_S) & (trains["train"] == "1")].set_index("time_s")
    assert (current[before.index] < 0.95 * before["current_a"]).all()
    after = current[CLOSES_S:]
    cabins = results.table("cabins")
    assert cabins[(cabins["time_s"] >= OPENS_S) & (cabins["time_s"] < CLOSES_S)]["current_a"].eq(0.0).all()
    assert cabins[cabins["time_s"] >= CLOSES_S]["current_a"].abs().max() > 100.0
    assert after.min() > 0.0


def test_ledgers_close(run):
    assert all(ledger["closes"] for ledger in run[1].run["ledgers"].values())

"""Figures of feeders and switches, against the rows of their tables and the events."""

import numpy as np
import pytest
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.model.base import parse_time

TRIPS, TIES, OPEN = "A 1 high_km", "tie", "B 2 low_km"
WARM_UP_S = 5.0


@pytest.fixture(scope="module")
def scenario():
    """A load that trips a breaker in the warm-up and again later, a switch that closes, a feeder that is normally open."""
    tie = {"id": TIES, "from": {"track": "1", "km": 15.0}, "to": {"track": "2", "km": 15.0}, "state": "open"}
    return make_scenario(
        load("heavy", 3.0, power_kw=6000.0),
        load("late", 15.0, power_kw=2000.0),
        clock={"end": 60.0, "warm_up": WARM_UP_S},
        section_cabins=[{"id": "C", "km": 10.0, "state": "open"}],
        feeders=[
            {"at": "A", "track": "1", "side": "high_km", "trip_current_a": 1000.0, "reclose_after_s": 20.0, "reclosures": 2},
            {"at": "B", "track": "2", "side": "low_km", "state": "open"},
        ],
        switches=[tie],
        switch_events=[{"time": "00:00:35", "device": TIES, "state": "closed"}],
    )


@pytest.fixture(scope="module")
def results(scenario):
    return run_in_memory(scenario)[0]


def counted(table):
    return table[table["time_s"] >= WARM_UP_S]


def current(results, name):
    station, track, side = name.split()
    rows = counted(results.table("feeders"))
    own = rows[(rows["substation"] == station) & (rows["track"] == track) & (rows["side"] == side)]
    return own.set_index("time_s")["current_a"].astype(float)


def figures(results, place):
    return {each["name"]: each for each in results.key_figures if each["place"] == place}


@pytest.mark.parametrize("name", [TRIPS, "B 1 low_km", OPEN])
def test_currents_are_those_of_the_rows(results, name):
    amps, found = current(results, name), figures(results, f"feeder {name}")
    assert found["highest_current_a"]["value"] == pytest.approx(amps.abs().max(), rel=1e-6)
    when = parse_time(found["highest_current_a"]["time"])
    assert abs(amps[when]) == pytest.approx(amps.abs().max(), rel=1e-6)  # the rows have 32 bits, so several may be the highest
    assert found["rms_current_a"]["value"] == pytest.approx(np.sqrt((amps**2).mean()), rel=1e-6)


def test_a_current_counts_in_either_direction(results):
    switches = counted(results.table("switches"))
    found = figures(results, f"switch {TIES}")
    assert found["highest_current_a"]["value"] == pytest.approx(switches["current_a"].abs().max(), rel=1e-6)
    reversed_tie = {"id": TIES, "from": {"track": "2", "km": 15.0}, "to": {"track": "1", "km": 15.0}}
    turned = run_in_memory(make_scenario(load("x", 15.0), switches=[reversed_tie]))[0]
    straight = run_in_memory(
        make_scenario(load("x", 15.0), switches=[reversed_tie | {"from": reversed_tie["to"], "to": reversed_tie["from"]}])
    )[0]
    signed = [run.table("switches")["current_a"].iloc[0] for run in (turned, straight)]
    assert signed[0] == pytest.approx(-signed[1])
    assert abs(signed[0]) > 100.0
    told = [figures(run, f"switch {TIES}")["highest_current_a"]["value"] for run in (turned, straight)]
    assert told[0] == pytest.approx(told[1])
    assert told[0] == pytest.approx(abs(signed[0]))


def test_trips_are_those_after_the_warm_up(results):
    tripped = results.table("events").query("kind == 'tripped'")
    assert tripped["time_s"].min() < WARM_UP_S
    assert len(tripped) == 3
    assert figures(results, f"feeder {TRIPS}")["trips"]["value"] == 2.0
    assert figures(results, "feeder B 1 low_km")["trips"]["value"] == 0.0
    assert "trips" not in figures(results, f"switch {TIES}")


def test_the_share_of_the_time_closed(results):
    steps = 60.0 - WARM_UP_S
    places = {TRIPS: f"feeder {TRIPS}", OPEN: f"feeder {OPEN}", TIES: f"switch {TIES}", "B": "feeder B 1 low_km"}
    closed = {name: figures(results, place)["time_closed_percent"]["value"] for name, place in places.items()}
    assert closed[TRIPS] == pytest.approx(100.0 * (current(results, TRIPS) > 1.0).sum() / steps)
    assert 0.0 < closed[TRIPS] < 10.0
    assert (closed[OPEN], closed["B"]) == (0.0, 100.0)
    assert closed[TIES] == pytest.approx(100.0 * 25.0 / steps)


def test_a_run_tells_settings_and_normal_states(results):
    told = {each["place"]: each for each in results.run["links"]}
    assert told[f"feeder {TRIPS}"] | {"km": 0.0} == {
        "place": f"feeder {TRIPS}", "kind": "feeder", "track": "1", "km": 0.0, "normal_state": "closed", "resistance_ohm": 0.0,
        "trip_current_a": 1000.0,
    }  # fmt: skip
    assert (told[f"feeder {OPEN}"]["normal_state"], told[f"feeder {OPEN}"]["trip_current_a"]) == ("open", None)
    assert told[f"switch {TIES}"]["normal_state"] == "open"
    assert told["feeder C 1 low_km"]["kind"] == "cabin"


def test_the_heat_of_a_feeder_is_its_resistance_times_the_squares():
    depot = load("depot", 3.0)
    stations = [station("A", 0.0, feeder_resistance_ohm=0.02), station("B", 20.0)]
    found, *_ = run_in_memory(make_scenario(depot, substations=stations, clock={"end": 10.0, "step_s": 0.5}))
    rows = found.table("feeders").query("substation == 'A' and track == '1' and side == 'high_km'")
    heat = figures(found, "feeder A 1 high_km")["feeder_heat_kwh"]["value"]
    assert heat == pytest.approx(0.02 * (rows["current_a"].astype(float) ** 2).sum() * 0.5 / 3.6e6, rel=1e-6)
    assert "feeder_heat_kwh" not in figures(found, "feeder B 1 low_km")


def test_an_open_feeder_has_no_negative_zero(results):
    amps = results.table("feeders")["current_a"].to_numpy()
    assert (amps == 0.0).any()
    assert not np.signbit(amps[amps == 0.0]).any()

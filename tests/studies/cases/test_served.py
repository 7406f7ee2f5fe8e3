"""What a run does not serve, counted by hand: loads without a voltage, trains on a dead line, times in which nothing is fed."""

import pytest
from coupled import couple, run
from small_studies import load, make_scenario, station

from tractionpower.studies.cases.measure import measure

ONE_PLANT = {"substations": [station("A", 0.0)], "tracks": ("1",), "section_cabins": []}


def served(*loads, **more):
    figures = measure(make_scenario(*loads, **ONE_PLANT | more)).figures
    told = {name: figures[name] for name in ("unserved_loads", "unserved_load_s", "blackout_s", "dark_trains")}
    return tuple(told.values()), figures["fails"].split(", ")


@pytest.mark.parametrize("state", ["open", "rectifiers_out"])
def test_a_load_without_a_substation(state):
    counted, fails = served(load("x"), load("y", 7.0), substations=[station("A", 0.0, state=state)])
    assert counted == (2, 20.0, 10.0, 0)
    assert fails == ["loads without voltage", "nothing fed"]


def test_a_supply_that_feeds_misses_nothing():
    assert served(load("x")) == ((0, 0.0, 0.0, 0), [""])


def test_loads_count_while_they_should_take_something():
    """Dead from 6 s on: x is off from 8 s on, y comes at 7 s, z feeds back, n takes nothing, w is off and on again."""
    rows = [(0.0, 100.0), (3.0, 0.0), (9.0, 50.0)]
    profile = [{"time": time_s, "power_kw": power} for time_s, power in rows]
    loads = [
        load("x", 3.0, to=8.0), load("y", 4.0, **{"from": 7.0}), {**load("z", 5.0), "power_kw": -10.0},
        {**load("n", 6.0), "power_kw": 0.0}, {"id": "w", "track": "1", "km": 8.0, "profile": profile},
    ]  # fmt: skip
    events = [{"time": 6.0, "device": "A", "state": "open"}]
    counted, fails = served(*loads, switch_events=events)
    assert counted == (3, 2.0 + 3.0 + 1.0, 4.0, 0)
    assert fails == ["loads without voltage", "nothing fed"]


def test_what_the_warm_up_does_not_serve_does_not_count():
    events = [{"time": 4.0, "device": "A", "state": "in_service"}]
    dead = [station("A", 0.0, state="open")]
    counted, _ = served(load("x"), substations=dead, switch_events=events, clock={"end": 10.0, "warm_up": 3.0})
    assert counted == (1, 1.0, 1.0, 0)


def test_one_of_two_tracks_is_dead():
    rows = [{"at": at, "track": "2", "side": side, "state": "open"} for at, side in (("A", "high_km"), ("B", "low_km"))]
    figures = measure(make_scenario(load("x"), load("y", 6.0, "2"), feeders=rows, section_cabins=[])).figures
    assert (figures["unserved_loads"], figures["unserved_load_s"], figures["blackout_s"]) == (1, 10.0, 0.0)
    assert figures["lowest_voltage_v"] > 3000.0
    assert figures["fails"] == "loads without voltage"


@pytest.mark.parametrize(("end_s", "dark"), [(180.0, 0), (181.0, 1)])
def test_a_train_is_dark_when_it_has_no_voltage_for_longer_than_it_coasts(end_s, dark):
    """Dead from 60 s on; it coasts for 120 s."""
    events = [{"device": name, "time": 60.0, "state": "open"} for name in "AB"]
    figures = measure(couple(run("x"), end_s=end_s, step_s=1.0, switch_events=events)).figures
    assert figures["dark_trains"] == dark
    assert figures["blackout_s"] == end_s - 60.0
    assert ("trains without voltage" in figures["fails"]) == bool(dark)


def test_without_loads_and_trains_nothing_is_missing():
    figures = measure(make_scenario(substations=[station("A", 0.0, state="open")])).figures
    assert (figures["blackout_s"], figures["fails"]) == (0.0, "")


def test_a_train_tells_when_it_ended():
    rows = measure(couple(run("x"), end_s=900.0)).tables["case_trains"].to_pylist()
    assert 400.0 < rows[0]["finished_s"] < 900.0
    (row,) = measure(couple(run("x"), end_s=100.0)).tables["case_trains"].to_pylist()
    assert row["finished_s"] is None

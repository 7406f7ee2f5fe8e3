"""Where trains are: legs of a route, kilometres that jump, zones and bins, against reckoning by hand."""

import numpy as np
import pytest
from coupled import advanced, couple, run
from small_studies import run_in_memory

from tractionpower.cosimulation.places import BIN_KM, Places
from tractionpower.cosimulation.tables import compile_scenario

SWITCH = {"connections": [{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 8.0}}]}
TWO_LEGS = {"route": [{"track": "1", "from_km": 3.0, "to_km": 8.0}, {"track": "2", "from_km": 8.0, "to_km": 14.0}]}
BACK = {"route": [{"track": "2", "from_km": 14.0, "to_km": 8.0}, {"track": "1", "from_km": 8.0, "to_km": 3.0}]}
JUMP = {"chainage_breaks": [{"at_km": 8.0, "continues_as_km": 9.5}]}


def places_of(scenario):
    return Places(scenario, compile_scenario(scenario).movement)


def place(places, train, *distances):
    found = places.place(np.full(len(distances), train, np.int64), np.array(distances, float))
    tracks = [places.tracks[number] for number in found.track]
    return list(zip(tracks, np.round(found.km, 9).tolist(), found.sign.tolist(), strict=True))


def test_a_route_with_rising_and_with_falling_kilometres():
    places = places_of(couple(run("E", low=3.0, high=14.0), run("F", track="2", low=14.0, high=3.0)))
    assert place(places, 0, 0.0, 4500.0, 11000.0) == [("1", 3.0, 1), ("1", 7.5, 1), ("1", 14.0, 1)]
    assert place(places, 1, 0.0, 4500.0, 11000.0) == [("2", 14.0, -1), ("2", 9.5, -1), ("2", 3.0, -1)]


def test_a_route_of_two_legs_changes_the_track():
    places = places_of(couple(run("E", **TWO_LEGS), run("F", **BACK), **SWITCH))
    assert place(places, 0, 0.0, 4999.0, 5001.0, 11000.0) == [("1", 3.0, 1), ("1", 7.999, 1), ("2", 8.001, 1), ("2", 14.0, 1)]
    assert place(places, 1, 0.0, 5999.0, 6001.0, 11000.0) == [("2", 14.0, -1), ("2", 8.001, -1), ("1", 7.999, -1), ("1", 3.0, -1)]


def test_kilometres_jump_and_distances_do_not():
    places = places_of(couple(run("E", low=3.0, high=14.0), run("F", track="2", low=14.0, high=3.0), **JUMP))
    assert place(places, 0, 4999.0, 5001.0, 9500.0) == [("1", 7.999, 1), ("1", 9.501, 1), ("1", 14.0, 1)]
    assert place(places, 1, 4499.0, 4501.0, 9500.0) == [("2", 9.501, -1), ("2", 7.999, -1), ("2", 3.0, -1)]


@pytest.mark.parametrize("more", [{}, JUMP])
def test_rows_and_single_places_agree(more):
    places = places_of(couple(run("E", **TWO_LEGS), run("F", track="2", low=14.0, high=3.0), **SWITCH, **more))
    for train in (0, 1):
        for s in np.linspace(0.0, 9400.0, 95).tolist():
            (found,) = place(places, train, s)
            track, km = places.name(train, s)
            assert found[:2] == (track, round(km, 9))


def test_zones_lie_between_neighbouring_substations():
    plants = [
        {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1} | more
        for name, km, more in (("X", 2.0, {}), ("Y", 9.0, {"tracks": ["1"]}), ("Z", 17.0, {}))
    ]
    places = places_of(couple(run("E"), run("F", track="2"), substations=plants))
    assert sorted(places.zones) == ["X–Y", "X–Z", "Y–Z"]

    def zones(train, *km):
        rows = places.place(np.full(len(km), train, np.int64), 1000.0 * np.array(km))
        return [places.zones[number] if number >= 0 else None for number in places.zone(rows)]

    assert zones(0, 1.9, 2.0, 8.9, 9.0, 17.0, 17.1) == [None, "X–Y", "X–Y", "Y–Z", "Y–Z", None]
    assert zones(1, 1.9, 2.0, 8.9, 9.0, 17.0, 17.1) == [None, "X–Z", "X–Z", "X–Z", "X–Z", None]


def test_every_place_has_its_bin():
    scenario = couple(run("E"), run("F", track="2", low=20.0, high=0.0))
    places = places_of(scenario)
    for train in (0, 1):
        rows = places.place(np.full(401, train, np.int64), np.linspace(0.0, 20000.0, 401))
        bins = places.bin(rows)
        np.testing.assert_array_equal(places.bin_track[bins], rows.track)
        away = rows.km - places.bin_km[bins]
        assert (away >= -0.5 * BIN_KM - 1e-9).all()
        assert (away < 0.5 * BIN_KM + 1e-9).all()
    assert places.bin_km.min() == 0.25
    assert places.bin_km.max() == 20.0, "no place lies beyond the end of its track"


@pytest.mark.parametrize("name", ["E", "F"])
@pytest.mark.parametrize("more", [{}, JUMP])
def test_table_and_network_know_the_same_place(name, more):
    """The voltage of a train that stands for a load is that of a fixed load at the place that the table names."""
    end_s = 260.0
    runs = (run("E", **TWO_LEGS), run("F", **BACK))
    done = advanced(couple(*runs, **SWITCH, **more, end_s=end_s))
    results, _, _ = run_in_memory(couple(*runs, **SWITCH, **more, end_s=end_s))
    table = results.table("trains").astype({"train": str, "track": str})
    rows = table[(table["train"] == name)].reset_index(drop=True)
    assert rows["track"].nunique() == 2
    for n in (60, len(rows) - 1):
        row, exact = rows.iloc[n], done.rows(name)[n]
        others = table[(table["time_s"] == row["time_s"])]
        taps = [
            {"id": each.train, "track": each.track, "km": each.position_km, "limits": "none", "current_a": float(current)}
            for each, current in zip(others.itertuples(), exact_currents(done, row["time_s"]), strict=True)
        ]
        fixed, _, _ = run_in_memory(couple(**SWITCH, **more, end_s=1.0, loads=taps))
        volts = fixed.table("loads").set_index("load")["voltage_v"]
        assert volts[name] == pytest.approx(exact["voltage_v"], abs=2e-3)


def exact_currents(done, time_s):
    rows = done.trains
    return rows["current_a"][rows["time_s"] == time_s].tolist()

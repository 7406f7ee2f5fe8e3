"""Trains on a line with stations: who may be where, when, and what the run tells of it."""

import builtins
from itertools import pairwise

import pandas as pd
import pytest
from small_stations import CASE, TRAIN, compute, make_case

from tractionpower.dynamics.traindyn.layout import SHORT_M, lay_out
from tractionpower.dynamics.traindyn.stations_run import StationsRun
from tractionpower.dynamics.traindyn.traffic import traffic
from tractionpower.errors import InputError, UsageError
from tractionpower.io.dynamics_files import load_case
from tractionpower.results.store import MemoryWriter

SHIPPED = "traindyn-three-stations"


@pytest.fixture(scope="module")
def shipped():
    case = load_case(SHIPPED).scenario
    return case, *compute(case)


def one(**more):
    return make_case(traffic={"trains": 1}, **more)


def test_a_train_alone_runs_as_by_hand():
    """It comes at 60 km/h, runs up to 90, brakes to 40 at the points or to a stand at its place, waits, leaves."""
    rows, events, outcome = compute(one())
    track = events.loc[events["kind"] == "track_given", "station_track"].iloc[0]
    at = events.set_index("kind")["time_s"]
    assert list(events["kind"]) == ["entered", "track_given", "arrival", "departure", "track_given", "passing", "left"]
    assert at["departure"] - at["arrival"] == pytest.approx(60.0, abs=1e-9)
    stands = rows[rows["state"] == "standing"]
    assert stands["position_m"].to_numpy() == pytest.approx(2600.0 - SHORT_M, abs=1e-6)
    inside = rows[rows["station_track"] == track]
    assert inside["speed_kmh"].max() <= (90.0 if track == "A 1" else 40.0) + 1e-4
    assert rows["speed_kmh"].max() == pytest.approx(90.0)
    assert outcome.run["status"] == "complete"
    assert outcome.run["end_s"] == at["left"]
    assert rows["position_m"].iloc[-1] <= 8000.0 + 90.0 / 3.6


def test_arrival_is_told_inside_the_period():
    fine = compute(one(run={"period_s": 0.1}))[1]
    coarse = compute(one(run={"period_s": 2.0, "record_every_s": 2.0}))[1]
    exact, sampled = (events.loc[events["kind"] == "arrival", "time_s"].iloc[0] for events in (fine, coarse))
    assert sampled % 2.0 != pytest.approx(0.0, abs=1e-6)
    assert sampled == pytest.approx(exact, abs=3.0)


def test_no_track_and_no_piece_of_line_has_two_trains(shipped):
    case, rows, events, _ = shipped
    lengths = {kind.id: kind.length_m for kind in case.trains}
    given = events[events["kind"] == "track_given"].set_index(["train", "station"])["station_track"]
    overlaps = 0
    for _, now in rows.groupby("time_s"):
        assert not now["station_track"].duplicated().any(), now
        for (_, behind), (_, ahead) in pairwise(now.sort_values("position_m").iterrows()):
            if behind["position_m"] >= (tail := ahead["position_m"] - lengths[ahead["kind"]]):
                # Side by side, on two tracks of one station.
                (station,) = (each for each in case.stations if each.from_m <= behind["position_m"] <= each.to_m)
                assert station.from_m <= max(tail, station.from_m) <= station.to_m
                assert given[behind["train"], station.id] != given[ahead["train"], station.id]
                overlaps += 1
    assert overlaps > 100


def test_all_stop_in_the_first_station_only_on_tracks_chosen_at_random(shipped):
    case, rows, events, outcome = shipped
    count = case.traffic.trains
    arrivals = events[events["kind"] == "arrival"]
    assert sorted(arrivals["train"]) == sorted(arrival.name for arrival in traffic(case))
    assert set(arrivals["station"]) == {"A"}
    assert set(arrivals["station_track"]) == {"A 1", "A 2", "A 3"}
    assert len(events[events["kind"] == "left"]) == count == outcome.key_figures[0]["value"]
    dwell = events[events["kind"] == "departure"].groupby("train")["time_s"].first() - arrivals.set_index("train")["time_s"]
    assert (dwell >= 90.0 - 1e-6).all()
    braking = rows[rows["state"] == "braking_to_stop"]
    assert (braking["acceleration_mps2"] < 0.0).all()
    assert (braking["braking_force_kn"] > 0.0).any()


def test_gradient_arc_and_tunnel_act_where_they_lie(shipped):
    case, rows, _, _ = shipped
    freight = case.trains[1].characteristics
    cruising = rows[(rows["kind"] == "freight") & rows["position_m"].between(6320.0, 6980.0) & (rows["speed_kmh"] > 1.0)]
    v = cruising["speed_kmh"].to_numpy(float)
    own, hauled = freight.resistance, freight.hauled_resistance
    weight = 9.80665
    vehicles = weight * (
        84.0 * (own.a_n_per_kn + own.c_n_per_kn_per_kmh2 * v**2)
        + 1200.0 * (hauled.a_n_per_kn + hauled.c_n_per_kn_per_kmh2 * v**2)
    )
    expected = (vehicles + weight * 1284.0 * (8.0 + 2.0)) / 1e3
    assert len(v) > 20
    assert cruising["resistance_kn"].to_numpy(float) == pytest.approx(expected, rel=1e-5)


def test_the_same_seed_gives_the_same_and_another_one_another_day():
    first, again, other = (
        compute(make_case(seed=seed, traffic={"distribution": "exponential", "trains": 4}))[1] for seed in (5, 5, 6)
    )
    pd.testing.assert_frame_equal(first, again)
    assert not first.equals(other)


def test_what_is_recorded_does_not_change_what_happens():
    every, seldom = (compute(make_case(run={"record_every_s": each})) for each in (1.0, 7.0))
    pd.testing.assert_frame_equal(every[1], seldom[1])
    assert len(seldom[0]) == pytest.approx(len(every[0]) / 7.0, abs=4)


def test_random_times_have_their_mean_and_their_least():
    case = make_case(traffic={"trains": 4000, "headway_s": 300.0, "least_headway_s": 120.0, "distribution": "exponential"})
    times = [arrival.time_s for arrival in traffic(case)]
    gaps = [after - before for before, after in pairwise(times)]
    assert times[0] == 0.0
    assert min(gaps) >= 120.0
    assert sum(gaps) / len(gaps) == pytest.approx(300.0, rel=0.03)


def test_a_train_without_a_track_waits_before_the_station():
    stations = [CASE["stations"][0] | {"tracks": ["1"], "dwell_s": 400.0}, CASE["stations"][1]]
    rows, events, outcome = compute(make_case(stations=stations))
    second = rows[rows["train"] == "t 2"]
    held = second[(second["state"] == "standing") & (second["position_m"] < 2000.0)]
    assert held["position_m"].to_numpy() == pytest.approx(1950.0, abs=1e-6)
    given = events[(events["train"] == "t 2") & (events["station"] == "A") & (events["kind"] == "track_given")]
    assert given["waited_s"].iloc[0] > 100.0
    assert outcome.run["notes"] == []


def test_a_train_that_cannot_climb_is_told():
    hill = [{"from_m": 3000.0, "to_m": 4000.0, "permille": 100.0}]
    rows, events, outcome = compute(make_case(gradients=hill, run={"duration_s": 1200.0}))
    assert rows["position_m"].max() < 4000.0
    assert list(events["kind"].tail(2)) == ["still_there"] * 2
    assert outcome.run["notes"] == ["trains still on the line at the end: 2 (t 1 cannot start)"]
    assert outcome.run["end_s"] == 1200.0


def test_progress_is_told_up_to_the_end_and_rows_come_in_parts():
    sizes, told = [], []

    class Parts(MemoryWriter):
        def append(self, table, rows):
            sizes.append((table, rows.num_rows))
            super().append(table, rows)

    writer = Parts()
    StationsRun(make_case(traffic={"trains": 6}), writer).execute(lambda done, total: told.append((done, total)))
    assert told[-1] == (3600, 3600)
    assert told == sorted(told)
    assert len([table for table, _ in sizes if table == "point_masses"]) > 1
    assert writer.tables()["point_masses"].num_rows == sum(rows for table, rows in sizes if table == "point_masses")


def test_without_simpy_it_says_what_to_install(monkeypatch):
    real = builtins.__import__

    def missing(name, *more):
        if name == "simpy":
            raise ImportError(name)
        return real(name, *more)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(UsageError, match=r"pip install tractionpower\[simpy\]"):
        StationsRun(make_case(), MemoryWriter())


def test_a_case_with_errors_does_not_run():
    with pytest.raises(InputError, match="length_m"):
        StationsRun(make_case(length_m=3000.0), MemoryWriter())


def test_tracks_are_laid_out_by_turns_on_both_sides():
    layout = lay_out(make_case())
    assert [piece.name for piece in layout.pieces] == ["line 1", "line 2", "line 3", "A 1", "A 2", "A 3", "B 1", "B 2"]
    sides = [max(piece.points, key=lambda point: abs(point[1]))[1] for piece in layout.tracks[0].values()]
    assert sides == [0.0, 60.0, -60.0]
    assert {piece.length_m for piece in layout.tracks[0].values()} == {600.0}
    assert layout.starts_m["line 2"] == 2600.0


def test_held_speeds_bring_trains_later_to_places():
    """What AnyLogic's motion loses on the way up, V h / 2 from 60 to 90 km/h, it gains on the way down."""
    places = {}
    for method in ("euler", "held_speed"):
        rows = compute(one(stations=[CASE["stations"][0] | {"tracks": ["1"]}], run={"method": method}))[0]
        places[method] = rows.loc[(rows["time_s"] == 60.0), "position_m"].iloc[0]
    assert places["euler"] - places["held_speed"] == pytest.approx(0.5 * (90.0 - 60.0) / 3.6, abs=0.5)


def test_a_weaker_train_is_slower():
    quick, slow = (
        compute(one(trains=[CASE["trains"][0] | {"characteristics": TRAIN | {"power_kw": power}}]))[2]
        for power in (2220.0, 900.0)
    )
    times = [next(each["value"] for each in out.key_figures if each["name"] == "mean_running_time_s") for out in (quick, slow)]
    assert times[0] + 20.0 < times[1]

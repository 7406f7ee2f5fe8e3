"""Checks of cases of stations: everything at once, with place and remedy."""

import pytest
from small_stations import CASE, TRAIN, make_case

from tractionpower.dynamics.traindyn.station_checks import check_stations
from tractionpower.io.dynamics_files import load_case

A, B = CASE["stations"]


def found(**more):
    return {(problem.code, problem.path) for problem in check_stations(make_case(**more))}


def test_sound_cases_have_no_problem():
    assert check_stations(make_case()) == []
    assert check_stations(load_case("traindyn-three-stations").scenario) == []


@pytest.mark.parametrize(
    ("more", "problem"),
    [
        ({"stations": [B, A]}, ("unsorted", "case.stations[A].from_m")),
        ({"stations": [A, B | {"to_m": 4000.0}]}, ("bad_range", "case.stations[B].to_m")),
        ({"stations": [A, B | {"id": "A"}]}, ("duplicate", "case.stations")),
        ({"stations": [A, B | {"tracks": ["1", "1"]}]}, ("duplicate", "case.stations[B].tracks")),
        ({"stations": [A, B | {"from_m": 3000.0}]}, ("no_room_to_brake", "case.stations[B].from_m")),
        ({"stations": [A | {"from_m": 200.0}, B]}, ("no_room_to_brake", "case.stations[A].from_m")),
        ({"stations": [A | {"speed_kmh": 85.0}, B]}, ("no_room_to_brake", "case.stations[A].speed_kmh")),
        ({"stations": [A, B | {"to_m": 5200.0}]}, ("train_too_long", "case.stations[B].to_m")),
        ({"length_m": 5600.0}, ("bad_range", "case.length_m")),
        ({"trains": CASE["trains"] * 2}, ("duplicate", "case.trains")),
        ({"gradients": [{"from_m": 10.0, "to_m": 9000.0, "permille": 1.0}]}, ("bad_range", "case.gradients[0].to_m")),
        ({"gradients": [{"from_m": 500.0, "to_m": 900.0, "permille": 1.0}, {"from_m": 0.0, "to_m": 600.0, "permille": 2.0}]},
         ("overlap", "case.gradients[0].from_m")),
        ({"curves": [{"from_m": 10.0, "to_m": 90.0, "radius_m": 25.0}]}, ("radius_too_small", "case.curves[0].radius_m")),
        ({"run": {"period_s": 2.0}}, ("too_fine", "case.run.record_every_s")),
        ({"traffic": {"least_headway_s": 300.0}}, ("contradiction", "case.traffic.least_headway_s")),
        ({"traffic": {"speed_kmh": 100.0}}, ("too_fast", "case.traffic.speed_kmh")),
        ({"shown_at_s": [4000.0]}, ("bad_range", "case.shown_at_s[0]")),
    ],
)  # fmt: skip
def test_each_problem_is_told_at_its_place(more, problem):
    assert found(**more) == {problem}


def test_all_are_told_at_once():
    weak = CASE["trains"][0] | {"characteristics": TRAIN | {"braking_mps2": 0.1}}
    codes = {code for code, _ in found(trains=[weak], run={"period_s": 2.0}, shown_at_s=[-5.0])}
    assert codes == {"no_room_to_brake", "too_fine", "bad_range"}

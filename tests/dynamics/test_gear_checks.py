"""What is wrong with traction and brake gear is told."""

import pytest
from small_controls import GEAR, locomotive, scenario, vehicle

from tractionpower.dynamics.gear_checks import check_gear

LOCO = "case.vehicles[0].traction"
RIGGING = {"cylinder_area_cm2": 900.0, "rigging_ratio": 5.0}


def points(*rows):
    return [dict(zip(("level", "speed_kmh", "effort_kn"), row, strict=True)) for row in rows]


FULL = [(level, v, 100 * level - v) for level in (1, 2) for v in (0, 50)]


def test_points_of_all_levels_are_sound():
    assert check_gear(scenario(traction={"levels": 2, "effort": points(*FULL)})) == []


@pytest.mark.parametrize(
    ("traction", "path", "code", "words"),
    [
        ({"levels": 2, "effort": points(*FULL), "power_kw": 5.0}, "case.traction.power_kw", "contradiction", ["5 beside"]),
        ({"levels": 3, "effort": points(*FULL)}, "case.traction.effort", "missing_level", ["level 3"]),
        ({"levels": 20, "effort": points(*FULL)}, "case.traction.effort", "missing_level", ["level 3, 4", "(18 in all)"]),
        ({"levels": 2, "effort": points(*FULL, (3, 0, 1))}, "case.traction.effort[4].level", "level", ["level 3"]),
        ({"levels": 2, "effort": points(*FULL, (2, 50, 1))}, "case.traction.effort[4].speed_kmh", "unsorted", ["50 km/h"]),
        ({"levels": 2, "effort": points(*FULL[:3])}, "case.traction.effort", "missing_level", ["level 2"]),
        ({"adhesion": True}, "case.traction.adhesion", "no_adhesive_mass", ["loco"]),
    ],
)
def test_a_traction_that_cannot_be(traction, path, code, words):
    (problem,) = check_gear(scenario(traction=traction))
    assert (problem.path, problem.code, problem.severity) == (path, code, "error")
    assert all(word in problem.found for word in words)


def test_a_drive_that_does_not_tell_its_effort():
    series = {"kind": "series_motors", "motors": 4, "groupings": [{"series": 4, "parallel": 1}], "starting_current_a": 300.0,
              "motor_resistance_ohm": 0.2, "gear_ratio": 4.0, "wheel_diameter_m": 1.2, "gear_efficiency": 0.97,
              "magnetisation": [{"current_a": a, "emf_vs_per_rev": a / 3.0} for a in (100.0, 300.0)]}  # fmt: skip
    loco = vehicle("loco", "locomotive", drive=series)
    (problem,) = check_gear(scenario(loco=loco))
    assert (problem.path, problem.code) == (LOCO, "no_effort")
    assert "series_motors" in problem.found
    assert "traction" in problem.remedy
    (problem,) = check_gear(
        scenario(loco=loco, traction={"power_kw": 900.0}, vehicles=[{"id": "loco", "count": 2}, {"id": "loco"}])
    )
    assert problem.path == "case.traction"
    assert "power" not in problem.found
    assert check_gear(scenario(loco=loco, traction={"starting_effort_kn": 90.0, "power_kw": 900.0})) == []
    assert check_gear(scenario(loco=loco, vehicles=[{"id": "loco", "powered": False}])) == []


def test_a_table_has_no_power_by_level():
    table = {"kind": "table", "effort": [{"speed_kmh": v, "effort_kn": 200.0} for v in (0, 50)],
             "current": [{"speed_kmh": v, "current_a": 900.0} for v in (0, 50)]}  # fmt: skip
    loco = vehicle("loco", "locomotive", drive=table)
    (problem,) = check_gear(scenario(loco=loco, traction={"law": "quadratic_power"}))
    assert (problem.path, problem.allowed) == ("case.traction.law", "linear")
    assert check_gear(scenario(loco=loco)) == []
    (problem,) = check_gear(scenario(loco=loco, traction={"power_kw": 900.0}))
    assert problem.code == "no_effort"


def test_controls_with_different_levels():
    parts = [{"id": "loco"}, {"id": "loco", "traction": {"levels": 8}}]
    (problem,) = check_gear(scenario(vehicles=parts, traction={"levels": 15}))
    assert (problem.path, problem.severity) == ("case.vehicles[1].traction.levels", "warning")
    parts = [{"id": "loco"}, {"id": "loco", "electric_brake": {"levels": 4, "effort_kn": 1.0, "power_kw": 1.0}}]
    (problem,) = check_gear(scenario(vehicles=parts, electric_brake={"effort_kn": 1.0, "power_kw": 1.0}, loco=locomotive()))
    assert (problem.path, problem.severity) == ("case.vehicles[1].electric_brake.levels", "error")


@pytest.mark.parametrize(
    ("gear", "code", "words"),
    [
        ({}, "no_block_force", ["nothing"]),
        ({"cylinder_area_cm2": 900.0}, "no_block_force", ["cylinder_area_cm2 alone"]),
        ({"rigging_ratio": 5.0}, "no_block_force", ["rigging_ratio alone"]),
        (RIGGING | {"brake_ratio": 0.5}, "contradiction", ["brake_ratio and cylinder_area_cm2 and rigging_ratio"]),
    ],
)
def test_a_brake_gear_says_its_force_once(gear, code, words):
    (problem,) = check_gear(scenario(brake=gear))
    assert (problem.path, problem.code, problem.severity) == ("case.brake", code, "error")
    assert all(word in problem.found for word in words)
    parts = [{"id": "loco"}, {"id": "wagon", "brake": gear}]
    (problem,) = check_gear(scenario(vehicles=parts))
    assert problem.path == "case.vehicles[1].brake"


@pytest.mark.parametrize(
    ("friction", "code", "words"),
    [
        ({"law": "table"}, "no_points", []),
        ({"law": "karwatzki", "points": [(0, 1, 0.3)]}, "contradiction", ["karwatzki"]),
        ({"law": "table", "points": [(0, 1, 0.3), (50, 1, 0.2), (0, 9, 0.1)]}, "friction_grid", ["50 km/h and 9 kN"]),
        ({"law": "table", "points": [(0, 1, 0.3), (0, 1, 0.2)]}, "friction_grid", ["several at 0 km/h and 1 kN"]),
    ],
)
def test_a_table_of_friction_is_full(friction, code, words):
    rows = [dict(zip(("speed_kmh", "block_force_kn", "friction"), row, strict=True)) for row in friction.get("points", [])]
    (problem,) = check_gear(scenario(brake=GEAR | {"friction": friction | {"points": rows}}))
    assert (problem.path, problem.code, problem.severity) == ("case.brake.friction.points", code, "error")
    assert all(word in problem.found for word in words)

"""What is wrong with couplings: each fault is found by its code, at its place."""

import pytest
from small_couplings import SPRING_8_9, coupling, points, wedge

from tractionpower.dynamics.coupling_checks import check_coupling

SPRING = {"loading": points(*SPRING_8_9)}
LOCKED = {"locked_stiffness_kn_per_mm": 600.0}


def found(draw, **more):
    return [(problem.code, problem.path, problem.severity) for problem in check_coupling(coupling(draw, **more), "c")]


FAULTS = [
    ({}, "no_curve", "c.draw"),
    ({"loading": points((0.0, 240.0))} | LOCKED, "no_curve", "c.draw.loading"),
    ({"loading": points((50.0, 0.0))}, "no_force", "c.draw.loading"),
    (SPRING | {"stiffness_kn_per_mm": 5.0}, "two_curves", "c.draw"),
    ({"loading": points((50.0, 500.0), (40.0, 600.0))}, "unsorted", "c.draw.loading[1].deflection_mm"),
    ({"loading": points((50.0, 500.0), (50.0, 600.0))}, "unsorted", "c.draw.loading[1].deflection_mm"),
    ({"loading": points((20.0, 100.0), (50.0, 500.0), (90.0, 400.0))}, "falling", "c.draw.loading[2].force_kn"),
    (SPRING | {"unloading": points((60.0, 50.0), (70.0, 40.0))}, "falling", "c.draw.unloading[1].force_kn"),
    (SPRING | {"unloading": points((0.0, 0.0))}, "no_curve", "c.draw.unloading"),
    (SPRING | {"unloading": points((50.0, 501.0))}, "unloading_above_loading", "c.draw.unloading"),
    (SPRING | {"unloading": points((0.0, 10.0), (50.0, 300.0))}, "unloading_above_loading", "c.draw.unloading"),
    (SPRING | {"unloading": points((50.0, 300.0)), "damping_percent": 10.0}, "contradictory_unloading", "c.draw"),
    (SPRING | {"wedge": wedge(), "damping_percent": 10.0}, "contradictory_unloading", "c.draw"),
    (SPRING | {"wedge": wedge(), "unloading": points((50.0, 300.0))}, "contradictory_unloading", "c.draw"),
    ({"loading": points((0.0, 240.0), (90.0, 2553.0))}, "preload_without_locked_stiffness", "c.draw.loading[0].force_kn"),
    (SPRING | LOCKED | {"wedge": wedge(0.71, 0.2)}, "locked_wedge", "c.draw.wedge.static_friction"),
    (SPRING | LOCKED | {"wedge": wedge(0.71)}, "locked_wedge", "c.draw.wedge.kinetic_friction"),
    (SPRING | {"wedge": wedge(0.4, 0.2)}, "wedge_without_locked_stiffness", "c.draw"),
    (SPRING | {"locked_stiffness_kn_per_mm": 24.0}, "soft_locked_stiffness", "c.draw.locked_stiffness_kn_per_mm"),
    (
        SPRING | {"locked_stiffness_kn_per_mm": 58.0, "wedge": wedge(0.4, 0.2)},  # 25 x 2.33
        "soft_locked_stiffness",
        "c.draw.locked_stiffness_kn_per_mm",
    ),
    (SPRING | {"stroke_mm": 100.0}, "no_solid_stiffness", "c.draw.stroke_mm"),
]


@pytest.mark.parametrize(("draw", "code", "path"), FAULTS)
def test_errors(draw, code, path):
    assert (code, path, "error") in found(draw)


DOUBTS = [
    (SPRING | LOCKED | {"wedge": wedge(0.2, 0.4)}, "friction_rises", "c.draw.wedge.kinetic_friction"),
    (SPRING | LOCKED | {"blending_mps": 0.2}, "no_effect", "c.draw.blending_mps"),
    (SPRING | {"wedge": wedge(), "blending_mps": 0.2}, "no_effect", "c.draw.blending_mps"),
    (SPRING | {"solid_stiffness_kn_per_mm": 100.0}, "no_effect", "c.draw.solid_stiffness_kn_per_mm"),
    (SPRING | LOCKED | {"stroke_mm": 99.0}, "points_beyond_stroke", "c.draw.stroke_mm"),
    (
        SPRING | {"stroke_mm": 100.0, "solid_stiffness_kn_per_mm": 24.0},
        "soft_when_solid",
        "c.draw.solid_stiffness_kn_per_mm",
    ),
    (SPRING | {"relaxing_stiffness_kn_per_mm": 10.5}, "stiff_relaxing", "c.draw.relaxing_stiffness_kn_per_mm"),
]


@pytest.mark.parametrize(("draw", "code", "path"), DOUBTS)
def test_warnings(draw, code, path):
    assert found(draw) == [(code, path, "warning")]


SOUND = [
    {"stiffness_kn_per_mm": 5.0},
    SPRING | {"damping_percent": 100.0, "blending_mps": 0.2},
    SPRING | {"wedge": wedge(0.69)},
    SPRING | LOCKED | {"wedge": wedge(0.4, 0.2), "relaxing_stiffness_kn_per_mm": 0.6, "stroke_mm": 400.0},
    SPRING | {"locked_stiffness_kn_per_mm": 25.0, "stroke_mm": 100.0},
    SPRING | {"locked_stiffness_kn_per_mm": 25.0, "in_series": 2},
    SPRING | {"unloading": points((50.0, 500.0))},  # without loss up to 50 mm, softer beyond
]


@pytest.mark.parametrize("draw", SOUND)
def test_nothing_is_said_about_sound_ones(draw):
    assert found(draw) == []


def test_the_wedge_that_locks_is_told_with_both_numbers():
    (problem,) = check_coupling(coupling(SPRING | LOCKED | {"wedge": wedge(0.75, 0.2)}), "couplings[c]")
    assert "0.75" in problem.found and "0.7002" in problem.found and problem.allowed == "below 0.7002"
    assert problem.path == "couplings[c].draw.wedge.static_friction"


def test_both_sides_are_checked_and_all_is_told_at_once():
    told = found({"loading": points((50.0, 500.0), (40.0, 1.0))}, buff={"stroke_mm": 10.0}, slack_mm=-30.0)
    assert [code for code, _, _ in told] == ["unsorted", "no_curve", "no_solid_stiffness", "solid_at_rest"]
    assert told[1][1] == "c.buff"
    assert told[3][1] == "c.slack_mm"

"""Checks of a case: each thing that is wrong is told once, with place, found, allowed and remedy; a sound case is silent."""

import pytest
from chains import LOCOMOTIVE, WAGON, free, make_chain, pulled, spring

from tractionpower.dynamics.checks import check_case, fitting_record, recorded_rows
from tractionpower.model.dynamics.case import DynamicsScenario

SOFT = spring(5.0)


def told(scenario):
    """Return severity, code and path of the problems."""
    return [(problem.severity, problem.code, problem.path) for problem in check_case(scenario)]


def only(scenario):
    problems = check_case(scenario)
    assert len(problems) == 1, problems
    assert problems[0].found
    assert problems[0].allowed or problems[0].remedy
    return problems[0]


def on_track(**track):
    return pulled(2, SOFT, track=track)


def commanded(*rows, **more):
    return pulled(2, SOFT, commands=list(rows), brake={"brake_ratio": 0.5}, **more)


def test_a_sound_case_is_silent():
    assert check_case(pulled(3, SOFT)) == []


# --- train


def with_coupling(scenario, name):
    return scenario.model_copy(update={"case": scenario.case.model_copy(update={"coupling": name})})


def test_no_coupling_behind_a_vehicle_but_the_last():
    scenario = with_coupling(make_chain([{"id": "loco"}, {"id": "wagon"}], SOFT, start={"speed_kmh": 10.0}), None)
    problem = only(scenario)
    assert (problem.code, problem.path) == ("missing_coupling", "case.vehicles[0]")
    scenario = with_coupling(make_chain([{"id": "loco", "coupling": "c"}, {"id": "wagon", "count": 2}], SOFT), None)
    assert told(scenario) == [("error", "missing_coupling", "case.vehicles[1]")]
    parts = [{"id": "loco", "coupling": "c"}, {"id": "wagon"}]
    assert check_case(with_coupling(make_chain(parts, SOFT, start={"speed_kmh": 10.0}), None)) == []


def test_names_that_are_not_there_and_ids_that_stand_twice():
    parts = [{"id": "loco", "coupling": "d"}, {"id": "coach"}]
    scenario = with_coupling(make_chain(parts, SOFT, vehicles=(LOCOMOTIVE, WAGON, WAGON)), "e")
    assert told(scenario) == [
        ("error", "duplicate_id", "vehicles[wagon]"),
        ("error", "unknown_coupling", "case.coupling"),
        ("error", "unknown_coupling", "case.vehicles[0].coupling"),
        ("error", "unknown_vehicle", "case.vehicles[1].id"),
    ]


def test_a_train_that_nothing_moves():
    problem = only(free([80.0, 80.0], SOFT))
    assert (problem.severity, problem.code) == ("warning", "nothing_moves")
    assert check_case(free([80.0, 80.0], SOFT, start={"speed_kmh": 10.0})) == []
    assert check_case(free([80.0, 80.0], SOFT, track={"gradients": [{"from_m": -500.0, "to_m": 500.0, "permille": -5.0}]})) == []


def test_a_train_that_is_too_long():
    parts = [{"id": "loco"}] + 5 * [{"id": "wagon", "count": 500}]
    scenario = make_chain(parts, SOFT)
    assert told(scenario) == [("error", "too_many", "case.vehicles")]


# --- track


@pytest.mark.parametrize("name", ["gradients", "curves", "tunnels"])
def test_stretches_that_overlap_or_are_reversed(name):
    value = {"gradients": {"permille": 1.0}, "curves": {"radius_m": 800.0}, "tunnels": {"kind": "single_track"}}[name]
    places = [(500.0, 900.0), (0.0, 100.0), (90.0, 400.0), (300.0, 200.0), (900.0, 950.0)]
    rows = [{"from_m": a, "to_m": b} | value for a, b in places]
    assert told(on_track(**{name: rows})) == [
        ("error", "reversed", f"case.track.{name}[3].to_m"),
        ("error", "overlap", f"case.track.{name}[2].from_m"),
    ]


@pytest.mark.parametrize(
    ("radius_m", "law", "codes"),
    [
        (300.0, None, []),
        (150.0, None, []),
        (60.0, None, []),
        (40.0, None, ["small_radius"]),
        (30.0, None, ["singular"]),
        (10.0, None, ["singular"]),
        (55.0, {"a_n_m_per_kn": 650.0, "b_m": 55.0}, ["singular"]),
        (55.0, {"a_n_m_per_kn": 700.0}, ["small_radius"]),
    ],
)
def test_radii_at_which_the_curve_resistance_has_no_value(radius_m, law, codes):
    curve = {"from_m": 10.0, "to_m": 50.0, "radius_m": radius_m}
    problems = check_case(on_track(curves=[curve], **({"curve_resistance": law} if law else {})))
    assert [problem.code for problem in problems] == codes
    assert all(problem.path == "case.track.curves[0].radius_m" for problem in problems)


def test_transitions():
    rows = [{"radius_m": 300.0, "half_length_m": 30.0}, {"radius_m": 300.0, "half_length_m": 30.0}]
    curves = [{"from_m": 0.0, "to_m": 50.0, "radius_m": 300.0}, {"from_m": 500.0, "to_m": 560.0, "radius_m": 300.0}]
    assert told(on_track(transitions=rows, curves=curves)) == [
        ("error", "duplicate_row", "case.track.transitions[1].radius_m"),
        ("warning", "long_transition", "case.track.curves[0]"),
    ]


def test_transitions_are_those_of_the_radius_of_each_curve():
    rows = [{"radius_m": 300.0, "half_length_m": 150.0}, {"radius_m": 4000.0, "half_length_m": 0.0}]
    wide = {"from_m": 100.0, "to_m": 300.0, "radius_m": 5000.0}
    assert told(on_track(transitions=rows, curves=[wide])) == []
    near = [{"from_m": 500.0, "to_m": 900.0, "radius_m": 300.0}, {"from_m": 1199.0, "to_m": 1600.0, "radius_m": 300.0}]
    assert told(on_track(transitions=rows, curves=near)) == [("warning", "long_transition", "case.track.curves[1]")]


@pytest.mark.parametrize(("length_m", "is_told"), [(79.0, True), (80.0, False)])
def test_gradients_shorter_than_their_roundings(length_m, is_told):
    # 10 permille by 4000 m: a rounding of 40 m, half of it on either side of each break; one break is of twice that.
    rows = [{"from_m": 0.0, "to_m": length_m, "permille": 10.0}, {"from_m": length_m, "to_m": 900.0, "permille": -20.0}]
    problems = told(on_track(gradients=rows))
    assert problems == ([("warning", "short_gradient", "case.track.gradients[0]")] if is_told else [])
    assert told(on_track(gradients=rows, rounding_radius_m=0.0)) == []


# --- commands


def test_rows_of_commands_that_are_unsorted_equal_contradictory_or_empty():
    scenario = commanded(
        {"time_s": 0.0, "drive": 1}, {"time_s": 20.0, "brake": 3, "reduction_bar": 0.5}, {"time_s": 10.0, "drive": 0},
        {"time_s": 10.0, "drive": 1}, {"time_s": 30.0},
    )  # fmt: skip
    assert told(scenario) == [
        ("error", "contradiction", "case.commands[1]"),
        ("error", "unsorted", "case.commands[2].time_s"),
        ("error", "equal_times", "case.commands[3].time_s"),
        ("warning", "empty_row", "case.commands[4]"),
    ]


def test_rows_after_the_end_are_one_warning():
    scenario = commanded(
        {"time_s": 0.0, "drive": 1}, {"time_s": 1000.0, "drive": 0}, {"time_s": 1001.0, "drive": 1}, {"time_s": 2e3, "drive": 0}
    )
    problem = only(scenario)
    assert (problem.severity, problem.code, problem.path) == ("warning", "after_the_end", "case.commands[2].time_s")
    assert problem.found == "2 of 4 rows after the end at 1000 s: 1001, 2000 s"


def test_traction_against_the_electric_brake_is_told_where_it_begins():
    electric = {"effort_kn": 100.0, "power_kw": 1000.0}
    rows = [
        {"time_s": 0.0, "drive": 1},
        {"time_s": 5.0, "electric": 3.0},
        {"time_s": 6.0, "electric": 4.0},
        {"time_s": 7.0, "drive": 0},
    ]
    problem = only(commanded(*rows, electric_brake=electric))
    assert (problem.severity, problem.code, problem.path) == ("warning", "drive_and_electric", "case.commands[1]")


def test_levels_and_reductions_are_checked_too():
    scenario = commanded({"time_s": 0.0, "drive": 2}, {"time_s": 1.0, "reduction_bar": 5.5})
    assert told(scenario) == [
        ("error", "level", "case.commands[0].drive"), ("error", "reduction", "case.commands[1].reduction_bar"),
    ]  # fmt: skip


# --- run


def with_run(**run) -> DynamicsScenario:
    return pulled(2, SOFT, run=run)


def test_more_rows_than_the_limit_are_refused_with_the_step_that_fits():
    scenario = with_run(duration_s=150.0, step_s=0.005, record_every_s=0.005, rows_limit=20_000)
    problem = only(scenario)
    assert (problem.code, problem.path) == ("state_vector", "case.run.rows_limit")
    assert problem.found == "30001 rows of 0.005 s in 150 s, and the limit is 20000"
    assert "record_every_s: 0.01 fits, and so does rows_limit: 30001" in problem.remedy
    assert fitting_record(scenario.case) == 0.01
    sound = with_run(duration_s=150.0, step_s=0.005, record_every_s=0.01, rows_limit=20_000)
    assert check_case(sound) == []
    assert recorded_rows(sound.case) == 15_001


@pytest.mark.parametrize(("duration_s", "rows"), [(1.0, 11), (1.05, 12), (0.3, 4)])
def test_the_last_instant_is_a_row_of_its_own(duration_s, rows):
    assert recorded_rows(with_run(duration_s=duration_s, record_every_s=0.1).case) == rows


def test_steps_longer_than_records_or_the_run():
    assert told(with_run(step_s=0.02, record_every_s=0.01)) == [("error", "record", "case.run.step_s")]
    assert told(with_run(step_s=0.02, record_every_s=0.01, method="variable")) == []
    assert ("error", "step", "case.run.step_s") in told(with_run(duration_s=0.01, step_s=0.02, record_every_s=0.05))


def test_a_step_too_large_for_the_couplings_is_told_when_all_else_is_sound():
    assert told(pulled(2, spring(600.0), run={"step_s": 0.05})) == [("error", "step_too_large", "case.run.step_s")]


def test_couplings_are_checked():
    wedge = {"angle_deg": 35.0, "static_friction": 0.8, "kinetic_friction": 0.2}
    loading = [{"deflection_mm": 0.0, "force_kn": 0.0}, {"deflection_mm": 50.0, "force_kn": 500.0}]
    problems = check_case(pulled(2, {"draw": {"loading": loading, "wedge": wedge, "locked_stiffness_kn_per_mm": 600.0}}))
    assert problems
    assert all(problem.path.startswith("couplings[c].draw.wedge") for problem in problems if problem.severity == "error")

"""A configuration with its files as a case: what it becomes, what it says of a short state vector, bad input at once."""

import math

import pytest
from arshad_files import CONSIST, INI, TABLE_4, TABLE_6, read_arshad_files

from tractionpower.dynamics.checks import check_case

PSI = 0.06894757293168
ELECTRIC = (
    "Position,Number,Type,Lading Weight (t),Tare Weight (t),Length (m),Axles,Tractive Effort (kN),Power (kW),"
    "Dynamic Brake Effort (kN),Dynamic Brake Power (kW)\n"
    "1,1,Locomotive,0,110,19,6,270,1500,150,1200\n2,5,Car,0,25,15,4,,,,\n"
)


@pytest.fixture
def read(tmp_path):
    def tell(changed=None, extra=""):
        return read_arshad_files(tmp_path, changed, extra)

    return tell


def scenario_of(read, changed=None, extra=""):
    loaded, problems = read(changed, extra)
    assert loaded is not None, problems
    return loaded.scenario


# --- sound files


def test_the_wagon_connection_of_section_7_2(read):
    coupling = scenario_of(read).couplings[0]
    draw = coupling.draw
    assert coupling.slack_mm == pytest.approx(100.0)
    assert [(point.deflection_mm, point.force_kn) for point in draw.loading] == [(0.0, 0.0), (50.0, 300.0), (150.0, 2000.0)]
    assert (draw.wedge.angle_deg, draw.wedge.static_friction, draw.wedge.kinetic_friction) == (35.0, 0.4, 0.2)
    assert (draw.locked_stiffness_kn_per_mm, draw.relaxing_stiffness_kn_per_mm) == pytest.approx((600.0, 0.6))
    assert draw.stroke_mm == pytest.approx(350.0)  # 0.4 m with half of the slack


def test_without_stages_eq_8_and_9_hold(read):
    text = "".join(line for line in INI.splitlines(keepends=True) if "stage" not in line)
    loading = scenario_of(read, {"Simulation.ini": text}).couplings[0].draw.loading
    assert [(point.deflection_mm, point.force_kn) for point in loading] == [(0.0, 0.0), (50.0, 500.0), (150.0, 3000.0)]


def test_two_draft_gears_in_series_share_the_stroke(read):
    draw = scenario_of(read, extra="Draft gears in series = 2\n").couplings[0].draw
    assert (draw.in_series, draw.stroke_mm) == (2, pytest.approx(175.0))


def test_the_air_brake_in_pounds_per_square_inch(read):
    case = scenario_of(read).case
    air = case.air_brake
    assert air.pipe_pressure_bar == pytest.approx(90 * PSI)
    assert air.full_service_reduction_bar == pytest.approx(26 * PSI)
    assert air.gain * 7 * PSI == pytest.approx(17.5 * PSI)
    assert air.cylinder_pressure_bar == pytest.approx(64 * PSI)
    assert air.cylinder_emergency_bar == pytest.approx(74.6 * PSI)
    assert case.brake.brake_ratio == 0.12


def test_a_gross_braking_ratio_is_lessened_by_the_rigging(read):
    case = scenario_of(read, extra="Gross Braking Ratio = 15 %\nBrake Ragging = 0.8\nMu = 0.25\n").case
    assert case.brake.brake_ratio == pytest.approx(0.12)
    assert case.brake.friction.friction == 0.25


def test_other_keys_reach_the_case(read):
    extra = "Distance limit = 1000 ft\nName = Ours\nMethod = rk4\nGrade = train\nUnits of figures = metric\nNotches = 31\n"
    case = scenario_of(read, extra=extra).case
    assert case.run.distance_limit_m == pytest.approx(304.8)
    assert (case.name, case.run.method, case.grade, case.units) == ("Ours", "rk4", "train", "metric")
    assert case.vehicles[0].traction.levels == 31
    assert "Brake pipe pressure 90 psi" in case.source


def test_paths_of_the_files(read, tmp_path):
    (tmp_path / "track").mkdir()
    (tmp_path / "track" / "hill.csv").write_text(TABLE_6.replace("1 %", "2 %"), encoding="utf-8")
    scenario = scenario_of(read, extra="Track Profile Path = track\\hill.csv\n")
    assert scenario.case.track.gradients[0].permille == 20.0


def test_table_4_runs_with_warnings(read):
    loaded, problems = read({"DynamicParameter.csv": TABLE_4, "TrainConsist.csv": ELECTRIC})
    assert {problem.severity for problem in problems} == {"warning"}
    told = {problem.code: problem for problem in loaded.provenance.place(check_case(loaded.scenario))}
    assert {problem.severity for problem in told.values()} == {"warning"}
    assert set(told) == {"after_the_end", "drive_and_electric", "power_in_emergency"}
    assert told["power_in_emergency"].place == "DynamicParameter.csv:7"
    assert told["after_the_end"].place == "DynamicParameter.csv:5"


# --- the state vector


def test_steps_beyond_the_state_vector_are_thinned_and_said(read):
    loaded, problems = read()
    run = loaded.scenario.case.run
    assert (run.rows_limit, run.record_every_s) == (20000, 0.01)
    assert [(problem.code, problem.severity, problem.place) for problem in problems] == [
        ("state_vector", "warning", "Simulation.ini:1")
    ]
    assert "30000 steps of 0.005 s in 150 s are more than a state vector of 20000" in problems[0].found
    assert "every 2nd step: 15001 rows" in problems[0].remedy
    assert check_case(loaded.scenario) == []


@pytest.mark.parametrize("size", [2, 3, 7, 1000, 15000, 15001, 30000, 30001, 40000])
def test_the_thinned_rows_fit_and_one_step_less_does_not(read, size):
    loaded, _ = read({"Simulation.ini": INI.replace("20000", str(size))})
    run = loaded.scenario.case.run
    every = round(run.record_every_s / run.step_s)
    assert run.record_every_s == every * run.step_s
    assert math.ceil(30000 / every) + 1 <= size
    assert every == 1 or math.ceil(30000 / (every - 1)) + 1 > size
    assert not [problem for problem in check_case(loaded.scenario) if problem.code == "state_vector"]


def test_a_state_vector_that_is_long_enough_is_filled_step_by_step(read):
    loaded, problems = read({"Simulation.ini": INI.replace("20000", "30001")})
    assert problems == []
    assert loaded.scenario.case.run.record_every_s == 0.005


def test_a_fixed_record_that_does_not_fit_is_refused_with_the_one_that_does(read):
    loaded, problems = read(extra="Record every = 0.005 s\n")
    assert loaded is None
    assert [(problem.code, problem.severity, problem.place) for problem in problems] == [
        ("state_vector", "error", "Simulation.ini:14")
    ]
    assert problems[0].found == "30001 rows of 0.005 s in a state vector of 20000"
    assert "Record every = 0.01 s fits" in problems[0].remedy


# --- bad input


def test_everything_wrong_in_all_files_is_told_at_once(read):
    changed = {
        "DynamicParameter.csv": "Time,Notch,Brake Pipe Pressure\n0,1,Chrage\n",
        "TrackProfile.csv": TABLE_6.replace("Curve,2 Deg", "Curve,2 %"),
        "TrainConsist.csv": CONSIST.replace("Car", "Cart"),
    }
    _, problems = read(changed, "Wedge angel = 3\nMu = much\n")
    assert [problem.place for problem in problems] == [
        "Simulation.ini:14", "Simulation.ini:15", "TrainConsist.csv:3", "TrackProfile.csv:5", "DynamicParameter.csv:2",
    ]  # fmt: skip
    loaded, problems = read(changed, "Gross Braking Ratio = 0.5\nNet Braking Ratio = 0.1\nRecord every = 0.001\n")
    assert loaded is None
    assert [problem.place for problem in problems if problem.severity == "error"] == [
        "TrainConsist.csv:3", "TrackProfile.csv:5", "DynamicParameter.csv:2", "Simulation.ini:15", "Simulation.ini:16",
    ]  # fmt: skip
    for problem in problems:
        assert problem.found
        assert problem.allowed or problem.remedy


def test_a_missing_file_is_told_where_it_is_named(read):
    _, problems = read(extra="Train Consist Path = consist/none.csv\n")
    errors = [problem for problem in problems if problem.severity == "error"]
    assert [(problem.code, problem.found) for problem in errors] == [("missing_file", "there is no file consist/none.csv")]
    assert errors[0].place.startswith("Simulation.ini:14")


def test_the_cut_of_cars_is_that_of_the_consist(read):
    _, problems = read({"TrainConsist.csv": CONSIST.replace("2,5,Car", "2,6,Car")})
    error = next(problem for problem in problems if problem.severity == "error")
    assert (error.place, error.found, error.allowed) == ("Simulation.ini:13", "5", "6, as TrainConsist.csv has")


def test_a_dynamic_brake_that_nobody_has(read):
    _, problems = read({"DynamicParameter.csv": TABLE_4})
    error = next(problem for problem in problems if problem.severity == "error")
    assert "Dynamic Brake Effort (kN)" in error.remedy


def test_a_hard_limit_within_the_slack(read):
    _, problems = read({"Simulation.ini": INI.replace("0.4 m", "0.05 m")})
    assert ("Simulation.ini:4", "0.05 m") in [(problem.place, problem.found) for problem in problems]


def test_a_wedge_that_locks_and_a_reduction_beyond_the_pipe_are_told_by_file_and_line(read):
    changed = {
        "Simulation.ini": INI.replace("Static fric coff = 0.4", "Static fric coff = 0.75"),
        "DynamicParameter.csv": "Time,Notch,Brake Pipe Pressure\n0,1,Charge\n30,0,95\n20,0,Uc\n",
    }
    loaded, _ = read(changed)
    problems = loaded.provenance.place(check_case(loaded.scenario))
    places = {problem.place for problem in problems if problem.severity == "error"}
    assert places == {"Simulation.ini:11", "DynamicParameter.csv:3", "DynamicParameter.csv:4"}

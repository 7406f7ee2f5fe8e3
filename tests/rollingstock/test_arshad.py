"""The experiment of Arshad et al., section 7: files as printed, speeds of a point mass, and what section 7.3 tells of it."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from arshad_files import INI, TABLE_6, TABLE_7, read_arshad_files
from chains import Chained, advanced

from tractionpower.io.dynamics_files import load_case

FOLDER = Path(__file__).parents[2] / "rollingstock" / "dynamics" / "arshad"
FT = 0.3048
PA_PER_PSI = 6894.757293168
LENGTH_M = 94.0
"""Length of the train: its front starts there on the profile."""


def lines(text):
    return [line.strip() for line in text.splitlines()]


def point_mass(step_s=1e-3):
    """Return speed [km/h] and way [ft] by time [s] of the train as one mass: the fill of the reference, in its own words.

    110 t and five times 25 t, 4 % rotating; min(270 kN n/8, 1500 kW (n/8)^2 / v); 1.5 + 0.02 V N/kN and 1 %; cylinder pressure
    2.5 times the reduction with a lag of 3 s; brake 0.12 of the weight at 64 psi with a friction of 0.3.
    """
    mass = 235e3
    weight = mass * 9.80665
    v = s = psi = 0.0
    told = {}
    for k in range(int(150 / step_s) + 1):
        t = k * step_s
        if abs(t - round(t)) < step_s / 2:
            told[round(t)] = (3.6 * v, s / FT)
        notch = 0 if t >= 100 else 3 if t >= 60 else 2 if t >= 30 else 1
        reduction = 15.0 if t >= 100 else 7.0 if t >= 80 else 0.0
        psi += (2.5 * reduction - psi) * -math.expm1(-step_s / 3.0)
        effort = min(270e3 * notch / 8, 1.5e6 * (notch / 8) ** 2 / max(v, 1e-9))
        resisting = weight * ((1.5 + 0.02 * 3.6 * v) / 1000 + 0.01 + 0.12 * 0.3 * psi / 64)
        v = max(v + (effort - resisting) / (1.04 * mass) * step_s, 0.0)
        s += v * step_s
    return told


@pytest.fixture(scope="module")
def one_mass():
    return point_mass()


@pytest.fixture(scope="module")
def run():
    """Return the shipped case, run to its end."""
    chained = Chained(load_case(FOLDER).scenario, rows=16_000)
    chained.advance(150.0)
    return chained


def at(run, time_s):
    """Return the index of the row of a time."""
    return int(np.flatnonzero(np.abs(run.rows["time_s"] - time_s) < 1e-6)[0])


# --- the files


def test_the_files_are_as_printed():
    printed = lines(INI)
    assert lines((FOLDER / "Simulation.ini").read_text(encoding="utf-8"))[: len(printed)] == printed
    assert lines((FOLDER / "DynamicParameter.csv").read_text(encoding="utf-8")) == lines(TABLE_7)
    assert lines((FOLDER / "TrackProfile.csv").read_text(encoding="utf-8")) == lines(TABLE_6)


def test_the_case_says_what_is_assumed_and_thins_its_rows():
    loaded = load_case("arshad")
    assert "Friction blending speed 0.1 m/s (assumed" in loaded.scenario.case.source
    assert [problem.code for problem in loaded.problems] == ["state_vector"]
    assert loaded.scenario.case.units == "imperial"


def test_the_readme_tells_every_file():
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    for file in FOLDER.iterdir():
        assert file.name == "README.md" or file.name in text


# --- the motion


def test_the_point_mass_has_the_shape_of_figure_5(one_mass):
    speeds = {30: 2.9, 60: 10.4, 80: 17.9, 100: 16.8}
    assert {time: one_mass[time][0] for time in speeds} == pytest.approx(speeds, abs=0.06)
    stop = next(time for time in range(100, 150) if one_mass[time][0] == 0.0)
    assert stop == 117  # the first whole second after 116
    assert one_mass[150][1] + LENGTH_M / FT == pytest.approx(1290.0, abs=2.0)


def test_the_chain_follows_the_point_mass(run, one_mass):
    masses = run.chain.vehicles["inertia_kg"]
    assert masses.sum() == pytest.approx(1.04 * 235e3)
    for time in (10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 105, 110, 114):
        mean = float((run.vehicle_rows[at(run, time)]["v_mps"] * masses).sum() / masses.sum())
        # The slack lets the cars start and stop after the locomotive.
        assert 3.6 * mean == pytest.approx(one_mass[time][0], abs=0.1), time
    way = (run.movers["s_m"] - run.movers["start_m"]) / FT
    assert way[0] == pytest.approx(one_mass[150][1], abs=2.0)


def test_section_7_3_speed_rises_with_each_notch_and_ends_at_rest(run):
    speeds = run.vehicle_rows["v_mps"] * 3.6
    for car in (0, 2, 5):
        before, at_60, at_80, after = (speeds[at(run, time), car] for time in (30, 60, 80, 100))
        assert before < at_60 < at_80
        assert at_60 - before > 5.0
        assert after < at_80
    standing = np.flatnonzero(run.rows["time_s"] >= 120.0)
    assert np.all(speeds[standing] == 0.0)


def test_section_7_3_tractive_effort_by_notch_and_none_from_100_s(run):
    effort = run.vehicle_rows["traction_n"][:, 0]
    assert effort[at(run, 5)] == pytest.approx(270e3 / 8)
    speed = run.vehicle_rows["v_mps"][at(run, 79), 0]
    assert effort[at(run, 79)] == pytest.approx(min(270e3 * 3 / 8, 1.5e6 * (3 / 8) ** 2 / speed), rel=1e-6)
    assert np.all(effort[run.rows["time_s"] > 100.005] == 0.0)
    assert np.all(run.vehicle_rows["traction_n"][:, 1:] == 0.0)


def test_section_7_3_acceleration_has_a_transient_at_each_notch(run):
    acceleration = run.vehicle_rows["a_mps2"][:, 0]
    time = run.rows["time_s"]
    quiet = np.ptp(acceleration[(time > 25.0) & (time < 29.9)])
    for change in (30.0, 60.0, 100.0):
        shaken = np.ptp(acceleration[(time > change) & (time < change + 5.0)])
        assert shaken > 3.0 * quiet


def test_section_7_3_cylinders_fill_twice_and_later_at_the_rear(run):
    psi = run.vehicle_rows["cylinder_pa"] / PA_PER_PSI
    assert np.all(psi[run.rows["time_s"] <= 80.0] == 0.0)
    # The middle of the last car is 77 m behind that of the locomotive.
    lag = 20.0 - np.array([0.0, 77.0]) / 243.84
    assert psi[at(run, 100), 0] == pytest.approx(17.5 * -math.expm1(-lag[0] / 3.0), rel=1e-6)
    assert psi[at(run, 100), 5] == pytest.approx(17.5 * -math.expm1(-lag[1] / 3.0), rel=1e-4)
    assert psi[at(run, 150), 0] == pytest.approx(37.5, rel=1e-5)
    rising = (run.rows["time_s"] > 80.4) & (run.rows["time_s"] < 95.0)
    assert np.all(psi[rising, 5] < psi[rising, 0])


def test_figure_9_a_loop_with_a_dead_zone_between_cars_3_and_4(run):
    stretch, force = run.link_rows["stretch_m"][:, 2], run.link_rows["force_n"][:, 2]
    dead = np.abs(stretch) < 0.05 - 1e-9
    assert dead.any()
    assert np.all(force[dead] == 0.0)
    assert force.max() > 10e3  # draft
    assert force.min() < -1e3  # buff
    taken = run.links["absorbed_j"][2]
    assert taken > 0.0
    assert np.max(np.abs(stretch)) < 0.4


def test_the_works_of_the_run_add_up(run):
    gap, size = run.ledger_gap(0.0)
    assert abs(gap) < 1e-9 * size


def test_the_row_of_4_percent_is_met_by_a_train_that_starts_there(tmp_path):
    consist = (FOLDER / "TrainConsist.csv").read_text(encoding="utf-8")
    loaded, _ = read_arshad_files(tmp_path, {"TrainConsist.csv": consist}, "Start position = 4690 ft\n")
    chained = advanced(loaded.scenario, 0.01)
    weight = chained.chain.vehicles["weight_n"]
    middle_ft = 4690 - (chained.chain.vehicles["behind_m"] + 0.05 * np.arange(6)) / FT
    expected = np.where((middle_ft > 4600) & (middle_ft < 4700), 0.04, 0.0) * weight
    assert expected[0] > 0.0
    assert expected[5] == 0.0
    assert chained.movers["grade_n"] == pytest.approx(expected)


def test_the_consist_is_the_documented_fill():
    with (FOLDER / "TrainConsist.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["Type"], row["Number"], row["Tare Weight (t)"]) for row in rows] == [
        ("Locomotive", "1", "110"),
        ("Car", "5", "25"),
    ]

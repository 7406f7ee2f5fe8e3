"""Figures of theoretical journeys for reference cases."""

import numpy as np
import pytest
from train_study import write_train_study

from tractionpower.errors import InputError, UsageError
from tractionpower.io.documents import read_document
from tractionpower.io.scenario_files import load
from tractionpower.model.timetable import Timetable
from tractionpower.movement.journey import theoretical_journeys
from tractionpower.studies.validation import CASE_FILE, Case, find_cases, run_case
from tractionpower.studies.validation_journeys import journey_figures

MOTION = [folder for folder in find_cases() if folder.name.startswith("motion-")]

CASE = """format: 1
title: Six kilometres
source: none
checks:
  - title: one
    forms: [speed]
    voltage_v: 2500
    tolerance: 0.2
    expect: {journeys.11.at_B_s: 0, journeys.11.FIGURE: 5500}
"""


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    return load(write_train_study(tmp_path_factory.mktemp("six")))


@pytest.fixture(scope="module")
def figures(scenario):
    found, status = journey_figures(scenario, None, "time")
    assert status == "complete"
    return found


def test_arrivals_count_from_the_start_of_the_run(scenario, figures):
    (journey,) = theoretical_journeys(scenario, runs=["11"])
    arrivals = {call.station: call.arrival_s for call in journey.calls}
    assert figures["journeys.11.at_B_s"] == arrivals["B"] - 6 * 3600.0
    assert figures["journeys.11.at_P_s"] == arrivals["P"] - 6 * 3600.0
    # At 100 km/h at most and with 0.6 m/s2 2.5 km take longer than this, and not twice as long.
    fastest = 2500.0 / (100.0 / 3.6) + 0.5 * (100.0 / 3.6) / 0.6
    assert fastest < figures["journeys.11.at_B_s"] < 2.0 * fastest


def test_what_the_line_gives_is_what_the_train_uses(figures):
    parts = ("wheel_kwh", "drive_loss_kwh", "starting_resistor_kwh", "auxiliary_kwh", "braking_resistor_kwh")
    used = sum(figures[f"journeys.11.{name}"] for name in parts)
    assert figures["journeys.11.wheel_kwh"] == pytest.approx(0.85 * (used - figures["journeys.11.auxiliary_kwh"]), rel=1e-9)
    # Auxiliaries of 50 kW are fed by the electric brake where it brakes, so the line gives a little less than all.
    taken = figures["journeys.11.energy_taken_kwh"]
    assert used - figures["journeys.11.auxiliary_kwh"] < taken < used


def test_distance_effort_and_speeds(figures):
    assert figures["journeys.11.distance_m"] == pytest.approx(5500.0, abs=1e-6)
    assert figures["journeys.11.greatest_effort_kn"] == pytest.approx(100.0, rel=1e-9)
    assert figures["journeys.11.end_speed_kmh"] == 0.0
    assert figures["journeys.EC 2/1.end_speed_kmh"] == pytest.approx(100.0, rel=1e-6)
    assert figures["journeys.11.starting_resistor_share"] == 0.0


def test_times_between_calls_and_speeds_at_passings(scenario, figures):
    parts = [figures[f"journeys.11.from_{name}_s"] for name in ("A_to_B", "B_to_P", "P_to_C")]
    assert sum(parts) == pytest.approx(figures["journeys.11.at_C_s"])
    assert min(parts) > 0.0
    (journey,) = theoretical_journeys(scenario, runs=["11"])
    by_place = np.interp(3500.0, journey.rows["s_m"], journey.rows["v_mps"]) * 3.6
    assert figures["journeys.11.speed_at_P_kmh"] == pytest.approx(by_place, abs=0.1)
    assert "journeys.11.speed_at_B_kmh" not in figures


def test_net_energy_is_what_is_taken_less_what_is_returned(figures):
    taken, returned = (figures[f"journeys.11.energy_{kind}_kwh"] for kind in ("taken", "returned"))
    assert returned > 0.1
    assert figures["journeys.11.net_energy_kwh"] == taken - returned


def test_a_tolerance_may_be_a_share(tmp_path):
    write_train_study(tmp_path)
    check = "  - {title: TITLE, forms: [time], tolerance_percent: SHARE, expect: {journeys.11.distance_m: 5460}}\n"
    checks = check.replace("TITLE", "wide").replace("SHARE", "1") + check.replace("TITLE", "narrow").replace("SHARE", "0.5")
    (tmp_path / CASE_FILE).write_text(f"format: 1\ntitle: shares\nsource: none\nchecks:\n{checks}", encoding="utf-8")
    met = {finding.check: finding.met for finding in run_case(tmp_path) if finding.figure.endswith("distance_m")}
    assert met == {"wide": True, "narrow": False}


def test_a_lower_voltage_makes_the_train_later(scenario, figures):
    late, _ = journey_figures(scenario, 2200.0, "time")
    assert late["journeys.11.at_B_s"] > figures["journeys.11.at_B_s"] + 1.0


def test_a_train_that_is_stuck_flags_the_case(scenario):
    found, status = journey_figures(scenario, 2000.0, "time")  # U_min2: no traction
    assert status == "flagged"
    assert found["journeys.11.distance_m"] == 0.0
    assert "journeys.11.at_B_s" not in found


def test_a_study_without_trains_is_told(scenario):
    with pytest.raises(UsageError, match="no trains"):
        journey_figures(scenario.model_copy(update={"timetable": Timetable()}), None, "time")


@pytest.mark.parametrize(("figure", "met"), [("distance_m", True), ("greatest_effort_kn", False)])
def test_a_check_names_form_and_voltage(tmp_path, figure, met):
    folder = write_train_study(tmp_path)
    (folder / CASE_FILE).write_text(CASE.replace("FIGURE", figure), encoding="utf-8")
    status, arrival, other = run_case(folder)
    assert [finding.form for finding in (status, arrival, other)] == ["speed"] * 3
    low, _ = journey_figures(load(folder), 2500.0, "speed")
    assert arrival.computed == low["journeys.11.at_B_s"]
    assert (status.met, arrival.met, other.met) == (True, False, met)


def test_an_unknown_figure_is_told(tmp_path):
    folder = write_train_study(tmp_path)
    (folder / CASE_FILE).write_text(CASE.replace("FIGURE", "run_time"), encoding="utf-8")
    with pytest.raises(InputError, match=r"journeys\.11\.run_time"):
        list(run_case(folder))


@pytest.mark.parametrize("folder", MOTION, ids=lambda folder: folder.name)
def test_motion_is_validated_in_both_forms(folder):
    assert all(check.forms == ("time", "speed") for check in read_document(folder / CASE_FILE, Case).checks)


def test_there_are_cases_of_motion():
    assert len(MOTION) >= 6

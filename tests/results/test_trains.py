"""Trains in tables and key figures: units, names, and what is empty."""

import numpy as np
import pytest

from tractionpower.kernels.train_tables import BY_ADHESION, COASTING, LIMITED_BY, PHASES, TRAIN_ROW
from tractionpower.results.columns import TABLES
from tractionpower.results.trains import CallRow, calls_table, sum_up, train_figures, trains_table

CONTRACT = {
    "trains": (
        "time_s train track position_km distance_m speed_kmh acceleration_mps2 phase tractive_force_kn electric_brake_force_kn"
        " friction_brake_force_kn resistance_kn wished_force_kn limited_by voltage_v current_a power_kw auxiliary_power_kw"
        " starting_resistor_kw braking_resistor_kw refused_regeneration_kw"
    ),
    "calls": "train station kind planned_s actual_s dwell_s late_s",
}


@pytest.fixture
def rows():
    """Return two rows in which every field holds another number."""
    made = np.zeros(2, TRAIN_ROW)
    for number, name in enumerate(TRAIN_ROW.names, start=1):
        if TRAIN_ROW[name].kind == "f":
            made[name] = [1000.0 * number, -250.0 * number]
    made["time_s"] = [25.0, 25.5]
    made["phase"], made["limited_by"] = COASTING, BY_ADHESION
    return made


@pytest.mark.parametrize("table", CONTRACT)
def test_columns_of_the_contract_come_first_and_in_its_order(table):
    names = CONTRACT[table].split()
    assert [column.name for column in TABLES[table]][: len(names)] == names


def test_si_becomes_the_units_of_the_table(rows):
    first, second = trains_table(rows, ([0, 0], ["7"]), ([1, 0], ["1", "2"]), np.array([1.5, 1.25])).to_pylist()
    assert (first["time_s"], second["time_s"]) == (25.0, 25.5)
    assert (first["train"], first["track"], second["track"]) == ("7", "2", "1")
    assert (first["position_km"], second["position_km"]) == (1.5, 1.25)
    assert (first["phase"], first["limited_by"]) == ("coasting", "adhesion")
    assert first["distance_m"] == rows["s_m"][0]
    assert first["speed_kmh"] == pytest.approx(rows["v_mps"][0] * 3600 / 1000)
    assert second["speed_kmh"] == pytest.approx(rows["v_mps"][1] * 3600 / 1000)
    assert [first[name] for name in ("acceleration_mps2", "voltage_v", "current_a")] == [
        rows[name][0] for name in ("acceleration_mps2", "voltage_v", "current_a")
    ]
    kilo = {
        "tractive_force_kn": "traction_n",
        "electric_brake_force_kn": "electric_brake_n",
        "friction_brake_force_kn": "friction_brake_n",
        "resistance_kn": "resistance_n",
        "wished_force_kn": "wished_n",
        "power_kw": "power_w",
        "auxiliary_power_kw": "auxiliary_w",
        "starting_resistor_kw": "starting_resistor_w",
        "braking_resistor_kw": "braking_resistor_w",
        "refused_regeneration_kw": "refused_w",
        "drive_loss_kw": "drive_loss_w",
        "wheel_power_kw": "wheel_w",
        "returned_kw": "returned_w",
    }
    for column, field in kilo.items():
        assert [first[column], second[column]] == (rows[field] / 1000.0).tolist(), column
    assert len(first) == len(TABLES["trains"]) == len(kilo) + 12


def test_the_rail_potential_is_empty_where_no_earth_is_defined(rows):
    place = (([0, 0], ["7"]), ([1, 0], ["1", "2"]), np.array([1.5, 1.25]))
    for given, expected in ((None, [None, None]), (np.array([4.5, np.nan]), [4.5, None])):
        assert [row["rail_potential_v"] for row in trains_table(rows, *place, given).to_pylist()] == expected


def test_every_code_has_its_name_in_the_contract(rows):
    phases = "accelerating cruising coasting braking dwelling waiting holding unpowered".split()
    limits = "nothing speed adhesion drive line_current train_current voltage power_off standstill_current".split()
    assert (list(PHASES), list(LIMITED_BY)) == (phases, limits)
    many = np.repeat(rows[:1], 9)
    many["phase"], many["limited_by"] = np.arange(9) % 8, np.arange(9)
    found = trains_table(many, ([0] * 9, ["7"]), ([0] * 9, ["1"]), np.zeros(9)).to_pylist()
    assert [row["phase"] for row in found][:8] == phases
    assert [row["limited_by"] for row in found] == limits


def test_calls_say_how_late_a_train_is_and_leave_empty_what_is_not_known():
    calls = [
        CallRow("7", "B", "arrival", 600.0, 637.5),
        CallRow("7", "B", "departure", 630.0, 629.0, -8.5),
        CallRow("7", "C", "pass", np.nan, 700.0),
        CallRow("7", "A", "arrival", 900.0),
    ]
    rows = calls_table(calls).to_pylist()
    assert [row["late_s"] for row in rows] == [37.5, -1.0, None, None]
    assert [row["planned_s"] for row in rows] == [600.0, 630.0, None, 900.0]
    assert [row["actual_s"] for row in rows] == [637.5, 629.0, 700.0, None]
    assert [row["dwell_s"] for row in rows] == [None, -8.5, None, None]
    assert [row["station"] for row in rows] == ["B", "B", "C", "A"]
    assert [row["kind"] for row in rows] == ["arrival", "departure", "pass", "arrival"]


def test_no_calls_are_an_empty_table():
    assert calls_table([]).num_rows == 0


def test_key_figures_of_a_journey():
    rows = np.zeros(3, TRAIN_ROW)
    rows["time_s"], rows["v_mps"] = [3600.0, 3601.0, 3603.0], [0.0, 20.0, 10.0]
    rows["power_w"], rows["returned_w"] = [3.6e6, 1.8e6, -7.2e5], [0.0, 0.0, 7.2e5 + 3.6e4]  # takes a little while it returns
    rows["current_a"] = [1000.0, 1200.0, -300.0]
    summary = sum_up("7", rows, np.array([1.0, 2.0, 1.0]), length_m=900.0, journey_s=100.0, running_s=90.0)
    figures = {f.name: f for f in train_figures(summary)}
    assert {f.place for f in figures.values()} == {"train 7"}
    assert figures["length_km"].value == 0.9
    assert (figures["running_time_s"].value, figures["journey_time_s"].value) == (90.0, 100.0)
    assert figures["mean_speed_kmh"].value == pytest.approx(36.0)
    assert (figures["highest_speed_kmh"].value, figures["highest_speed_kmh"].time) == (pytest.approx(72.0), "01:00:01")
    assert figures["energy_taken_kwh"].value == pytest.approx(1.0 + 1.0 + 0.01)
    assert figures["energy_returned_kwh"].value == pytest.approx(0.2 + 0.01)
    assert (figures["highest_current_a"].value, figures["highest_current_a"].time) == (1200.0, "01:00:01")
    assert figures["energy_taken_kwh"].as_dict()["unit"] == "kWh"


def test_a_train_that_did_not_move_has_no_mean_speed():
    figures = train_figures(sum_up("7", np.zeros(1, TRAIN_ROW), np.ones(1), length_m=0.0, journey_s=60.0, running_s=0.0))
    assert {f.name: f.value for f in figures}["mean_speed_kmh"] == 0.0

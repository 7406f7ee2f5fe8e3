"""Tables of a train as many vehicles: units, signs, shares that add up to 1."""

import numpy as np
import pytest
from fake_dynamics import INERTIAS, fake_bins, fake_names, fake_results, fake_run, fake_state

from tractionpower.kernels.chain_state import CHAIN_ROW, LINK, LINK_ROW, VEHICLE_ROW
from tractionpower.results.dynamics_columns import DYNAMICS_TABLES
from tractionpower.results.dynamics_tables import (
    bin_ends,
    controls_table,
    coupling_extremes_table,
    couplings_table,
    distributions_table,
    kinetic_j,
    rainflow_table,
    vehicles_table,
)

OF_VEHICLES = ("vehicles", "couplings", "controls", "coupling_extremes", "distributions", "rainflow")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("dynamics") / "fake")


def test_si_becomes_the_units_of_the_names():
    row = np.array([[(100.0, 10.0, -0.5, 20e3, 3e3, 4e3, 5e3, -6e3, 2.5e5)]], VEHICLE_ROW)
    (told,) = vehicles_table(np.array([2.0]), ["1 loco"], row, np.array([90.0])).to_pylist()
    assert told == pytest.approx(
        {
            "time_s": 2.0, "vehicle": "1 loco", "position_m": 100.0, "speed_kmh": 36.0, "acceleration_mps2": -0.5,
            "relative_position_m": 0.0, "tractive_force_kn": 20.0, "electric_brake_force_kn": 3.0, "brake_force_kn": 4.0,
            "resistance_kn": 5.0, "grade_force_kn": -6.0, "cylinder_pressure_bar": 2.5,
        }
    )  # fmt: skip
    (link,) = couplings_table(np.array([2.0]), ["1-2"], np.array([[(-3e4, 0.012, -0.1)]], LINK_ROW)).to_pylist()
    assert link == pytest.approx({"time_s": 2.0, "coupling": "1-2", "force_kn": -30.0, "deflection_mm": 12.0, "rate_mps": -0.1})
    works = [3.6e6, 7.2e6, 1.08e7, 1.44e7, 1.8e7, 2.16e7]
    (control,) = controls_table(np.array([(2.0, 3, 4, 0.25, 1e5, 5e4, *works)], CHAIN_ROW), np.array([3.6e5])).to_pylist()
    assert control == pytest.approx(
        {
            "time_s": 2.0, "drive": 3, "brake": 4, "electric_percent": 25.0, "independent_bar": 1.0, "reduction_bar": 0.5,
            "traction_kwh": 1.0, "electric_kwh": 2.0, "brake_kwh": 3.0, "resistance_kwh": 4.0, "gravity_kwh": 5.0,
            "coupling_kwh": 6.0, "kinetic_kwh": 0.1,
        }
    )  # fmt: skip


def test_relative_position_is_the_way_against_the_first_vehicle():
    rows = np.zeros((1, 3), VEHICLE_ROW)
    rows["s_m"] = [[50.0, 34.8, 20.1]]
    told = vehicles_table(np.array([0.0]), ["1", "2", "3"], rows, np.array([0.0, -15.0, -30.0]))["relative_position_m"]
    assert told.to_pylist() == pytest.approx([0.0, -0.2, 0.1])


def test_extremes_tell_what_never_was():
    links = np.zeros(2, LINK)
    links["greatest_n"], links["greatest_at_s"] = [5e4, -1e3], [3.0, 4.0]  # the second is preloaded: never in tension
    links["least_n"], links["least_at_s"] = [0.0, -7e4], [0.0, 6.0]
    one, other = coupling_extremes_table(["1-2", "2-3"], links, np.array([1.0, 0.5])).to_pylist()
    assert (one["greatest_tension_kn"], one["tension_at_s"]) == (50.0, 3.0)
    assert (one["greatest_compression_kn"], one["compression_at_s"]) == (0.0, None)
    assert (other["greatest_tension_kn"], other["tension_at_s"]) == (0.0, None)
    assert (other["greatest_compression_kn"], other["compression_at_s"]) == (70.0, 6.0)
    assert coupling_extremes_table(["1-2", "2-3"], links).column("damage").null_count == 2


def test_bins_are_open_at_both_ends():
    lowest, highest = bin_ends(fake_bins()[2])
    assert len(lowest) == len(highest) == 42
    assert np.isnan(lowest[0]) and np.isnan(highest[-1])
    assert highest[0] == pytest.approx(-2.0) and lowest[-1] == pytest.approx(2.0)
    assert lowest[1:] == pytest.approx(highest[:-1])


def test_frequencies_of_each_distribution_add_up_to_one(results):
    sums = results.table("distributions").groupby("of", observed=True)["frequency"].sum()
    assert sums.to_dict() == pytest.approx(
        dict.fromkeys(("drive_speed", "brake_speed", "coupler_force", "acceleration"), 1.0), abs=1e-12
    )


def test_a_distribution_is_what_a_histogram_of_the_rows_is(results):
    made, rows = fake_run(), results.table("distributions")
    rows = rows[rows["of"] == "drive_speed"]
    level = rows[rows["level"] == 15]
    driven = made.chain["drive"] == 15
    counted, _ = np.histogram(made.vehicles["v_mps"][driven, 0], level["lowest"].to_numpy()[1:] / 3.6)
    share = counted / len(made.chain)
    assert level["frequency"].to_numpy()[1:-1] == pytest.approx(share, abs=2.0 / len(made.chain))
    assert level["frequency"].sum() == pytest.approx(driven.mean(), abs=2.0 / len(made.chain))


def test_what_took_no_time_has_no_distribution():
    state = fake_state()
    state.force[3] = 2.0
    times = {
        "drive_speed": state.drive_speed, "brake_speed": state.brake_speed,
        "coupler_force": state.force, "acceleration": state.acceleration,
    }  # fmt: skip
    told = distributions_table(times, fake_bins()).to_pandas()
    assert set(told["of"]) == {"coupler_force"}
    assert told["level"].isna().all()
    (bin_,) = told[told["frequency"] > 0].to_dict("records")
    assert (bin_["lowest"], bin_["highest"], bin_["frequency"]) == (-260.0, -240.0, 1.0)
    times = {name: np.zeros_like(array) for name, array in times.items()}
    assert distributions_table(times, fake_bins()).num_rows == 0


def test_cycles_stand_by_coupling_the_greatest_first():
    told = rainflow_table(["1-2", "2-3"], [{(5.0, 0.0): 1.0, (20.0, -25.0): 0.5}, {}]).to_pylist()
    assert [(row["coupling"], row["range_kn"], row["mean_kn"], row["cycles"]) for row in told] == [
        ("1-2", 20.0, -25.0, 0.5),
        ("1-2", 5.0, 0.0, 1.0),
    ]
    assert rainflow_table(["1-2"], [{}]).num_rows == 0


def test_tables_are_those_that_are_declared(results):
    assert set(results.tables) == set(OF_VEHICLES)
    for name in results.tables:
        assert results.schema(name).names == [column.name for column in DYNAMICS_TABLES[name]]
        assert results.row_count(name) > 0


def test_kinetic_energy_is_that_of_the_rows(results):
    made, told = fake_run(), results.table("controls")["kinetic_kwh"].to_numpy()
    by_hand = [sum(0.5 * m * v**2 for m, v in zip(INERTIAS, row, strict=True)) / 3.6e6 for row in made.vehicles["v_mps"]]
    assert told == pytest.approx(by_hand, rel=1e-12)
    assert kinetic_j(np.array([2.0]), np.array([10.0])) == pytest.approx(20.0)


def test_names_tell_place_and_kind(results):
    vehicles, couplings = fake_names()
    assert list(results.table("vehicles")["vehicle"].unique()) == vehicles
    assert list(results.table("couplings")["coupling"].unique()) == couplings

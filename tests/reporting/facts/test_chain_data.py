"""Tables of train dynamics as arrays, in the order of the train whatever the order of the rows."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from fake_dynamics import fake_results, fake_scenario

from tractionpower.reporting.facts.chain_data import ChainData, from_the_front
from tractionpower.reporting.facts.chain_energy import energies_of
from tractionpower.reporting.facts.chain_stops import stops_of
from tractionpower.reporting.facts.measures import measures
from tractionpower.reporting.facts.spread import joint_of, rows_of
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return ChainData(fake_results(tmp_path_factory.mktemp("chain")), fake_scenario())


def test_rows_in_any_order_become_the_same_arrays(data):
    rows = data.results.table("vehicles").sample(frac=1.0, random_state=1)
    mixed = Results({}, [], {"vehicles": pa.Table.from_pandas(rows, preserve_index=False)})
    other = ChainData(mixed, data.scenario)
    assert other.vehicles == data.vehicles == [f"{k} {part.id}" for k, part in enumerate(data.scenario.parts, 1)]
    np.testing.assert_array_equal(other.of_vehicles("speed_kmh"), data.of_vehicles("speed_kmh"))
    last = data.results.table("vehicles").query("vehicle == @data.vehicles[-1]")
    np.testing.assert_array_equal(data.of_vehicles("speed_kmh")[:, -1], last["speed_kmh"].to_numpy(float))
    np.testing.assert_array_equal(data.times, last["time_s"])


def test_ten_comes_after_nine():
    assert from_the_front(["10-11", "9-10", "1-2"]) == ["1-2", "9-10", "10-11"]


def test_the_most_loaded_coupling_is_that_of_the_extremes(data):
    force = np.maximum(data.greatest("tension"), data.greatest("compression"))
    assert force[data.most_loaded] == force.max()
    assert data.endurable("compression").tolist() == [60.0] * 5
    assert data.chosen_vehicles() == [0, 3, 5]
    assert set(data.chosen_couplings()) == {0, data.most_loaded, 4}


def test_a_stop_is_as_far_as_the_speed_says(data):
    (stop,) = stops_of(data.results)
    rows = (data.times >= stop.from_s) & (data.times <= stop.to_s)
    by_speed = np.trapezoid(data.of_vehicles("speed_kmh")[rows, 0] / 3.6, data.times[rows])
    assert stop.distance_m == pytest.approx(by_speed, rel=1e-3)
    assert stop.deceleration_mps2 == pytest.approx((stop.speed_kmh / 3.6) ** 2 / (2.0 * stop.distance_m))
    assert stops_of(Results({"stops": [{"braked_at_s": None}]}, [], {})) == []


def test_energies_add_up_at_all_times(data):
    parts = energies_of(data).parts
    spent = sum(values for name, values in parts.items() if name != "traction")
    np.testing.assert_allclose(parts["traction"], spent, atol=1e-6 * parts["traction"].max())


def test_imperial_units_are_those_of_handbooks():
    units = measures("imperial")
    known = {"speed": 0.6213712, "effort": 224.80894, "distance": 3.2808399, "pressure": 14.503774, "deflection": 1 / 25.4}
    for name, factor in known.items():
        assert units[name].per == pytest.approx(factor, rel=1e-7)
    assert units["force"].per == pytest.approx(units["effort"].per / 1000.0)
    assert units["acceleration"].per == pytest.approx(2.2369363, rel=1e-7)


def test_a_joint_distribution_is_all_the_time(data):
    joint = joint_of(data, "drive_speed")
    assert np.nansum(joint.share) == pytest.approx(1.0)
    assert len(joint.edges) == joint.share.shape[1] + 1
    assert np.diff(joint.edges) == pytest.approx(3.6)
    rows = data.table("distributions")
    at_rest = rows[(rows["of"] == "drive_speed") & (rows["level"] == 0.0) & (rows["lowest"] == 0.0)]["frequency"].sum()
    assert joint.share[0, 0] == at_rest > 0.0


def test_open_ends_are_closed_by_the_width_of_their_neighbours():
    names = ("of", "level", "lowest", "highest", "frequency")
    bins = [("acceleration", np.nan, np.nan, -1.0, 0.25), ("acceleration", np.nan, -1.0, 1.0, 0.5),
            ("acceleration", np.nan, 1.0, np.nan, 0.25)]  # fmt: skip
    table = pa.Table.from_pandas(pd.DataFrame(bins, columns=names), preserve_index=False)
    rows = rows_of(ChainData(Results({}, [], {"distributions": table}), fake_scenario()), "acceleration")
    assert rows[["begin", "end"]].to_numpy().tolist() == [[-3.0, -1.0], [-1.0, 1.0], [1.0, 3.0]]

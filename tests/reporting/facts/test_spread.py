"""Distributions of train dynamics: shares of the whole time, in classes that suit the range and the units of a case."""

import numpy as np
import pytest
from fake_dynamics import fake_results, fake_scenario

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.spread import histogram_of, joint_of, nice_edges


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("chain"))


@pytest.fixture(scope="module")
def data(results):
    return ChainData(results, fake_scenario())


@pytest.fixture(scope="module")
def imperial(results):
    return ChainData(results, fake_scenario(units="imperial"))


@pytest.mark.parametrize(("low", "high"), [(-3.1, 9.6), (0.0, 1e-3), (5.0, 5.0), (-820.0, 12.0), (0.0, 100.0)])
def test_edges_are_round_and_hold_the_range(low, high):
    edges = nice_edges(low, high, 20)
    step = edges[1] - edges[0]
    assert edges[0] <= low + 1e-9
    assert edges[-1] >= high - 1e-9
    assert np.diff(edges) == pytest.approx(step)
    assert len(edges) <= 24
    mantissa = step / 10.0 ** np.floor(np.log10(step) + 1e-9)
    assert min(abs(mantissa - each) for each in (1.0, 2.0, 2.5, 5.0)) < 1e-6


def test_in_other_units_rows_are_counted_in_round_classes_of_the_case(data, imperial):
    found = histogram_of(imperial, "coupler_force")
    assert found.of_rows
    assert found.share.sum() == pytest.approx(1.0)
    force = data.of_couplings("force_kn")[:-1, 0] / 4.4482216152605
    assert found.edges[0] <= force.min() < found.edges[1]
    assert found.edges[-2] <= force.max() <= found.edges[-1]
    assert 8 <= len(found.share) <= 24
    middle = len(found.share) // 2
    inside = (force >= found.edges[middle]) & (force < found.edges[middle + 1])
    assert found.share[middle] == pytest.approx((np.diff(data.times) * inside).sum() / (data.times[-1] - data.times[0]))


def test_levels_without_any_time_have_no_row(data, imperial):
    for one in (data, imperial):
        joint = joint_of(one, "brake_speed")
        used = sorted({int(level) for level in data.control("brake")[:-1]})
        assert joint.levels == used
        assert len(used) < max(used) + 1
        assert np.nansum(joint.share) == pytest.approx(1.0, abs=1e-4)
    assert joint.edges == pytest.approx(np.round(joint.edges, 3))

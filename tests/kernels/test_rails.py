"""Sums of rail potentials against array operations, however the rows come in."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import CUTS, SEEDS, pieces

from tractionpower.kernels.rails import add_rails, new_rail_sums


@settings(deadline=None, derandomize=True, max_examples=50)
@given(seed=SEEDS, rows=st.integers(1, 40), places=st.integers(1, 5), cuts=CUTS)
def test_sums_are_those_of_all_steps(seed, rows, places, cuts):
    rng = np.random.default_rng(seed)
    volts, time_s = np.round(rng.normal(0.0, 50.0, (rows, places))), 100.0 + np.arange(rows)
    volts[rng.random((rows, places)) < 0.1] = np.nan
    sums, whole = new_rail_sums(places), new_rail_sums(places)
    for piece in pieces(rows, cuts):
        add_rails(sums, time_s[piece], volts[piece])
    add_rails(whole, time_s, volts)
    assert sums.tobytes() == whole.tobytes()
    for k in range(places):
        known = np.isfinite(volts[:, k])
        own, when = volts[known, k], time_s[known]
        assert sums["count"][k] == len(own)
        assert sums["sum_v"][k] == pytest.approx(own.sum(), abs=1e-9)
        assert sums["positive_v"][k] == pytest.approx(own[own > 0.0].sum(), abs=1e-9)
        if len(own):
            assert (sums["lowest_v"][k], sums["lowest_s"][k]) == (own.min(), when[own.argmin()])
            assert (sums["highest_v"][k], sums["highest_s"][k]) == (own.max(), when[own.argmax()])
        else:
            assert np.isnan([sums["lowest_s"][k], sums["highest_s"][k]]).all()


@pytest.mark.interpreted
def test_a_single_step():
    sums = new_rail_sums(2)
    add_rails(sums, np.array([5.0]), np.array([[-3.0, np.nan]]))
    assert sums["lowest_v"].tolist() == [-3.0, np.inf]
    assert sums["positive_v"].tolist() == [0.0, 0.0]
    assert sums["count"].tolist() == [1, 0]

"""The electric ledger against brute force, and ledgers that do not close."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.kernels.block_tables import STEP_RESULT
from tractionpower.results.ledgers import ElectricLedger

SEEDS = st.integers(0, 2**32)
CUTS = st.lists(st.integers(0, 40), max_size=6)


def pieces(rows, cuts):
    bounds = [0, *sorted(min(cut, rows) for cut in cuts), rows]
    return list(itertools.pairwise(bounds))


def random_steps(rng, rows):
    steps = np.zeros(rows, STEP_RESULT)
    for name in ("regulation_w", "load_w", "conductor_w"):
        steps[name] = rng.normal(0.0, 1e6, rows)
    steps["source_w"] = steps["regulation_w"] + steps["load_w"] + steps["conductor_w"]
    steps["gross_w"] = abs(steps["source_w"]) + abs(steps["load_w"])
    return steps


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, rows=st.integers(1, 40), cuts=CUTS, step_s=st.sampled_from([0.02, 0.5, 1.0]))
def test_the_ledger(seed, rows, cuts, step_s):
    steps = random_steps(np.random.default_rng(seed), rows)
    ledger, whole = ElectricLedger(), ElectricLedger()
    for first, end in pieces(rows, cuts):
        ledger.add(steps[first:end], step_s)
    whole.add(steps, step_s)
    assert ledger.closes
    assert ledger.as_dict() == whole.as_dict()
    for name in ElectricLedger.NAMES:
        expected = steps[f"{name}_w"].sum() * step_s
        assert ledger.energy_j[name] == pytest.approx(expected, rel=1e-9, abs=1e-3)
        assert ledger.as_dict()[f"{name}_kwh"] == pytest.approx(expected / 3.6e6, rel=1e-9, abs=1e-9)


@settings(deadline=None, derandomize=True)
@given(seed=SEEDS, which=st.integers(0, 9), gap_w=st.sampled_from([1.0, -1.0, 1e3, np.nan]))
def test_a_step_that_does_not_close_is_seen(seed, which, gap_w):
    steps = random_steps(np.random.default_rng(seed), 10)
    steps["source_w"][which] += gap_w
    ledger = ElectricLedger()
    ledger.add(steps, 1.0)
    assert not ledger.closes
    if np.isfinite(gap_w):
        assert ledger.worst_gap_w == pytest.approx(abs(gap_w), rel=1e-6)

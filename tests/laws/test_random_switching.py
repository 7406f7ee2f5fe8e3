"""Supplies that switch while trains run, with leaky rails: every step is solved, ledgers close, blocks may end anywhere."""

from collections import Counter

import numpy as np
import pytest
from random_switching import random_switching

from tractionpower.cosimulation import run as run_module
from tractionpower.cosimulation.check import check_scenario
from tractionpower.results.store import MemoryWriter

SEEDS = [seed for seed in range(45) if not any(p.severity == "error" for p in check_scenario(random_switching(seed)))]


@pytest.fixture(scope="module")
def runs():
    made = {}

    def run_of(seed):
        if seed not in made:
            writer = MemoryWriter()
            made[seed] = run_module.Run(random_switching(seed), writer).execute(), writer.tables()
        return made[seed]

    return run_of


def test_the_seeds_are_a_wide_field(runs):
    seen = Counter()
    for seed in SEEDS:
        _, tables = runs(seed)
        seen.update(set(tables["events"].to_pandas().kind))
    assert len(SEEDS) >= 30
    for kind in ("switched", "tripped", "vld_closed", "line_dead", "line_live", "voltage_lost", "voltage_back"):
        assert seen[kind] >= 3, seen


@pytest.mark.parametrize("seed", SEEDS)
def test_every_step_is_solved_and_all_ledgers_close(runs, seed):
    outcome, tables = runs(seed)
    assert outcome.run["flagged_steps"] == 0
    assert outcome.run["ledgers"]["electric"]["closes"]
    assert outcome.run["ledgers"]["pantograph_to_wheel"]["worst_gap_share"] < 1e-6
    assert outcome.run["ledgers"]["mechanical"]["worst_gap_share"] < 5e-3
    stations, feeders = tables["substations"].to_pandas(), tables["feeders"].to_pandas()
    fed = feeders[feeders.side != "return"].groupby(["time_s", "substation"], observed=True).current_a.sum()
    rows = stations[stations.voltage_v.notna()].set_index(["time_s", "substation"])
    gap = rows.current_a - fed.reindex(rows.index).fillna(0.0)
    assert np.abs(gap).max() < 1e-3 * max(1.0, rows.current_a.abs().max() * 1e-3)  # currents in single precision


@pytest.mark.parametrize("seed", SEEDS[::4])
def test_blocks_may_end_anywhere(runs, seed, monkeypatch):
    _, whole = runs(seed)
    monkeypatch.setattr(run_module, "BLOCK_S", 0.0)
    monkeypatch.setattr(run_module, "FIRST_BLOCK", 7)
    writer = MemoryWriter()
    run_module.Run(random_switching(seed), writer).execute()
    cut = writer.tables()
    assert cut.keys() == whole.keys()
    for name, table in whole.items():
        assert cut[name].equals(table), name

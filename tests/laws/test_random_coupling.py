"""Random trains on random lines and supplies: every step is solved, all ledgers close, blocks may end anywhere."""

from functools import cache

import numpy as np
import pytest
from coupled import advanced
from random_coupling import STEPS, RandomCoupling

from tractionpower.cosimulation.check import check_scenario
from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import DONE, new_buffers
from tractionpower.kernels.network import CONVERGED
from tractionpower.results.store import MemoryWriter

SEEDS = range(60)
U_MAX2, HIGHEST_NO_LOAD = 3900.0, 3600.0
MECHANICAL = {0.25: 1e-3, 1.0: 1e-3, 2.0: 1e-3, 5.0: 5e-3}
"""Share within which the mechanical ledger closes, by the step [s]: its error falls with the square of the step."""


@cache
def run_of(seed):
    """Return the scenario of a seed, what the block has computed of it and what the run says."""
    scenario = RandomCoupling(seed).scenario
    assert [problem for problem in check_scenario(scenario) if problem.severity == "error"] == []
    made = Run(scenario, MemoryWriter())
    outcome = made.execute()
    return scenario, advanced(scenario, STEPS), outcome.run


def test_the_seeds_are_a_wide_field():
    kinds, phases, limits, statuses = set(), set(), set(), set()
    lowest, highest, fed_back, dead = np.inf, 0.0, 0.0, 0
    for seed in SEEDS:
        scenario, done, said = run_of(seed)
        kinds |= {vehicle.drive.kind for vehicle in scenario.vehicles}
        phases |= set(done.trains["phase"].tolist())
        limits |= set(done.trains["limited_by"].tolist())
        statuses |= {each["status"] for each in said["trains"]}
        lowest, highest = min(lowest, done.trains["voltage_v"].min()), max(highest, done.trains["voltage_v"].max())
        fed_back = min(fed_back, done.trains["current_a"].min())
        dead += bool((done.trains["voltage_v"] == 0.0).any())
    assert kinds == {"inverter", "series_motors", "table"}
    assert phases >= {0, 1, 2, 3, 4}
    assert limits >= {0, 1, 3, 4, 5, 6, 7, 8}
    assert dead > 3
    assert statuses >= {"left", "stays", "on_line"}
    assert lowest < 2000.0
    assert highest > 3800.0
    assert fed_back < -100.0


@pytest.mark.parametrize("seed", SEEDS)
def test_every_step_is_solved_and_its_ledger_closes(seed):
    _, done, said = run_of(seed)
    steps = done.buffers.steps
    assert (steps["status"] == CONVERGED).all()
    assert said["flagged_steps"] == 0
    assert steps["worst_a"].max() < 1e-3
    gap = np.abs(steps["source_w"] - steps["regulation_w"] - steps["train_w"] - steps["load_w"] - steps["conductor_w"])
    assert (gap <= 1e-9 * steps["gross_w"] + 1e-3).all()
    fed = done.buffers.source_a.sum(axis=1) - done.buffers.load_a.sum(axis=1)
    taken = np.zeros(len(steps))
    np.add.at(taken, np.repeat(np.arange(len(steps)), steps["trains"]), done.trains["current_a"])
    np.testing.assert_allclose(fed, taken, rtol=1e-9, atol=1e-3)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_ledgers_of_every_train_close(seed):
    scenario, _, said = run_of(seed)
    ledgers = said["ledgers"]
    assert ledgers["electric"]["closes"]
    assert ledgers["mechanical"]["worst_gap_share"] < MECHANICAL[scenario.clock.step_s]
    assert ledgers["pantograph_to_wheel"]["worst_gap_share"] < 1e-6


@pytest.mark.parametrize("seed", SEEDS)
def test_voltages_and_rows_are_within_reason(seed):
    scenario, done, _ = run_of(seed)
    rows = done.trains
    for name in set(rows.dtype.names) - {"rail_v"}:  # rails that nothing refers to earth have no potential
        assert np.isfinite(rows[name]).all(), name
    no_load = max(plant.no_load_voltage_v for plant in scenario.supply.substations)
    feeds = [load for load in scenario.supply.loads if (load.power_kw or load.current_a) < 0.0]
    brakes = any(
        vehicle.brake.regenerates is not False and vehicle.drive.kind != "series_motors" for vehicle in scenario.vehicles
    )
    assert rows["voltage_v"].max() <= (max(U_MAX2, no_load) if feeds or brakes else no_load) + 0.1
    dead = rows["voltage_v"] == 0.0
    assert rows["voltage_v"][~dead].min(initial=np.inf) > 0.0
    for name in ("current_a", "auxiliary_w", "traction_n", "returned_w"):
        assert (rows[name][dead] == 0.0).all(), name
    assert (rows["v_mps"] >= 0.0).all()
    assert (rows["moved_m"] >= 0.0).all()
    by_train = rows[np.argsort(rows["train"], kind="stable")]
    brakes = np.append(by_train["brake_w"], 0.0) > 0.0
    pulls = by_train[~(brakes[:-1] | brakes[1:])]  # a wish to brake counts negative, where less power does not come to it, too
    assert (pulls["traction_n"] <= np.maximum(pulls["wished_n"], 0.0) * (1.0 + 1e-9) + 1e-6).all()
    assert (rows["drive_loss_w"] > -1e-3 * np.abs(rows["power_w"]) - 1.0).all()
    for name in ("auxiliary_w", "starting_resistor_w", "braking_resistor_w", "refused_w", "friction_brake_n", "electric_brake_n"):
        assert (rows[name] >= -1e-6).all(), name


@pytest.mark.parametrize("seed", SEEDS)
def test_blocks_may_end_anywhere(seed):
    scenario, whole, _ = run_of(seed)
    compiled = compile_scenario(scenario)
    tables, state, rng = compiled.block, start_state(compiled), np.random.default_rng(seed)
    ends = sorted({*rng.integers(1, STEPS, int(rng.integers(1, 12))).tolist(), STEPS})
    parts, first = [], 0
    for end in ends:
        buffers = new_buffers(tables, end - first)
        assert advance(tables, state, buffers, end) == (end - first, DONE)
        trains = int(buffers.steps["trains"].sum())
        parts.append([array.tobytes() for array in buffers[:-1]] + [buffers.trains[:trains].tobytes()])
        first = end
    joined = [b"".join(part) for part in zip(*parts, strict=True)]
    assert joined == [array.tobytes() for array in whole.buffers[:-1]] + [whole.trains.tobytes()]

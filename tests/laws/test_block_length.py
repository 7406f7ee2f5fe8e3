"""The result of a run depends neither on the length of its blocks nor on where one of them ends."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_studies import load, make_scenario

from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import BUFFER_FULL, DONE, copy_state, new_buffers, new_state
from tractionpower.results.store import MemoryWriter

STEPS = 60

SCENARIO = make_scenario(
    load("always", 4.0, power_kw=2500.0),
    load("late", 13.0, "2", power_kw=4000.0, **{"from": 7.0, "to": 31.0}),
    load("feeds", 9.0, "2", power_kw=-6000.0, **{"from": 20.0, "to": 44.0}),
    load("steady", 18.0, current_a=700.0, **{"from": 30.0}),
    load("too much", 10.0, power_kw=9500.0, limits="none", **{"from": 40.0, "to": 46.0}),
    load("changes", 16.0, "2", power_kw=None, profile=[{"time": 9.0, "power_kw": 500.0}, {"time": 25.0, "power_kw": 3000.0}]),
    clock={"end": float(STEPS)},
    section_cabins=[{"id": "C", "km": 10.0, "state": "bypassed"}],
)


def fresh_tables():
    return compile_scenario(SCENARIO).block


def rows_of(buffers, steps):
    """Return the bytes of the first rows; what was not written is not looked at."""
    return [array[:steps].tobytes() for array in buffers]


def run_in_blocks(ends):
    """Run to each of `ends` in turn and return the bytes of all rows, joined."""
    tables = fresh_tables()
    state = new_state(tables)
    parts = []
    for first, end in pairwise([0, *ends]):
        buffers = new_buffers(tables, STEPS)
        assert advance(tables, state, buffers, end) == (end - first, DONE)
        parts.append(rows_of(buffers, end - first))
    return [b"".join(part) for part in zip(*parts, strict=True)]


@pytest.fixture(scope="module")
def whole():
    return run_in_blocks([STEPS])


def test_the_run_is_no_trivial_one(whole):
    tables = fresh_tables()
    buffers = new_buffers(tables, STEPS)
    advance(tables, new_state(tables), buffers, STEPS)
    assert len(np.unique(buffers.load_v[:, 0])) == 10  # every switch changes the network
    assert set(buffers.steps["status"]) == {0, 2}


@settings(deadline=None, derandomize=True, max_examples=60)
@given(cuts=st.sets(st.integers(1, STEPS - 1)))
def test_blocks_may_end_anywhere(whole, cuts):
    assert run_in_blocks([*sorted(cuts), STEPS]) == whole


def test_blocks_of_one_step(whole):
    assert run_in_blocks(range(1, STEPS + 1)) == whole


@settings(deadline=None, derandomize=True, max_examples=40)
@given(cut=st.integers(0, STEPS - 1), astray=st.integers(1, STEPS))
def test_a_copied_state_resumes_the_run(whole, cut, astray):
    tables = fresh_tables()
    state = new_state(tables)
    before, after = new_buffers(tables, STEPS), new_buffers(tables, STEPS)
    advance(tables, state, before, cut)
    kept = copy_state(state)
    advance(tables, state, new_buffers(tables, STEPS), max(cut, astray))  # goes on and changes the tables
    advance(fresh_tables_at(cut), kept, after, STEPS)
    joined = [a + b for a, b in zip(rows_of(before, cut), rows_of(after, STEPS - cut), strict=True)]
    assert joined == whole


def test_a_copied_state_resumes_the_run_on_tables_that_went_on(whole):
    tables = fresh_tables()
    state, after = new_state(tables), new_buffers(tables, STEPS)
    advance(tables, state, new_buffers(tables, STEPS), 10)
    kept = copy_state(state)
    advance(tables, state, new_buffers(tables, STEPS), 50)
    advance(tables, kept, after, 20)
    widths = [len(rows) // STEPS for rows in whole]
    assert rows_of(after, 10) == [rows[10 * width : 20 * width] for rows, width in zip(whole, widths, strict=True)]


def fresh_tables_at(cut):
    """Return tables as a run leaves them after `cut` steps: what devices have switched is in them."""
    tables = fresh_tables()
    advance(tables, new_state(tables), new_buffers(tables, STEPS), cut)
    return tables


@pytest.mark.parametrize("room", [1, 7, STEPS - 1])
def test_a_full_buffer_ends_the_block_and_says_so(whole, room):
    tables = fresh_tables()
    state, buffers = new_state(tables), new_buffers(tables, room)
    parts, reason = [], BUFFER_FULL
    while reason == BUFFER_FULL:
        steps, reason = advance(tables, state, buffers, STEPS)
        assert steps == room or reason == DONE
        parts.append(rows_of(buffers, steps))
    assert reason == DONE
    assert [b"".join(part) for part in zip(*parts, strict=True)] == whole


def test_a_buffer_that_is_just_large_enough_is_not_full():
    tables = fresh_tables()
    state = new_state(tables)
    assert advance(tables, state, new_buffers(tables, STEPS), STEPS) == (STEPS, DONE)
    assert advance(tables, state, new_buffers(tables, STEPS), STEPS) == (0, DONE)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(cuts=st.sets(st.integers(1, STEPS - 1)))
def test_key_figures_and_events_depend_on_no_block_either(cuts):
    assert summed_up(sorted(cuts)) == summed_up([])


def summed_up(cuts):
    writer = MemoryWriter()
    run = Run(SCENARIO, writer)
    tables = run.compiled.block
    for first, end in pairwise([0, *cuts, STEPS]):
        buffers = new_buffers(tables, STEPS)
        advance(tables, run.state, buffers, end)
        run.recorder.add(first, end - first, buffers, run.compiled.supply)
    run.recorder.close()
    tables = {name: table.to_pandas() for name, table in writer.tables().items()}
    return run.recorder.key_figures(), run.recorder.summary(), {name: table.to_csv() for name, table in tables.items()}

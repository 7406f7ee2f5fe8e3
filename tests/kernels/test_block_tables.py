"""State and buffers of the block: copies are independent, rows of trains belong to the rows of their steps."""

import numpy as np
import pytest
from coupled import MIXED, advanced, couple

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import copy_state, new_buffers, new_state, take_rows

STEPS = 300


def arrays(state):
    """Return all arrays of a state, those of the bundles within it too."""
    found = []
    for item in state:
        found += arrays(item) if isinstance(item, tuple) else [item]
    return found


@pytest.fixture(scope="module")
def done():
    return advanced(couple(*MIXED, end_s=float(STEPS)))


def test_a_copy_shares_no_memory_and_holds_the_same(done):
    copied = copy_state(done.state)
    pairs = list(zip(arrays(done.state), arrays(copied), strict=True))
    assert len(pairs) > 15
    for old, new in pairs:
        assert not np.shares_memory(old, new)
        assert old.dtype == new.dtype
        assert bytes_of(old) == bytes_of(new)


def bytes_of(array):
    """Return the bytes of an array, of records those of their fields: what lies between them means nothing."""
    names = array.dtype.names
    return array.tobytes() if names is None else b"".join(array[name].tobytes() for name in names)


def test_going_on_leaves_a_copy_as_it_was():
    compiled = compile_scenario(couple(*MIXED, end_s=float(STEPS)))
    state = start_state(compiled)
    advance(compiled.block, state, new_buffers(compiled.block, 100), 100)
    copied = copy_state(state)
    before = [bytes_of(array) for array in arrays(copied)]
    advance(compiled.block, state, new_buffers(compiled.block, 100), 200)
    assert [bytes_of(array) for array in arrays(copied)] == before
    assert copied.progress[0]["step"] == 100
    assert state.progress[0]["step"] == 200


def test_a_new_state_has_no_train_on_the_line():
    compiled = compile_scenario(couple(*MIXED))
    state = new_state(compiled.block)
    assert state.progress[0]["active"] == state.progress[0]["entered"] == 0
    assert state.work.in_service[0] == len(compiled.block.network.ports) - 5


@pytest.mark.parametrize(("rows", "train_rows", "room"), [(10, None, 50), (10, 2, 5), (10, 7, 7), (1, 0, 5)])
def test_buffers_have_room_for_every_train_once(rows, train_rows, room):
    compiled = compile_scenario(couple(*MIXED))
    buffers = new_buffers(compiled.block, rows, train_rows)
    assert len(buffers.trains) == room
    assert {len(array) for array in buffers[:-1]} == {rows}


@pytest.mark.parametrize("part", [slice(0, 0), slice(0, 1), slice(20, 140), slice(299, 300), slice(STEPS)])
def test_a_slice_takes_the_trains_of_its_steps(done, part):
    taken = take_rows(done.buffers, part)
    times = np.arange(STEPS, dtype=float)[part]
    expected = done.trains[np.isin(done.trains["time_s"], times)]
    assert taken.trains.tobytes() == expected.tobytes()
    np.testing.assert_array_equal(taken.section_v, done.buffers.section_v[part])


@pytest.mark.parametrize("seed", range(4))
def test_a_choice_takes_the_trains_of_its_steps(done, seed):
    chosen = np.random.default_rng(seed).random(STEPS) < 0.3
    taken = take_rows(done.buffers, chosen)
    expected = done.trains[np.isin(done.trains["time_s"], np.flatnonzero(chosen))]
    assert taken.trains.tobytes() == expected.tobytes()
    assert len(taken.steps) == chosen.sum()

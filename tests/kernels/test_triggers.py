"""Triggers of the block: what passes a threshold for long enough ends the block after that step, and nothing else does."""

import numpy as np
import pytest
from coupled import couple, run
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import DONE, OVERCURRENT, RAIL_POTENTIAL, TRIGGER, TRIGGERED, copy_state, new_buffers

STEP_S = 0.5
STEPS = 80


def pulses():
    """Return loads on track 1 near A that are on for 6, 3 and 20 s, and one that feeds back."""
    times = (("a", 4.0, 10.0), ("b", 14.0, 17.0), ("c", 18.0, 38.0))
    loads = [{"id": name, "track": "1", "km": 1.0, "current_a": 1000.0, "from": low, "to": high} for name, low, high in times]
    return [*loads, {"id": "d", "track": "2", "km": 3.0, "current_a": -900.0, "from": 8.0, "to": 12.5}]


@pytest.fixture(scope="module")
def tables():
    rails = [
        {"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.02, "leakage_s_per_km": 0.05, "tracks": [track]}
        for track in "12"
    ]
    more = {"return_circuit": rails, "section_cabins": []}
    return compile_scenario(couple(run("E", time=20.0), loads=pulses(), end_s=STEPS * STEP_S, step_s=STEP_S, **more)).block


@pytest.fixture(scope="module")
def traces(tables):
    """Return currents of links and rail potentials of all steps without triggers."""
    watched = tables._replace(triggers=np.zeros(0, TRIGGER))
    state, buffers = fresh(watched), new_buffers(watched, STEPS)
    assert advance(watched, state, buffers, STEPS) == (STEPS, DONE)
    return buffers.link_a.copy(), buffers.rail_v.copy()


def fresh(tables):
    """Return the state before the first step; the ports of trains are those of a fresh run."""
    from tractionpower.kernels.block_tables import new_state  # noqa: PLC0415

    return new_state(tables)


def triggers(*rows):
    return np.array([*rows], TRIGGER)


def expected(traces, rows):
    """Return the steps after which each trigger fires, by a walk over the traces, and between them those that fire at once."""
    link_a, rail_v = traces
    fired = {}
    for number, (kind, index, above, delay_s) in enumerate(rows):
        values = np.abs((link_a if kind == OVERCURRENT else rail_v)[:, index])
        lasting = 0
        for step, value in enumerate(values):
            lasting = lasting + 1 if value > above else 0
            if lasting and lasting * STEP_S >= delay_s - 1e-9:
                fired.setdefault(step, set()).add(number)
    return fired


def found(tables, rows, bounds=(STEPS,)):
    """Return the same from the block, whose ends are `bounds` where nothing fires."""
    watched = tables._replace(triggers=triggers(*rows))
    state, fired = fresh(watched), {}
    for end in bounds:
        while state.progress[0]["step"] < end:
            steps, reason = advance(watched, state, new_buffers(watched, STEPS), end)
            step = int(state.progress[0]["step"])
            if reason == TRIGGERED:
                assert steps > 0
                assert state.fired.any()
                fired[step - 1] = set(np.flatnonzero(state.fired).tolist())
            else:
                assert (reason, step) == (DONE, end)
    return fired


@pytest.mark.parametrize("delay_s", [0.0, 0.3, 0.5, 1.0, 2.75, 6.0, 6.5, 100.0])
def test_a_current_must_last_for_the_delay(tables, traces, delay_s):
    rows = [(OVERCURRENT, 0, 600.0, delay_s)]
    assert found(tables, rows) == expected(traces, rows)


def test_the_delay_begins_anew_when_the_current_falls(tables, traces):
    """Pulses of 6 s and of 3 s with a gap: a delay of 8 s is not filled by both."""
    over = np.abs(traces[0][:, 0]) > 600.0
    assert over[8:20].all()
    assert not over[20:28].any()
    assert over[28:34].all()
    fired = found(tables, [(OVERCURRENT, 0, 600.0, 8.0)])
    assert min(fired) == 36 + 16 - 1  # only the third pulse lasts as long: from 18 s on, told after the step that ends at 26 s
    assert found(tables, [(OVERCURRENT, 0, 600.0, 6.0)]).keys() >= {19}
    assert 19 not in found(tables, [(OVERCURRENT, 0, 600.0, 6.5)])


def test_currents_count_in_either_direction(tables, traces):
    """Feeding back, the current of a link of track 2 is negative."""
    link = 1
    low = np.flatnonzero(traces[0][:, link] < -100.0)
    assert low.size > 3
    fired = found(tables, [(OVERCURRENT, link, 100.0, 0.0)])
    assert set(low.tolist()) <= set(fired)


def test_a_threshold_is_passed_not_reached(tables, traces):
    highest = float(np.abs(traces[0][:, 0]).max())
    assert found(tables, [(OVERCURRENT, 0, highest, 0.0)]) == {}
    assert found(tables, [(OVERCURRENT, 0, np.nextafter(highest, 0.0), 0.0)]) != {}
    assert found(tables, [(OVERCURRENT, 0, np.inf, 0.0)]) == {}


def test_rail_potentials(tables, traces):
    places = np.flatnonzero(tables.rails["span"] < 0).tolist()  # devices stand at cross-sections
    assert len(places) == 4
    for place in places:
        level = 0.5 * float(np.abs(traces[1][:, place]).max())
        assert level > 1.0
        rows = [(RAIL_POTENTIAL, place, level, 2.0)]
        assert found(tables, rows) == expected(traces, rows) != {}


def test_a_place_without_a_potential_never_fires(tables):
    rails = tables.rails.copy()
    rails["node"] = rails["span"] = -1
    without = tables._replace(rails=rails)
    assert found(without, [(RAIL_POTENTIAL, 0, 0.0, 0.0)]) == {}


MANY = [
    (OVERCURRENT, 0, 600.0, 2.0), (OVERCURRENT, 1, 300.0, 0.0), (OVERCURRENT, 2, 90.0, 3.5), (RAIL_POTENTIAL, 0, 2.0, 1.0),
    (RAIL_POTENTIAL, 1, 1.0, 4.0), (OVERCURRENT, 0, 600.0, 2.0), (OVERCURRENT, 3, np.inf, 0.0),
]  # fmt: skip


def test_several_at_once(tables, traces):
    fired = found(tables, MANY)
    assert fired == expected(traces, MANY)
    assert any(len(numbers) > 1 for numbers in fired.values())
    assert all((0 in numbers) == (5 in numbers) for numbers in fired.values())


@settings(deadline=None, derandomize=True, max_examples=25)
@given(bounds=st.sets(st.integers(1, STEPS - 1)))
def test_the_length_of_blocks_does_not_matter(tables, traces, bounds):
    assert found(tables, MANY, [*sorted(bounds), STEPS]) == expected(traces, MANY)


def test_a_copied_state_goes_on_waiting(tables):
    """The time since when a threshold is passed belongs to the state."""
    watched = tables._replace(triggers=triggers((OVERCURRENT, 0, 600.0, 5.0)))
    state = fresh(watched)
    assert advance(watched, state, new_buffers(watched, STEPS), 12) == (12, DONE)
    assert state.since_s.tolist() == [4.0]
    kept = copy_state(state)
    for each in (state, kept):
        assert advance(watched, each, new_buffers(watched, STEPS), STEPS) == (6, TRIGGERED)


def test_start_state_has_no_trigger_fired():
    compiled = compile_scenario(couple(run("E")))
    state = start_state(compiled)
    assert len(state.since_s) == len(state.fired) == 0

"""Rainflow counts: the example of the standard, any cut of a history, the index of damage."""

import itertools
import sys

import numpy as np
import pytest
import rainflow
from hypothesis import given
from hypothesis import strategies as st

from tractionpower.dynamics.statistics import MEAN_N, RANGE_N, RainflowCounter, relative_damage
from tractionpower.errors import UsageError
from tractionpower.kernels.chain_state import TURN

ASTM = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
"""Figure 6 of ASTM E1049-85, 5.4.4."""

ASTM_CYCLES = {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}
"""Its cycles by range."""

UNIT_N = 50e3
"""One unit of the standard; so large that ranges and means lie on ends and middles of classes."""


def turns(forces_n, link=0):
    return np.array([(link, force) for force in forces_n], TURN)


def by_range(cycles):
    counts = {}
    for (range_kn, _), count in cycles.items():
        counts[range_kn] = counts.get(range_kn, 0.0) + count
    return counts


def test_the_example_of_the_standard():
    counter = RainflowCounter(1)
    counter.add(turns(UNIT_N * np.array(ASTM)))
    (cycles,) = counter.cycles()
    assert by_range(cycles) == {range_ * UNIT_N / 1e3: count for range_, count in ASTM_CYCLES.items()}
    assert cycles[200.0, 50.0] == 1.0  # -1 to 3, the cycle E-F of the standard
    assert counter.damage() == pytest.approx([sum(n * (r * UNIT_N / 1e3) ** 3 for r, n in ASTM_CYCLES.items())])


@pytest.mark.parametrize("cut", range(len(ASTM) + 1))
def test_a_cut_anywhere_changes_nothing(cut):
    counter = RainflowCounter(1)
    counter.add(turns(UNIT_N * np.array(ASTM[:cut])))
    counter.cycles()  # a look in between, as a driver has it
    counter.add(turns(UNIT_N * np.array(ASTM[cut:])))
    assert by_range(counter.cycles()[0]) == {range_ * UNIT_N / 1e3: count for range_, count in ASTM_CYCLES.items()}


def alternating(steps):
    return np.cumsum([step * (-1) ** k for k, step in enumerate(steps)]) * 1e3


@given(st.lists(st.integers(1, 900), min_size=3, max_size=80), st.lists(st.integers(0, 80), max_size=4))
def test_pieces_count_as_the_whole(steps, cuts):
    forces = alternating(steps)
    counter = RainflowCounter(1)
    edges = sorted({0, *(min(cut, len(forces)) for cut in cuts), len(forces)})
    for begin, end in itertools.pairwise(edges):
        counter.add(turns(forces[begin:end]))
        counter.damage()
    whole = [(range_ / 1e3, count) for range_, _, count, _, _ in rainflow.extract_cycles(forces.tolist())]
    assert counter.damage()[0] == pytest.approx(sum(count * range_**3 for range_, count in whole), rel=1e-9)
    assert sum(counter.cycles()[0].values()) == pytest.approx(sum(count for _, count in whole))
    told, wanted = by_range(counter.cycles()[0]), {}
    for range_, count in whole:
        upper = float(np.ceil(range_ * 1e3 / RANGE_N) * RANGE_N / 1e3)
        wanted[upper] = wanted.get(upper, 0.0) + count
    assert told == pytest.approx(wanted)


@given(st.lists(st.integers(1, 900), min_size=2, max_size=40))
def test_the_force_of_now_is_the_last_point(steps):
    forces = alternating(steps)
    counter, whole = RainflowCounter(1), RainflowCounter(1)
    counter.add(turns(forces[:-1]))
    whole.add(turns(forces))
    now = [forces[-1]]
    assert counter.damage(now) == pytest.approx(whole.damage())
    assert counter.cycles(now) == whole.cycles()
    assert counter.cycles(now) == whole.cycles(now), "a last point that is there already counts once"


def test_series_do_not_mix():
    counter = RainflowCounter(3)
    forces = UNIT_N * np.array(ASTM)
    both = np.concatenate([turns(forces, 0), turns(-2.0 * forces, 2)])
    counter.add(both[np.argsort(np.tile(np.arange(len(forces)), 2), kind="stable")])
    first, none, last = counter.cycles()
    assert none == {}
    assert {(2.0 * range_, -2.0 * mean) for range_, mean in first} == set(last)
    assert counter.damage()[1] == 0.0
    assert relative_damage(counter.damage()) == pytest.approx([1 / 8, 0.0, 1.0])


def test_many_turns_wait_until_they_are_counted(monkeypatch):
    monkeypatch.setattr("tractionpower.dynamics.statistics.WAITING", 5)
    rng = np.random.default_rng(4)
    forces = alternating(rng.integers(1, 500, 200))
    counter, whole = RainflowCounter(1), RainflowCounter(1)
    for k in range(0, 200, 3):
        counter.add(turns(forces[k : k + 3]))
    whole.add(turns(forces))
    assert counter.cycles() == whole.cycles()
    assert counter.damage() == pytest.approx(whole.damage(), rel=1e-12)


def test_nothing_has_no_cycles():
    counter = RainflowCounter(2)
    assert counter.cycles() == [{}, {}]
    assert counter.cycles([1e3, -1e3]) == [{}, {}]
    assert relative_damage(counter.damage()).tolist() == [0.0, 0.0]
    counter.add(turns([0.0, 80e3]))
    (cycles, _) = counter.cycles()
    assert cycles == {(80.0, round(40e3 / MEAN_N) * MEAN_N / 1e3): 0.5}


def test_without_the_library_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    with pytest.raises(UsageError, match=r"pip install tractionpower\[dynamics\]"):
        RainflowCounter(1)

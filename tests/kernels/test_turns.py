"""Finishing, handing over and beginning, row by row, held against what the tables say."""

import numpy as np
import pytest

from tractionpower.kernels.train_tables import (
    GONE,
    OUTSIDE,
    STANDING,
    STAYING,
    STOP,
    TRAIN,
    TURN,
    TrainTables,
    new_train_state,
)
from tractionpower.kernels.turns import ENTERED, hands_over, may_begin, note_finish


def tables_of(*, turns, waits, takes_over=True, departures=(-np.inf, -np.inf, 500.0)):
    """Return three trains that begin at 100, 200 and 300 s; `turns` are (first, then, turn_s), by the first."""
    trains, stops = np.zeros(3, TRAIN), np.zeros(3, STOP)
    trains["start_s"], trains["waits"] = (100.0, 200.0, 300.0), waits
    trains["first_stop"], trains["stops"], trains["takes_over"] = (0, 1, 2), 1, [takes_over and each > 0 for each in waits]
    stops["departure_s"], stops["stops"] = departures, True
    rows = np.array([(then, turn_s) for _, then, turn_s in turns], TURN)
    for k in range(3):
        mine = [n for n, (first, _, _) in enumerate(turns) if first == k]
        trains[k]["first_turn"], trains[k]["turns"] = (mine[0] if mine else 0), len(mine)
    empty = {name: np.zeros(0) for name in TrainTables._fields if name not in ("trains", "stops", "turns")}
    return TrainTables(trains=trains, stops=stops, turns=rows, **empty)


def finish(tables, state, k, at_s):
    state.movers[k]["finished_s"], state.movers[k]["status"] = at_s, STAYING
    return note_finish(tables, state, k)


def test_the_last_portion_opens_the_way():
    tables = tables_of(turns=[(0, 2, 60.0), (1, 2, 60.0)], waits=(0, 0, 2))
    state = new_train_state(tables)
    assert not finish(tables, state, 1, 700.0)
    assert not hands_over(tables, state, 1)
    assert finish(tables, state, 0, 650.0)  # the one that came later counts
    assert may_begin(tables, state, 2, 701.0)
    mover = state.movers[2]
    assert (mover["status"], mover["leave_s"]) == (STANDING, 760.0)
    assert (state.entered_s[2], state.arrived_s[2], state.missing[2]) == (700.0, 700.0, ENTERED)
    assert hands_over(tables, state, 0)
    assert hands_over(tables, state, 1)
    assert state.movers["status"].tolist() == [GONE, GONE, STANDING]


@pytest.mark.parametrize(("finished", "leaves"), [(150.0, 500.0), (439.0, 500.0), (441.0, 501.0)])
def test_nobody_leaves_before_plan_or_turn_round(finished, leaves):
    tables = tables_of(turns=[(0, 2, 60.0)], waits=(0, 0, 1))
    state = new_train_state(tables)
    assert finish(tables, state, 0, finished)
    assert may_begin(tables, state, 2, finished + 1.0)
    assert state.movers[2]["leave_s"] == leaves


def test_without_a_departure_the_start_counts():
    tables = tables_of(turns=[(0, 2, 60.0)], waits=(0, 0, 1), departures=(-np.inf,) * 3)
    state = new_train_state(tables)
    finish(tables, state, 0, 150.0)
    may_begin(tables, state, 2, 151.0)
    assert state.movers[2]["leave_s"] == 300.0


def test_one_that_comes_back_to_the_line_begins_in_its_step():
    tables = tables_of(turns=[(0, 2, 60.0)], waits=(0, 0, 1), takes_over=False)
    state = new_train_state(tables)
    finish(tables, state, 0, 400.5)
    assert not may_begin(tables, state, 2, 460.0)
    assert (state.movers[2]["status"], state.missing[2]) == (OUTSIDE, 0)
    assert may_begin(tables, state, 2, 461.0)
    assert (state.movers[2]["status"], state.entered_s[2], state.missing[2]) == (OUTSIDE, 460.5, ENTERED)


def test_a_split_hands_over_once():
    tables = tables_of(turns=[(0, 1, 10.0), (0, 2, 10.0)], waits=(0, 1, 1))
    state = new_train_state(tables)
    assert finish(tables, state, 0, 600.0)
    assert may_begin(tables, state, 1, 601.0)
    assert may_begin(tables, state, 2, 601.0)
    assert hands_over(tables, state, 0)
    assert not hands_over(tables, state, 0)
    assert state.movers["leave_s"][1:].tolist() == [610.0, 610.0]


def test_a_train_that_becomes_nothing_stays():
    tables = tables_of(turns=[(0, 2, 60.0)], waits=(0, 0, 1))
    state = new_train_state(tables)
    assert not finish(tables, state, 1, 600.0)
    assert not hands_over(tables, state, 1)
    assert state.movers[1]["status"] == STAYING

"""Trains that become others at the end of their runs: rotations, joined and split portions.

A train has *forerunners*, which become it. It begins when all of them have finished and the turn-round time is over, not
before its own planned start. One that takes them over stands at its first call from the step on after the one in which the
last of them has finished; until then they keep their auxiliaries, from then on it has its own.
"""

from __future__ import annotations

from tractionpower.kernels.jit import njit
from tractionpower.kernels.train_tables import GONE, OUTSIDE, STANDING, STAYING

ENTERED = -1
"""`TrainState.missing` of a train that has begun after its forerunners."""


@njit
def note_finish(tables, state, k):
    """Tell the trains that train `k`, which has just finished, becomes; return whether one of them lacks no other any more."""
    train, finished = tables.trains[k], state.movers[k].finished_s
    is_last = False
    for n in range(train.first_turn, train.first_turn + train.turns):
        turn = tables.turns[n]
        then = state.movers[turn.then]
        then.leave_s = max(then.leave_s, finished + turn.turn_s)
        state.entered_s[turn.then] = max(state.entered_s[turn.then], finished)
        state.missing[turn.then] -= 1
        is_last = is_last or state.missing[turn.then] == 0
    return is_last


@njit
def hands_over(tables, state, k):
    """Take train `k` off the line if it stands at the end of its run and becomes a train now; tell whether it does.

    What it becomes, it becomes at once: a train is a portion of one other, or all of its portions are its own.
    """
    train, mover = tables.trains[k], state.movers[k]
    if train.turns == 0 or mover.status != STAYING or state.missing[tables.turns[train.first_turn].then] > 0:
        return False
    mover.status = GONE
    return True


@njit
def may_begin(tables, state, k, end):
    """Let train `k`, whose forerunners have all finished, begin if it does so before `end` [s]; tell whether it does."""
    train, mover = tables.trains[k], state.movers[k]
    if mover.status != OUTSIDE:  # before the clock began
        state.missing[k] = ENTERED
        return True
    if train.takes_over:
        row = train.first_stop
        state.arrived_s[row] = state.entered_s[k]
        mover.leave_s = max(mover.leave_s, tables.stops[row].departure_s)
        mover.status = STANDING
    elif mover.leave_s >= end:
        return False
    else:
        state.entered_s[k] = mover.leave_s
    state.missing[k] = ENTERED
    return True

"""The clock of a chain of vehicles: controls, air brake, a step, what is kept of it; in blocks that resume at any step."""

from __future__ import annotations

import math

from tractionpower.kernels.air_brake import move_brakes
from tractionpower.kernels.chain_state import BUFFER_FULL, DONE, ENDED, NOT_FINITE
from tractionpower.kernels.chain_step import leap, runge
from tractionpower.kernels.chain_tables import SYMPLECTIC, VARIABLE
from tractionpower.kernels.chain_tally import note_mark, note_speeds, record, tally
from tractionpower.kernels.jit import njit

TINY_S = 1e-9
"""Times closer than this are one."""

_MOVED_M = 0.01
"""A train that is to end at its standstill has moved by this."""


@njit
def advance_chain(chain, state, buffers, work, until_s):
    """Run steps until the time `until_s` or the end of the case; the result does not depend on where blocks end.

    Parameters
    ----------
    chain : Chain
    state : ChainState
        Changed in place.
    buffers : ChainBuffers
        Receive rows from `buffers.used` on.
    work : ChainWork
    until_s : float
        Time from the start [s]; the first step that ends there or later is the last one.

    Returns
    -------
    int
        `DONE`, `BUFFER_FULL` (make room and call again), `ENDED`, `NOT_FINITE` or `STEP_TOO_SMALL`.
    """
    setup, ledger = chain.chain[0], state.ledger[0]
    while True:
        if not (_take_controls(state, buffers) and _has_room(state, buffers)):
            return BUFFER_FULL
        control = state.controls[ledger.control_row]
        over = ledger.ended or _is_over(chain, state)
        if ledger.time_s >= ledger.next_record_s - TINY_S or (over and not ledger.ended):
            if buffers.used[0] == buffers.chain.shape[0]:
                return BUFFER_FULL
            if not ledger.ended:
                record(chain, state, buffers, control, work)
                ledger.next_record_s += setup.record_s
        if over:
            ledger.ended = True
            return ENDED
        if ledger.time_s >= until_s - TINY_S:
            return DONE
        end_s = _next_time(setup, state)
        h = end_s - ledger.time_s
        note_speeds(state)
        move_brakes(chain, state, ledger.time_s, h)
        if setup.method == SYMPLECTIC:
            leap(chain, state, control, h, work)
        else:
            reason = runge(chain, state, control, h, work)
            if reason != DONE:
                return reason
        ledger.time_s = end_s
        ledger.steps += 1
        if not _is_finite(state):
            return NOT_FINITE
        tally(chain, state, buffers, control, h)


@njit
def _take_controls(state, buffers):
    """Let the last row of the controls whose time has come hold, each noted by a mark; return whether there was room for it."""
    ledger = state.ledger[0]
    while ledger.control_row + 1 < ledger.control_rows and state.controls[ledger.control_row + 1].at_s <= ledger.time_s + TINY_S:
        if buffers.used[2] == buffers.marks.shape[0]:
            return False
        ledger.control_row += 1
        note_mark(state, buffers, ledger.control_row)
    return True


@njit
def _has_room(state, buffers):
    """Tell whether there is room for what a step may note: a turn of each coupling, and a standstill."""
    return buffers.used[1] + state.links.shape[0] <= buffers.turns.shape[0] and buffers.used[2] < buffers.marks.shape[0]


@njit
def _next_time(setup, state):
    """Return where the next step ends: on the grid of steps, or before at a command, a variable one also at a recorded row."""
    ledger = state.ledger[0]
    end_s = (math.floor(ledger.time_s / setup.step_s + 1e-6) + 1.0) * setup.step_s
    end_s = min(end_s, setup.end_s)
    if setup.method == VARIABLE and ledger.next_record_s > ledger.time_s + TINY_S:
        end_s = min(end_s, ledger.next_record_s)
    row = ledger.control_row + 1
    if row < ledger.control_rows:
        end_s = min(end_s, state.controls[row].at_s)
    return end_s


@njit
def _is_over(chain, state):
    """Tell whether the case has come to its end: its time, its distance, or the standstill of the train after its way."""
    setup, ledger, first = chain.chain[0], state.ledger[0], state.movers[0]
    if ledger.time_s >= setup.end_s - TINY_S or first.s_m - first.start_m >= setup.end_m:
        return True
    if not setup.ends_standing or abs(first.s_m - first.start_m) < _MOVED_M or ledger.control_row + 1 < ledger.control_rows:
        return False
    for i in range(state.movers.shape[0]):
        if state.movers[i].v_mps != 0.0:
            return False
    return state.controls[ledger.control_row].drive == 0


@njit
def _is_finite(state):
    total = 0.0
    for i in range(state.movers.shape[0]):
        total += state.movers[i].v_mps
    return math.isfinite(total)

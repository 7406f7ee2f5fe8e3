"""Controls that a driver sets while the train runs: rows behind those that are there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.commands import BAR, brake_target, drive_levels, electric_levels, next_pipe_row, shown_level
from tractionpower.errors import UsageError
from tractionpower.kernels.chain_state import ChainState
from tractionpower.model.dynamics.case import MOST_INDEPENDENT_BAR, Case

Setting = tuple[int | None, int | str | None, float | None, float | None]
"""Drive, brake, electric, independent_bar; None leaves one as it is."""


SET_WORDS = ("charge", "release", "full_service", "emergency")
"""Words of the brake control that a driver may set."""


def check_setting(case: Case, setting: Setting) -> None:
    """Refuse controls that the case does not have.

    Raises
    ------
    UsageError
        With all that is wrong.
    """
    drive, brake, electric, independent = setting
    told = [
        *_beyond("drive", drive, drive_levels(case)),
        *_beyond("electric", electric, electric_levels(case)),
        *_beyond("independent_bar", independent, MOST_INDEPENDENT_BAR),
    ]
    if isinstance(brake, str) and brake not in SET_WORDS:
        told.append(f"brake: there is no {brake[:40]!r}; it takes 0 to {case.air_brake.levels}, {', '.join(SET_WORDS)}")
    elif not isinstance(brake, str):
        told += _beyond("brake", brake, case.air_brake.levels)
    if told:
        raise UsageError("; ".join(told))


def _beyond(name: str, value: float | None, most: float) -> list[str]:
    """Return in words that a control is outside its range, nothing if it is not."""
    return [] if value is None or 0 <= value <= most else [f"{name}: {value:g} is not from 0 to {most:g}"]


def append_control(case: Case, state: ChainState, setting: Setting) -> ChainState:
    """Return the state with the controls set anew from now on; rows are added in place while there is room.

    Parameters
    ----------
    case
        The case.
    state
        State of its chain. Rows of the future, if it has any, are dropped: the driver has taken over.
    setting
        What is set; checked.
    """
    drive, brake, electric, independent = setting
    ledger = state.ledger[0]
    now = float(ledger["time_s"])
    # what was set a moment ago may not have been taken over yet
    last = int(np.searchsorted(state.controls["at_s"][: ledger["control_rows"]], now, side="right")) - 1
    ledger["control_rows"] = last + 1
    pipe_rows = int(np.searchsorted(state.pipe["from_s"][: ledger["pipe_rows"]], now, side="right"))
    ledger["pipe_rows"] = max(pipe_rows, 1)
    state = state._replace(controls=_with_room(state.controls, ledger["control_rows"]), pipe=_with_room(state.pipe, pipe_rows))
    state.controls[ledger["control_rows"]] = state.controls[last]
    row = state.controls[ledger["control_rows"]]
    row["at_s"] = now
    state.controls["at_s"][ledger["control_rows"] + 1 :] = np.inf  # rows that are not in use never come
    if drive is not None:
        row["drive"] = drive
    if electric is not None:
        row["electric"] = min(electric / electric_levels(case), 1.0)
    if independent is not None:
        row["independent_pa"] = independent * BAR
    if brake is not None:
        target, emergency = brake_target(case.air_brake, brake)
        before = state.pipe[ledger["pipe_rows"] - 1]
        state.pipe[ledger["pipe_rows"]] = next_pipe_row(case.air_brake, before, now, target, emergency)
        ledger["pipe_rows"] += 1
        row["brake"] = shown_level(case.air_brake, target, emergency=emergency)
    ledger["control_rows"] += 1
    return state


def _with_room(rows: NDArray[np.void], used: int) -> NDArray[np.void]:
    """Return rows with room for one more behind those in use."""
    if used < len(rows):
        return rows
    more = np.zeros(max(2 * len(rows), 64), rows.dtype)
    more[: len(rows)] = rows
    return more

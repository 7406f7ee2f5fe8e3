"""State of a chain of vehicles, the room that its steps work in, and the rows that are recorded; in SI units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MOVER = np.dtype(
    [
        ("s_m", "f8"),  # place of its middle
        ("v_mps", "f8"),
        ("a_mps2", "f8"),  # of the last evaluation
        ("gain_mps2", "f8"),  # mean acceleration of the last leapfrog step
        ("direction", "f8"),  # which way resistance finds it moving in this step: +1, -1, 0 held
        ("traction_n", "f8"),
        ("electric_n", "f8"),  # of the electric brake, before adhesion caps it
        ("electric_acting_n", "f8"),
        ("cylinder_pa", "f8"),  # at the end of the last step
        ("cylinder_before_pa", "f8"),
        ("independent_pa", "f8"),
        ("independent_before_pa", "f8"),
        ("brake_n", "f8"),  # as it acts, against the motion
        ("resistance_n", "f8"),  # running, curve and tunnel resistance as they act, against the motion
        ("grade_n", "f8"),  # against the direction of travel
        ("pipe_row", "i8"),  # last row of `pipe` that has arrived
        ("slope_row", "i8"),
        ("curve_row", "i8"),
        ("start_m", "f8"),
        ("before_mps", "f8"),  # speed at the beginning of the step
        ("greatest_mps", "f8"),  # speed of the greatest magnitude of all steps, and when
        ("greatest_at_s", "f8"),
        ("sharpest_mps2", "f8"),  # mean acceleration of the greatest magnitude of all steps, and when
        ("sharpest_at_s", "f8"),
        ("furthest_m", "f8"),  # movement against the first vehicle since the start of the greatest magnitude, and when
        ("furthest_at_s", "f8"),
    ]
)
"""State of a vehicle."""

LINK = np.dtype(
    [
        ("force_n", "f8"),  # at the last committed instant
        ("stretch_m", "f8"),
        ("draw_n", "f8"),  # of either gear
        ("draw_m", "f8"),
        ("buff_n", "f8"),
        ("buff_m", "f8"),
        ("greatest_n", "f8"),
        ("greatest_at_s", "f8"),
        ("least_n", "f8"),
        ("least_at_s", "f8"),
        ("turn_n", "f8"),  # extreme since the last turn, and which way the force goes
        ("turning", "f8"),
        ("absorbed_j", "f8"),  # work that the coupling has taken in
        ("damper_j", "f8"),  # part of it that its damper has
    ]
)
"""State of a coupling."""

LEDGER = np.dtype(
    [
        ("time_s", "f8"),
        ("steps", "i8"),
        ("recorded", "i8"),  # rows written in all
        ("next_record_s", "f8"),
        ("control_row", "i8"),  # the one that holds
        ("control_rows", "i8"),  # rows of `controls` in use
        ("pipe_rows", "i8"),  # rows of `pipe` in use
        ("traction_j", "f8"),
        ("electric_j", "f8"),
        ("brake_j", "f8"),
        ("resistance_j", "f8"),
        ("grade_j", "f8"),  # against gravity
        ("coupling_j", "f8"),
        ("step_s", "f8"),  # next step of the variable method
        ("splits", "i8"),  # steps cut where a vehicle came to a stand
        ("rejected", "i8"),
        ("ended", "?"),
        ("standing", "?"),
    ],
    align=True,
)
"""State of the whole chain; one row. Works are sums of force times speed with the weights of the method."""


class ChainState(NamedTuple):
    """State of a chain: can be copied and restored.

    Attributes
    ----------
    movers, links, ledger
        Record arrays of `MOVER` (vehicles), `LINK` (vehicles - 1) and `LEDGER` (1).
    pipe, controls
        What the driver has done: record arrays of `PIPE` and `CONTROL`, with room for what he will do.
    drive_speed, brake_speed
        Time spent [s] at a level (rows) and a speed (columns of the bins, one more at either end).
    force, acceleration
        Time spent [s] in bins of the force of the first coupling, and of the acceleration of the first vehicle.
    """

    movers: NDArray[np.void]
    links: NDArray[np.void]
    ledger: NDArray[np.void]
    pipe: NDArray[np.void]
    controls: NDArray[np.void]
    drive_speed: NDArray[np.float64]
    brake_speed: NDArray[np.float64]
    force: NDArray[np.float64]
    acceleration: NDArray[np.float64]


STAGES, POWERS = 7, 5
"""Most stages of a method; powers that are summed up: traction, electric brake, air brake, resistance, gradient [W]."""


class ChainWork(NamedTuple):
    """Room for the arithmetic of a step; nothing in it outlives the step. n vehicles.

    Attributes
    ----------
    applied, friction, force, damper
        What acts on a vehicle besides friction, the greatest friction, force of the coupling behind it, its damper's part
        [N], shape (n,).
    middle_v, stage_s, stage_v
        Speeds expected in the middle of a step [m/s], places [m] and speeds of a stage, shape (n,).
    speeds, accelerations
        Of the stages, shape (STAGES, n) [m/s, m/s2].
    powers, link_powers
        Of the stages, shape (STAGES, POWERS) and, taken in by a coupling and by its damper, (STAGES, n, 2) [W].
    efforts, aims
        Tractive and electric effort at the beginning of a step, and what they tend to there, shape (n, 2) [N].
    """

    applied: NDArray[np.float64]
    friction: NDArray[np.float64]
    force: NDArray[np.float64]
    damper: NDArray[np.float64]
    middle_v: NDArray[np.float64]
    stage_s: NDArray[np.float64]
    stage_v: NDArray[np.float64]
    speeds: NDArray[np.float64]
    accelerations: NDArray[np.float64]
    powers: NDArray[np.float64]
    link_powers: NDArray[np.float64]
    efforts: NDArray[np.float64]
    aims: NDArray[np.float64]


def new_chain_work(vehicles: int) -> ChainWork:
    """Return room for the steps of so many vehicles."""
    n = vehicles
    vectors = [np.zeros(n) for _ in range(7)]
    stages = [np.zeros((STAGES, n)), np.zeros((STAGES, n)), np.zeros((STAGES, POWERS)), np.zeros((STAGES, n, 2))]
    return ChainWork(*vectors, *stages, np.zeros((n, 2)), np.zeros((n, 2)))


VEHICLE_ROW = np.dtype(
    [
        ("s_m", "f8"),
        ("v_mps", "f8"),
        ("a_mps2", "f8"),
        ("traction_n", "f8"),
        ("electric_n", "f8"),
        ("brake_n", "f8"),
        ("resistance_n", "f8"),
        ("grade_n", "f8"),
        ("cylinder_pa", "f8"),
    ]
)
"""A recorded vehicle."""

LINK_ROW = np.dtype([("force_n", "f8"), ("stretch_m", "f8"), ("rate_mps", "f8")])
"""A recorded coupling."""

CHAIN_ROW = np.dtype(
    [
        ("time_s", "f8"),
        ("drive", "i8"),
        ("brake", "i8"),
        ("electric", "f8"),
        ("independent_pa", "f8"),
        ("reduction_pa", "f8"),
        ("traction_j", "f8"),
        ("electric_j", "f8"),
        ("brake_j", "f8"),
        ("resistance_j", "f8"),
        ("grade_j", "f8"),
        ("coupling_j", "f8"),
    ]
)
"""What is recorded once for the whole chain."""

TURN = np.dtype([("link", "i8"), ("force_n", "f8")])
"""A turning point of the force of a coupling."""

MARK = np.dtype([("time_s", "f8"), ("s_m", "f8"), ("v_mps", "f8"), ("control", "i8")])
"""Time, and place and speed of the first vehicle, when a row of the controls came to hold, or (-1) the train to a stand."""

TURN_N = 1000.0
"""A force has turned when it has come back by this [N]."""

DONE, BUFFER_FULL, ENDED, NOT_FINITE, STEP_TOO_SMALL = 0, 1, 2, 3, 4
"""Why `advance_chain` came back: time reached; no room for the next row or turn; standstill or distance limit; a state that is no
number; the variable step has become too small."""


class ChainBuffers(NamedTuple):
    """Where recorded rows go; row k of a call is the k-th record.

    Attributes
    ----------
    chain, vehicles, links
        Record arrays of `CHAIN_ROW` (rows), `VEHICLE_ROW` (rows, vehicles), `LINK_ROW` (rows, vehicles - 1).
    turns
        Record array of `TURN`.
    marks
        Record array of `MARK`.
    used
        Rows, turns and marks used, shape (3,); reset by the caller.
    """

    chain: NDArray[np.void]
    vehicles: NDArray[np.void]
    links: NDArray[np.void]
    turns: NDArray[np.void]
    marks: NDArray[np.void]
    used: NDArray[np.int64]

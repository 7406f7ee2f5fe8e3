"""Record types of the tables about trains, and the bundles in which they travel.

All quantities are SI: m, s, m/s, kg, N, W, V, A. Places are metres along the route of a train, of its front, from the
start of the route; all rows of one train lie together in a pool (`first_...` and a count).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NO_DRIVE, INVERTER, SERIES_MOTORS, TABLE = 0, 1, 2, 3
"""Kinds of drive."""

LEAVE, STOP_THERE, STAY = 0, 1, 2
"""What a train does at the end of its route."""

TRAIN = np.dtype(
    [
        ("mass_kg", "f8"),
        ("inertia_kg", "f8"),  # with rotating masses
        ("spread_m", "f8"),  # length over which gradients and curves act; 0: under the front
        ("a_n", "f8"),  # running resistance a + b v + c v2
        ("b_ns_per_m", "f8"),
        ("c_ns2_per_m2", "f8"),
        ("adhesive_n", "f8"),  # weight on driven axles; infinite: no limit
        ("adhesion_a_mps", "f8"),  # mu = a / (v + b) + c
        ("adhesion_b_mps", "f8"),
        ("adhesion_c", "f8"),
        ("drive", "i8"),
        ("start_n", "f8"),  # inverter: greatest effort; series motors, tables: greatest at any speed and voltage
        ("power_w", "f8"),
        ("pull_out_w_mps", "f8"),  # effort times v2 above the pull-out speed; infinite: none
        ("efficiency", "f8"),
        ("first_map", "i8"),  # into `points`: efficiency over speed, one curve per load
        ("map_speeds", "i8"),
        ("map_loads", "i8"),  # 0: constant efficiency
        ("max_current_a", "f8"),
        ("knee_v", "f8"),  # below it the current is reduced; 0: never
        ("lowest_v", "f8"),  # U_min2: no traction at or below it where the current is reduced, reduced auxiliaries
        ("nominal_v", "f8"),
        ("first_power", "i8"),  # into `points`: power at the wheel over voltage
        ("powers", "i8"),
        ("first_curve", "i8"),  # into `curves`
        ("curves", "i8"),
        ("first_notch", "i8"),  # into `notches`
        ("notches", "i8"),
        ("notch_s", "f8"),  # least time on a notch
        ("relay_off_v", "f8"),
        ("relay_on_v", "f8"),
        ("relay_s", "f8"),
        ("brake_n", "f8"),  # electric brake
        ("brake_w", "f8"),
        ("brake_from_mps", "f8"),
        ("brake_efficiency", "f8"),
        ("regenerates", "?"),
        ("fold_from_v", "f8"),
        ("fold_to_v", "f8"),
        ("rheostat_w", "f8"),
        ("auxiliary_w", "f8"),  # constant power
        ("heating_s", "f8"),  # resistive heating
        ("first_knot", "i8"),
        ("knots", "i8"),
        ("first_piece", "i8"),
        ("pieces", "i8"),
        ("first_stop", "i8"),
        ("stops", "i8"),
        ("first_limit", "i8"),
        ("limits", "i8"),
        ("first_off", "i8"),  # into `points`: what the front may take (`POWERED`, ...) from a place on, the first at 0
        ("offs", "i8"),
        ("service_mps2", "f8"),  # deceleration of the service brake on level straight track
        ("first_plan", "i8"),  # into `pieces`: the ceiling that the driver keeps while it is on time
        ("plans", "i8"),  # 0: flat out
        ("first_cap", "i8"),  # into `points`: share of the greatest effort from a place on, 0 coasts; the first at 0
        ("caps", "i8"),
        ("first_due", "i8"),  # into `points`: when the front must be at a place so that the plan still arrives on time
        ("dues", "i8"),
        ("late_s", "f8"),  # lateness from which on it is driven flat out
        ("coast_s", "f8"),  # for how long it coasts on a dead line before it brakes to a stand
        ("route_m", "f8"),
        ("start_s", "f8"),
        ("start_mps", "f8"),
        ("end", "i8"),
        ("first_turn", "i8"),  # into `turns`
        ("turns", "i8"),  # trains that it becomes
        ("waits", "i8"),  # trains that become it: it begins when all of them have finished
        ("takes_over", "?"),  # it stands where they ended, with its auxiliaries, until it may leave
    ],
    align=True,
)
"""A train on its route; equal powered vehicles are one drive, efforts and currents added up."""

KNOT = np.dtype([("at_m", "f8"), ("height_m", "f8"), ("drag_kg", "f8")])
"""Additional resistance, summed up from the start of the route: height, with curves and tunnels as a height [N/N m], and
what tunnels add to c [N s2/m2 m]. Straight between knots, level before the first and behind the last."""

PIECE = np.dtype([("from_m", "f8"), ("w", "f8"), ("dw", "f8")])
"""Speed ceiling: v2 = w + dw (s - from_m) from `from_m` to the next piece [m2/s2, m/s2]; at a stop it comes down to 0.
The ceiling jumps upwards only. The last piece begins at the end of the route."""

STOP = np.dtype([("at_m", "f8"), ("departure_s", "f8"), ("dwell_s", "f8"), ("stops", "?")])
"""A call: the train stops there, or passes. Without a planned departure `departure_s` is -inf."""

LINE_LIMIT = np.dtype([("from_m", "f8"), ("max_a", "f8"), ("standstill_a", "f8")])
"""Largest train current from a place on; infinite where the line sets none."""

POWERED, COASTS, DARK = 0, 1, 2
"""What the front of a train may take at a place: all; only its auxiliaries; nothing."""

POINT = np.dtype([("x", "f8"), ("y", "f8")])
"""A point of a curve."""

TURN = np.dtype([("then", "i8"), ("turn_s", "f8")])
"""The train that another one becomes at its end, and the shortest time between them."""

CURVE = np.dtype([("voltage_v", "f8"), ("first_effort", "i8"), ("efforts", "i8"), ("first_loss", "i8"), ("losses", "i8")])
"""Effort [N] and losses between line and wheel [W] over speed [m/s] at one voltage, as points."""

NOTCH = np.dtype(
    [
        ("series", "i8"),  # motors in a branch
        ("branches", "i8"),  # of the whole train
        ("set_a", "f8"),  # largest motor current: the starting resistors hold it
        ("motor_ohm", "f8"),
        ("full_field", "?"),  # starting resistors can be in
        ("first_point", "i8"),  # into `motor`
        ("points", "i8"),
    ]
)
"""A grouping and field step of series motors."""

MOTOR_POINT = np.dtype([("current_a", "f8"), ("emf_vs_per_m", "f8"), ("effort_n", "f8")])
"""A motor current with the voltage induced in one motor per m/s, and the effort of the train at the wheel."""


class TrainTables(NamedTuple):
    """All trains of a scenario as record arrays; `points` is the pool of curves."""

    trains: NDArray[np.void]
    knots: NDArray[np.void]
    pieces: NDArray[np.void]
    stops: NDArray[np.void]
    limits: NDArray[np.void]
    curves: NDArray[np.void]
    notches: NDArray[np.void]
    motor: NDArray[np.void]
    points: NDArray[np.void]
    turns: NDArray[np.void]


OUTSIDE, RUNNING, STANDING, STAYING, GONE = 0, 1, 2, 3, 4
"""Where a train is in its run: not yet on the line, under way, at a stop, at the end of its route for good, off the line."""

ACCELERATING, CRUISING, COASTING, BRAKING, DWELLING, WAITING, HOLDING, UNPOWERED = range(8)
"""Phases, as codes of `PHASES`."""

PHASES = ("accelerating", "cruising", "coasting", "braking", "dwelling", "waiting", "holding", "unpowered")

BY_NOTHING, BY_SPEED, BY_ADHESION, BY_DRIVE, BY_LINE_CURRENT, BY_TRAIN_CURRENT, BY_VOLTAGE = range(7)
BY_POWER_OFF, BY_STANDSTILL_CURRENT = 7, 8
"""What limits the effort, at standstill the auxiliaries, as codes of `LIMITED_BY`."""

LIMITED_BY = (
    "nothing", "speed", "adhesion", "drive", "line_current", "train_current", "voltage", "power_off", "standstill_current",
)  # fmt: skip

MOVER = np.dtype(
    [
        ("s_m", "f8"),
        ("v_mps", "f8"),
        ("piece", "i8"),  # of the ceiling, where the front is; counted from the train's first
        ("front", "i8"),  # knot before the front
        ("tail", "i8"),  # knot before the tail
        ("stop", "i8"),  # next call
        ("leave_s", "f8"),  # when it may leave the stop it stands at, or come onto the line
        ("lost_s", "f8"),  # since when the line has been dead; infinite: it is not
        ("notch_since_s", "f8"),
        ("relay_since_s", "f8"),  # since when the voltage asks for the other position; infinite: it does not
        ("voltage_v", "f8"),  # of the step before
        ("held_s", "f8"),  # for how long it has stood on its way because effort or power lack
        ("finished_s", "f8"),  # when it left the line or came to stay; NaN: not yet
        ("status", "i4"),
        ("limit", "i4"),
        ("notch", "i4"),
        ("below", "i4"),  # notch that takes turns with it, -1: off
        ("slowing", "?"),  # whether it lost speed in the step before
        ("relay_open", "?"),
        ("late", "?"),  # driven flat out until it is on time again
    ],
    align=True,
)
"""What one step leaves of a train for the next; copied twice in a step, so it is small: 128 bytes."""

TALLY = np.dtype(
    [
        ("traction_ns", "f8"),  # integrals over the step: effort by time and by distance
        ("traction_j", "f8"),
        ("line_j", "f8"),  # traction divided by the efficiency of an inverter drive, else the same as traction_j
        ("brake_ns", "f8"),
        ("brake_j", "f8"),
        ("electric_ns", "f8"),  # part of the brake that the electric brake can give
        ("electric_j", "f8"),
        ("resistance_ns", "f8"),
        ("resistance_j", "f8"),
        ("wished_ns", "f8"),
        ("moved_m", "f8"),
        ("moving_s", "f8"),
        ("entry_mps", "f8"),  # speed where it first may take traction current, at the latest at the end of the step
        ("off_s", "f8"),  # of `moving_s`, `moved_m`, `resistance_j`: where it may not
        ("off_m", "f8"),
        ("off_j", "f8"),
        ("dark_s", "f8"),  # of `on_line_s`: without any current
        ("off_brake_ns", "f8"),  # what resistors take of the electric brake where nothing can be fed back
        ("off_brake_j", "f8"),
        ("phase", "i8"),  # at the start of the step
        ("limited_by", "i8"),  # without regard to the voltage, where the train accelerates
        ("on_line_s", "f8"),  # time on the line within the step
    ]
)
"""What a train does in one step."""

DEMAND = np.dtype(
    [
        ("need_w", "f8"),  # wished power while it may pull: of an inverter drive from the line, of others at the wheel
        ("moving", "f8"),  # share of the step in which it moves and may pull, and in which it has its auxiliaries
        ("on_line", "f8"),
        ("line_a", "f8"),  # largest train current that the line allows
        ("gained_w", "f8"),  # mean power that the electric brake gives
        ("expected_w", "f8"),  # traction, of the kind of `need_w`, of which that braking is the consequence
        ("speed_mps", "f8"),  # at the start of the step, or where it first may pull
        ("half_s_per_kg", "f8"),  # half of the time that it moves and may pull, over its inertia
        ("resistance_n", "f8"),
        ("mean_mps", "f8"),  # mean speed of the trial
    ]
)
"""What a train asks of the line in one step, before the voltage is known."""

TRAIN_ROW = np.dtype(
    [
        ("train", "i8"),
        ("time_s", "f8"),
        ("s_m", "f8"),
        ("moved_m", "f8"),
        ("v_mps", "f8"),
        ("acceleration_mps2", "f8"),
        ("phase", "i8"),
        ("limited_by", "i8"),
        ("traction_n", "f8"),
        ("electric_brake_n", "f8"),
        ("friction_brake_n", "f8"),
        ("resistance_n", "f8"),
        ("wished_n", "f8"),
        ("voltage_v", "f8"),
        ("rail_v", "f8"),  # rail potential under the front; NaN: none is defined
        ("current_a", "f8"),
        ("power_w", "f8"),
        ("auxiliary_w", "f8"),
        ("starting_resistor_w", "f8"),
        ("braking_resistor_w", "f8"),
        ("refused_w", "f8"),
        ("drive_loss_w", "f8"),  # between line and wheel, starting resistors apart
        ("wheel_w", "f8"),  # tractive power at the wheel
        ("returned_w", "f8"),  # fed back into the line
        ("recovered_w", "f8"),  # of braking, used on the train or fed back
        ("brake_w", "f8"),  # power of all brakes at the wheel
        ("on_line_s", "f8"),  # time on the line within the step
        ("fitted_w", "f8"),  # by which the port of the train differs from its characteristic
        ("coupling_w", "f8"),  # by which the power differs from what the train reckons with at constant voltage
        ("grouping", "i8"),  # motors in series of the notch of series motors that are on, else 0
    ]
)
"""A step of a train: time, place, speed, phase at its start; means over the step of all else, `moved_m` its way."""


class TrainState(NamedTuple):
    """What trains leave for the next step, what they try in this one, and when they called."""

    movers: NDArray[np.void]
    trials: NDArray[np.void]  # MOVER
    wishes: NDArray[np.void]  # TALLY of the trial
    demands: NDArray[np.void]  # DEMAND of the trial
    done: NDArray[np.void]  # TALLY of the step
    arrived_s: NDArray[np.float64]  # by row of `TrainTables.stops`; NaN: not yet
    left_s: NDArray[np.float64]
    missing: NDArray[np.int64]  # trains that have to finish before it may begin
    entered_s: NDArray[np.float64]  # when it comes onto the line; of one that takes others over, when the last had finished


def new_train_state(tables: TrainTables) -> TrainState:
    """Return the state in which all trains are outside."""
    trains, stops = len(tables.trains), len(tables.stops)
    movers = np.zeros(trains, MOVER)
    movers["v_mps"] = tables.trains["start_mps"]
    movers["leave_s"] = tables.trains["start_s"]
    movers["relay_since_s"] = np.inf
    movers["notch_since_s"] = -np.inf
    movers["finished_s"] = np.nan
    movers["lost_s"] = np.inf
    movers["voltage_v"] = tables.trains["nominal_v"]
    return TrainState(
        movers=movers,
        trials=movers.copy(),
        wishes=np.zeros(trains, TALLY),
        demands=np.zeros(trains, DEMAND),
        done=np.zeros(trains, TALLY),
        arrived_s=np.full(stops, np.nan),
        left_s=np.full(stops, np.nan),
        missing=tables.trains["waits"].copy(),
        entered_s=np.where(tables.trains["waits"] > 0, -np.inf, tables.trains["start_s"]),
    )

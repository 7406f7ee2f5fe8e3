"""Record types and bundles of a train as a chain of vehicles: what its kernels read, and its state.

All quantities are SI: m, s, kg, N, Pa (gauge), m/s. Vehicles are numbered from the front, and coupling j lies between
vehicles j and j + 1. A force in a coupling is positive in tension (draft).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SYMPLECTIC, RK4, EULER, VARIABLE = 0, 1, 2, 3
"""Methods of integration."""

VEHICLE = np.dtype(
    [
        ("mass_kg", "f8"),
        ("inertia_kg", "f8"),  # with rotating parts
        ("weight_n", "f8"),
        ("a_n", "f8"),  # running resistance A + B v + C v2
        ("b_ns_per_m", "f8"),
        ("c_ns2_per_m2", "f8"),
        ("behind_m", "f8"),  # of its middle behind the front of the train, couplings centred
        ("adhesive_n", "f8"),  # weight on braked axles
        ("adhesion_a", "f8"),  # mu = a / (v + b) + c, v in m/s
        ("adhesion_b", "f8"),
        ("adhesion_c", "f8"),
        ("engine", "i8"),  # row of ENGINE, -1: not powered
        ("brake", "i8"),  # row of BRAKE, -1: no air brake in use
    ]
)
"""A vehicle of the chain."""

ENGINE = np.dtype(
    [
        ("first_level", "i8"),  # of level 1 in LEVEL
        ("levels", "i8"),
        ("time_constant_s", "f8"),
        ("adhesive_n", "f8"),  # weight on driven axles that caps traction; infinite: no cap
        ("electric_n", "f8"),  # electric brake at full share
        ("electric_w", "f8"),
        ("fades_mps", "f8"),  # below it the electric brake fades linearly to 0
        ("electric_s", "f8"),  # time constant of the electric brake
    ]
)
"""What drives a vehicle, and its electric brake."""

LEVEL = np.dtype([("effort_n", "f8"), ("power_w", "f8"), ("first_point", "i8"), ("points", "i8"), ("pull_out_w_mps", "f8")])
"""Steady effort of one level: min(effort, power / v, pull-out / v2; 0: none), or points (v, F) where it has some."""

BRAKE = np.dtype(
    [
        ("delay_s", "f8"),  # until a change of the pipe at the driver's valve arrives
        ("newton_per_pa", "f8"),  # force of all blocks over cylinder pressure
        ("blocks", "f8"),
        ("friction", "i8"),  # row of FRICTION
        ("independent", "?"),  # has the independent brake
    ],
    align=True,
)
"""Air brake of a vehicle."""

FRICTION = np.dtype(
    [
        ("mu", "f8"),  # mu (f1 F + 1) / (f2 F + 1) (v1 v + 1) / (v2 v + 1), F [N] of a block, v [m/s]
        ("f1", "f8"),
        ("f2", "f8"),
        ("v1", "f8"),
        ("v2", "f8"),
        ("first_speed", "i8"),  # into `grid`: speeds, then forces, then friction row by row of speeds; speeds 0: the law above
        ("speeds", "i8"),
        ("forces", "i8"),
    ]
)
"""Friction of brake blocks."""

AIR = np.dtype(
    [
        ("gain", "f8"),  # cylinder over reduction
        ("cylinder_pa", "f8"),
        ("cylinder_emergency_pa", "f8"),
        ("fill_s", "f8"),
        ("release_s", "f8"),
        ("independent_s", "f8"),
        ("pipe_pa", "f8"),
        ("emergency_fill_s", "f8"),  # instead of fill_s where the row of the pipe is one of emergency
    ]
)
"""What all cylinders have in common; one row."""

PIPE = np.dtype(
    [("from_s", "f8"), ("start_pa", "f8"), ("target_pa", "f8"), ("time_constant_s", "f8"), ("emergency", "?")], align=True
)
"""A stretch of time in which the reduction at the driver's valve goes exponentially from one value towards another."""

CONTROL = np.dtype(
    [
        ("at_s", "f8"),
        ("drive", "i8"),  # level
        ("electric", "f8"),  # share 0..1 of the greatest electric brake
        ("independent_pa", "f8"),
        (
            "brake",
            "i8",
        ),  # level shown and counted: 0 released; levels + 1 full service by word is the highest level, + 1 emergency
    ]
)
"""What the driver's controls are from a time on."""

COUPLING = np.dtype(
    [
        ("half_slack_m", "f8"),
        ("damping_ns_per_m", "f8"),
        ("draw", "i8"),  # rows of GEAR
        ("buff", "i8"),
    ]
)
"""A coupling: tension where it is stretched by more than half the slack, compression likewise."""

GEAR = np.dtype(
    [
        ("first_load", "i8"),  # points of loading and of unloading in `curves`, from deflection 0 on
        ("loads", "i8"),
        ("first_unload", "i8"),
        ("unloads", "i8"),
        ("tan_wedge", "f8"),  # 0: no wedge
        ("mu_static", "f8"),
        ("mu_kinetic", "f8"),
        ("blending_mps", "f8"),
        ("locked_n_per_m", "f8"),  # 0: passes from curve to curve with the speed
        ("relaxing_n_per_m", "f8"),
        ("stroke_m", "f8"),  # infinite: never solid
        ("solid_n_per_m", "f8"),
        ("locked_damping_ns_per_m", "f8"),  # of the parts in series, while the gear is deflected
    ]
)
"""One side of a coupling."""

POINT = np.dtype([("x", "f8"), ("y", "f8")])
"""A point of a curve: deflection [m] and force [N], or speed [m/s] and effort [N]."""

SLOPE = np.dtype([("from_m", "f8"), ("slope", "f8"), ("change_per_m", "f8"), ("height_m", "f8")])
"""A piece of the track from a distance on, up to the next: slope + change (s - from), and the height at its beginning."""

CURVE = np.dtype([("from_m", "f8"), ("per_m", "f8"), ("change_per_m2", "f8"), ("tunnel", "f8")])
"""A piece of the track: curvature (its sign tells the side), its change along the piece, specific tunnel resistance [N/N]."""

BEND = np.dtype([("a1_m", "f8"), ("b1_m", "f8"), ("a2_m", "f8"), ("b2_m", "f8"), ("divide_per_m", "f8")])
"""Curve resistance a k / (1 - b k) [N/N] by the curvature k: the first pair up to `divide_per_m`, the second beyond; one row."""

CHAIN = np.dtype(
    [
        ("method", "i8"),
        ("step_s", "f8"),
        ("tolerance", "f8"),
        ("standstill_mps", "f8"),
        ("cap_all", "?"),  # adhesion caps all resistance (Zobory and Bekefi, eq. 6, as printed), else the brake alone
        ("mean_grade", "?"),  # gradient as mean under the train
        ("length_m", "f8"),
        ("record_s", "f8"),
        ("end_s", "f8"),
        ("end_m", "f8"),  # infinite: no limit
        ("ends_standing", "?"),
    ],
    align=True,
)
"""What the whole chain has; one row."""

HISTOGRAM = np.dtype([("from_", "f8"), ("width", "f8"), ("bins", "i8")])
"""Bins of one quantity: speed, force of the first coupling, acceleration of the first vehicle; three rows."""


class Chain(NamedTuple):
    """All that a step reads; the arrays are record arrays of the types named."""

    chain: NDArray[np.void]  # CHAIN
    vehicles: NDArray[np.void]  # VEHICLE
    engines: NDArray[np.void]  # ENGINE
    levels: NDArray[np.void]  # LEVEL
    brakes: NDArray[np.void]  # BRAKE
    frictions: NDArray[np.void]  # FRICTION
    grid: NDArray[np.float64]
    air: NDArray[np.void]  # AIR
    couplings: NDArray[np.void]  # COUPLING
    gears: NDArray[np.void]  # GEAR
    curves: NDArray[np.void]  # POINT, of gears and of levels
    slopes: NDArray[np.void]  # SLOPE
    bends: NDArray[np.void]  # CURVE
    bend: NDArray[np.void]  # BEND
    bins: NDArray[np.void]  # HISTOGRAM

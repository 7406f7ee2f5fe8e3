"""The notches of series motors one by one: effort over speed at one voltage, with starting resistors and field steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.drive import Grouping, SeriesMotorDrive

Floats = NDArray[np.float64]

_CURRENTS = 200


@dataclass(frozen=True, eq=False)
class NotchCurve:
    """Effort [N] over speed [m/s] of one notch, from its greatest current down; `resistor_ohm` is that of one branch."""

    grouping: Grouping
    field_percent: float
    resistor_ohm: float
    speed_mps: Floats
    effort_n: Floats


def notch_curves(drive: SeriesMotorDrive, units: int, voltage_v: float, top_mps: float) -> tuple[NotchCurve, ...]:
    """Return the curves of all notches up to the speed `top_mps`: starting resistors at full field, then field steps.

    With k motors in series, v = (U - I R_add - k I R_m) / (k c phi(alpha I)), F = N c phi(alpha I) I eta; currents go up
    to the one that is held in the grouping.
    """
    last = len(drive.groupings) - 1
    curves = []
    for index, grouping in enumerate(drive.groupings):
        held = grouping.starting_current_a or drive.starting_current_a
        steps = [(100.0, ohm) for ohm in _resistors(drive, index, last) if ohm > 0.0]
        steps += [(percent, 0.0) for percent in drive.field_steps_percent]
        for percent, ohm in steps:
            speed, effort = _curve(drive, grouping, (held, percent, ohm), voltage_v)
            inside = (speed >= 0.0) & (speed <= top_mps)
            if inside.sum() > 1:
                curves.append(NotchCurve(grouping, percent, ohm, speed[inside], units * effort[inside]))
    return tuple(curves)


def _resistors(drive: SeriesMotorDrive, index: int, last: int) -> tuple[float, ...]:
    given = drive.starting_resistors_ohm
    if given is None:
        return ()
    return given.series if index == 0 else given.parallel if index == last else given.series_parallel


def _curve(
    drive: SeriesMotorDrive, grouping: Grouping, notch: tuple[float, float, float], voltage_v: float
) -> tuple[Floats, Floats]:
    held, percent, ohm = notch
    amps = np.linspace(held, held / _CURRENTS, _CURRENTS)
    field_a = np.array([0.0, *(point.current_a for point in drive.magnetisation)])
    constant = np.array([0.0, *(point.emf_vs_per_rev for point in drive.magnetisation)])
    per_m = drive.gear_ratio / (np.pi * drive.wheel_diameter_m)
    emf = np.interp(percent / 100.0 * amps, field_a, constant) * per_m
    speed = (voltage_v - amps * (ohm + grouping.series * drive.motor_resistance_ohm)) / (grouping.series * emf)
    return speed, drive.motors * drive.gear_efficiency * emf * amps

"""What the driver does, as rows: reductions of the brake pipe over time, and states of the controls."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.chain_tables import CONTROL, PIPE
from tractionpower.model.dynamics.case import Case
from tractionpower.model.dynamics.gear import AirBrake, ElectricBrake, Traction

BAR = 1e5
"""Pascal per bar."""

_ROUNDING = 1e-9


class PipeRow(NamedTuple):
    """A row of PIPE: the reduction goes from one pressure towards another from a time on."""

    from_s: float
    start_pa: float
    target_pa: float
    time_constant_s: float
    emergency: bool


class ControlRow(NamedTuple):
    """A row of CONTROL: what the controls are from a time on."""

    at_s: float
    drive: int
    electric: float
    independent_pa: float
    brake: int


def reduction_of_level(air_brake: AirBrake, level: int) -> float:
    """Return the reduction of the pipe that a level of the brake control commands [bar]; 0 releases."""
    level = min(level, air_brake.levels)
    if level < 1:
        return 0.0
    if air_brake.reductions_bar:
        return air_brake.reductions_bar[min(level, len(air_brake.reductions_bar)) - 1]
    full, first = air_brake.full_service_reduction_bar, air_brake.first_reduction_bar
    if first is None or air_brake.levels == 1:
        return full * level / air_brake.levels
    return first + (full - first) * (level - 1) / (air_brake.levels - 1)


def brake_target(air_brake: AirBrake, brake: int | str) -> tuple[float, bool]:
    """Return the reduction [bar] that a level or a word of the brake control commands, and whether it is emergency."""
    if isinstance(brake, int):
        return reduction_of_level(air_brake, brake), False
    if brake == "emergency":
        return air_brake.pipe_pressure_bar, True
    if brake == "full_service":
        return air_brake.full_service_reduction_bar, False
    if brake in ("charge", "release"):
        return 0.0, False
    raise ValueError(f"no reduction belongs to the word {brake!r}")


def shown_level(air_brake: AirBrake, target_bar: float, *, emergency: bool = False) -> int:
    """Return the level that is shown and counted for a reduction: the lowest that commands as much.

    0 is released, one more than the highest level is emergency.
    """
    if emergency:
        return air_brake.levels + 1
    if target_bar <= 0.0:
        return 0
    enough = (n for n in range(1, air_brake.levels) if reduction_of_level(air_brake, n) >= target_bar * (1.0 - _ROUNDING))
    return next(enough, air_brake.levels)


def next_pipe_row(
    air_brake: AirBrake, row_before: PipeRow | Mapping[str, Any] | np.void, now_s: float, target_bar: float, emergency: bool
) -> PipeRow:
    """Return the row of PIPE of a command, from where the reduction is at that time (Zobory and Bekefi, eq. 3).

    A command before the last one has settled starts from the reduction that prevails, p*. The pressure limit of emergency
    holds until the next application, so that no cylinder jumps when its brake is released.

    Parameters
    ----------
    air_brake
        The air brake.
    row_before
        Row of PIPE that holds until now.
    now_s
        When [s].
    target_bar
        Reduction commanded [bar].
    emergency
        Whether the pipe is emptied.
    """
    before = row_before if isinstance(row_before, PipeRow) else PipeRow(*(row_before[name] for name in PipeRow._fields))
    start, target = reduction_of_row(before, now_s), target_bar * BAR
    if emergency:
        time_constant = air_brake.emergency_time_constant_s
    elif target >= start:
        time_constant = air_brake.application_time_constant_s
    else:
        time_constant = air_brake.release_time_constant_s
    return PipeRow(now_s, start, target, time_constant, emergency or (bool(before.emergency) and target <= start))


def reduction_of_row(row: PipeRow, time_s: float) -> float:
    """Return the reduction [Pa] at a time on a row of PIPE."""
    since = max(time_s - row.from_s, 0.0)
    left = math.exp(-since / row.time_constant_s) if row.time_constant_s > 0.0 else 0.0
    return float(row.target_pa + (row.start_pa - row.target_pa) * left)


def drive_levels(case: Case) -> int:
    """Return the highest level of the drive control of any vehicle."""
    given = (case.traction, *(part.traction for part in case.vehicles))
    return max((traction.levels for traction in given if traction is not None), default=Traction().levels)


def electric_levels(case: Case) -> int:
    """Return the highest level of the control of the electric brake."""
    own = (part.electric_brake for part in case.vehicles)
    brake = case.electric_brake or next((each for each in own if each is not None), None)
    return brake.levels if brake is not None else int(ElectricBrake.model_fields["levels"].default)


def compile_commands(case: Case) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return what the driver does as rows of PIPE and of CONTROL.

    The first row of either is the start of the case; a row of CONTROL follows for each command, a row of PIPE for each
    that sets the brake.
    """
    air_brake, levels = case.air_brake, electric_levels(case)
    target, emergency = brake_target(air_brake, case.start.brake)
    pipe = [PipeRow(0.0, target * BAR, target * BAR, 0.0, emergency)]
    controls = [ControlRow(0.0, 0, 0.0, 0.0, shown_level(air_brake, target, emergency=emergency))]
    for command in sorted(case.commands, key=lambda each: each.time_s):
        now = controls[-1]._replace(at_s=command.time_s)
        if command.drive is not None:
            now = now._replace(drive=command.drive)
        if command.electric is not None:
            now = now._replace(electric=min(command.electric / levels, 1.0))
        if command.independent_bar is not None:
            now = now._replace(independent_pa=command.independent_bar * BAR)
        brake = command.brake if command.brake != "unchanged" else None
        if command.reduction_bar is not None or brake is not None:
            target, emergency = (command.reduction_bar or 0.0, False) if brake is None else brake_target(air_brake, brake)
            pipe.append(next_pipe_row(air_brake, pipe[-1], command.time_s, target, emergency))
            now = now._replace(brake=shown_level(air_brake, target, emergency=emergency))
        controls.append(now)
    return np.array(pipe, PIPE), np.array(controls, CONTROL)

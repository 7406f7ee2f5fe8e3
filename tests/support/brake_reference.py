"""A second solution of the air brake: reductions by recursion over the commands, cylinders by a stiff solver of SciPy."""

from bisect import bisect_right
from collections.abc import Sequence
from math import exp
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from tractionpower.model.dynamics.gear import AirBrake

Commands = Sequence[tuple[float, float | str]]
"""Times [s], and reductions [bar] or ``emergency``."""


class Reference:
    """Reductions and cylinder pressures [bar] of an air brake whose driver gives `commands`, by rising time."""

    def __init__(self, air: AirBrake, commands: Commands) -> None:
        self.air = air
        self.at, self.rows = [0.0], [(0.0, 0.0, 1.0, False)]
        for time, asked in commands:
            start, before = self.reduction(time), self.rows[-1]
            emergency = asked == "emergency"
            target = air.pipe_pressure_bar if isinstance(asked, str) else asked
            constant = air.application_time_constant_s if target >= start else air.release_time_constant_s
            constant = air.emergency_time_constant_s if emergency else constant
            self.at.append(time)
            self.rows.append((start, target, constant, emergency or (before[3] and target <= start)))

    def reduction(self, time: float) -> float:
        """Return the reduction at the driver's valve."""
        k = bisect_right(self.at, time) - 1
        start, target, constant, _ = self.rows[max(k, 0)]
        return target + (start - target) * exp(-max(time - self.at[max(k, 0)], 0.0) / constant)

    def aim(self, k: int, time: float) -> float:
        """Return what a cylinder without delay aims at, by row `k`."""
        start, target, constant, emergency = self.rows[k]
        reduction = target + (start - target) * exp(-max(time - self.at[k], 0.0) / constant)
        greatest = self.air.cylinder_emergency_bar if emergency else None
        return min(self.air.gain * reduction, self.air.cylinder_pressure_bar if greatest is None else greatest)

    def cylinder(self, delay: float, times: Sequence[float]) -> Any:
        """Return the pressure of a cylinder at rising times, integrated over each row of commands."""
        air, pressure, now, found = self.air, 0.0, 0.0, {0.0: 0.0}
        for k in range(len(self.at)):
            end = self.at[k + 1] + delay if k + 1 < len(self.at) else times[-1]
            end = min(end, times[-1])
            if end <= now:
                continue
            fill = air.cylinder_fill_s
            if self.rows[k][3]:
                own = air.cylinder_emergency_fill_s
                fill = max(air.cylinder_fill_s, air.application_time_constant_s) if own is None else own
            release = air.cylinder_release_s
            wanted = [time for time in times if now < time < end] + [end]

            def change(time: float, p: Any, k: int = k, fill: float = fill, release: float = release) -> list[float]:
                gap = self.aim(k, time - delay) - p[0]
                return [gap / (fill if gap > 0.0 else release)]

            solved = solve_ivp(change, (now, end), [pressure], t_eval=wanted, rtol=1e-9, atol=1e-11, method="LSODA", max_step=0.1)
            assert solved.success
            found |= dict(zip(wanted, solved.y[0], strict=True))
            pressure, now = float(solved.y[0, -1]), end
        return np.array([found[time] for time in times])

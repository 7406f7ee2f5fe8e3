"""A journey of a train with an inverter drive by scipy, from the equations alone: nothing of the package is used.

M dv/dt = F(v) - A - B v - C v2 - m g (z(s) - z(s - L)) / L, with the greatest effort below the speed ceiling, at constant
speed on it, and down braking curves, which are integrated backwards from each lower limit and stop.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

G = 9.80665
TOLERANCES = {"rtol": 1e-10, "atol": 1e-9, "method": "DOP853", "max_step": 2.0}
HERE = 1e-5  # m


@dataclass(frozen=True)
class Case:
    """A train and its line, in SI; slopes are rows (from, to, rise per metre), limits rows (from, to, m/s)."""

    end_m: float
    mass_kg: float
    inertia_kg: float
    length_m: float
    effort_n: float
    power_w: float
    rate_mps2: float
    max_mps: float
    resistance: tuple[float, float, float] = (0.0, 0.0, 0.0)
    slopes: tuple[tuple[float, float, float], ...] = ()
    limits: tuple[tuple[float, float, float], ...] = ()
    stops: tuple[tuple[float, float], ...] = ()  # place, dwell
    stops_at_end: bool = False
    start_mps: float = 0.0

    def height(self, s: float) -> float:
        return sum(rise * min(max(s - low, 0.0), high - low) for low, high, rise in self.slopes)

    def slope(self, s: float) -> float:
        return (self.height(s) - self.height(s - self.length_m)) / self.length_m

    def effort(self, v: float) -> float:
        return min(self.effort_n, self.power_w / max(v, 1e-9))

    def drag(self, s: float, v: float) -> float:
        a, b, c = self.resistance
        return a + b * v + c * v * v + self.mass_kg * G * self.slope(s)

    def braking(self, s: float) -> float:
        return max(self.rate_mps2 + self.mass_kg * G / self.inertia_kg * self.slope(s), 0.1 * self.rate_mps2)

    def limit(self, s: float) -> float:
        holding = [v for low, high, v in self.limits if low <= s < high + self.length_m]
        return min([*holding, self.max_mps])

    def breaks(self) -> list[float]:
        places = [p for low, high, _ in self.limits for p in (low, high + self.length_m)]
        places += [p + tail for low, high, _ in self.slopes for p in (low, high) for tail in (0.0, self.length_m)]
        places += [p for p, _ in self.stops]
        return sorted({p for p in places if 0.0 < p < self.end_m} | {self.end_m})


@dataclass
class Journey:
    """What came out: arrivals at the stops [s], time at the end [s], energy at the wheel and from the line [J]."""

    arrivals_s: list[float] = field(default_factory=list)
    time_s: float = 0.0
    s_m: float = 0.0
    v_mps: float = 0.0
    wheel_j: float = 0.0


class _Ceiling:
    """Static limit and braking curves: squares of speeds over the distance, backwards from each place to come down to."""

    def __init__(self, case: Case) -> None:
        self.case = case
        goals = [(p, 0.0) for p, _ in case.stops] + ([(case.end_m, 0.0)] if case.stops_at_end else [])
        goals += [(p, case.limit(p)) for p in case.breaks() if case.limit(p) < case.limit(p - HERE)]
        self.curves: list[tuple[float, Callable[[float], float]]] = []
        for place, speed in goals:
            if place > 0.0:
                self.curves.append((place, self._backwards(place, speed)))

    def _backwards(self, place: float, speed: float) -> Callable[[float], float]:
        marks = [p for p in self.case.breaks() if p < place] + [place]
        parts, w = [], speed * speed
        for high, low in zip(reversed(marks), [*reversed(marks[:-1]), 0.0], strict=True):
            found = solve_ivp(
                lambda s, _: [-2.0 * self.case.braking(s)],
                (high, low),
                [w],
                dense_output=True,
                **(TOLERANCES | {"max_step": 50.0}),
            )
            parts.append((low, high, found.sol))
            w = found.y[0, -1]

        def curve(s: float) -> float:
            for low, high, solution in parts:
                if low <= s <= high:
                    return float(solution(s)[0])
            return np.inf

        return curve

    def braked(self, s: float) -> float:
        return min((curve(s) for place, curve in self.curves if s <= place), default=np.inf)

    def square(self, s: float) -> float:
        return min(self.case.limit(s) ** 2, self.braked(s))


def run(case: Case) -> Journey:
    """Run the train to the end of its line."""
    ceiling, at = _Ceiling(case), Journey(v_mps=case.start_mps)
    stops = list(case.stops)
    while at.s_m < case.end_m - HERE:
        until = next(p for p in case.breaks() if p > at.s_m + HERE)
        if at.v_mps**2 < ceiling.square(at.s_m + HERE) - 1e-4 or at.v_mps == 0.0:
            _accelerate(case, ceiling, at, until)
        elif ceiling.braked(at.s_m + HERE) < case.limit(at.s_m + HERE) ** 2 - 1e-6:
            _brake(case, ceiling, at, until)
        elif case.effort(at.v_mps) < case.drag(at.s_m + HERE, at.v_mps):
            _accelerate(case, ceiling, at, until)
        else:
            _cruise(case, ceiling, at, until)
        if stops and at.s_m >= stops[0][0] - 100 * HERE and at.v_mps == 0.0:
            at.arrivals_s.append(at.time_s)
            at.s_m = stops[0][0]
            at.time_s += stops.pop(0)[1]
    return at


def _integrate(case: Case, at: Journey, effort: Callable[[float, float], float], events: list, pull: Callable) -> None:
    def rates(_: float, y: np.ndarray) -> list[float]:
        s, v, _e = y
        force = effort(s, v)
        return [v, pull(s, v, force), max(force, 0.0) * v]

    for event in events:
        event.terminal = True
    found = solve_ivp(rates, (0.0, 1e5), [at.s_m, at.v_mps, 0.0], events=events, **TOLERANCES)
    at.time_s += found.t[-1]
    at.s_m, at.v_mps = float(found.y[0, -1]), float(found.y[1, -1])
    at.wheel_j += float(found.y[2, -1])


def _accelerate(case: Case, ceiling: _Ceiling, at: Journey, until: float) -> None:
    def meets(_: float, y: np.ndarray) -> float:
        return ceiling.square(min(y[0], until - HERE)) - y[1] ** 2

    def passes(_: float, y: np.ndarray) -> float:
        return y[0] - until

    meets.direction, passes.direction = -1.0, 1.0  # type: ignore[attr-defined]
    _integrate(case, at, lambda _s, v: case.effort(v), [meets, passes], lambda s, v, f: (f - case.drag(s, v)) / case.inertia_kg)


def _cruise(case: Case, ceiling: _Ceiling, at: Journey, until: float) -> None:
    v = at.v_mps = case.limit(at.s_m + HERE)
    ends = [until]
    for place, curve in ceiling.curves:
        if place > at.s_m + HERE and curve(at.s_m + HERE) > v * v > curve(min(until, place)):
            ends.append(brentq(lambda s, curve=curve: curve(s) - v * v, at.s_m + HERE, min(until, place), xtol=1e-9))
    low, high = at.s_m, min(ends)
    lacking = lambda s: case.effort(v) - case.drag(s, v)  # noqa: E731
    if lacking(high) < 0.0 < lacking(low + HERE):
        high = brentq(lacking, low + HERE, high, xtol=1e-9) + 2 * HERE
    grid = np.linspace(low, high, 2001)  # the slope is linear between breaks: the trapezoid rule is exact but at kinks
    at.wheel_j += float(np.trapezoid([max(case.drag(s, v), 0.0) for s in grid], grid))
    at.time_s += (high - low) / v
    at.s_m = high


def _brake(case: Case, ceiling: _Ceiling, at: Journey, until: float) -> None:
    at.v_mps = np.sqrt(ceiling.square(at.s_m))
    goal = np.sqrt(max(ceiling.braked(until), 0.0))
    if goal < 1e-3:
        stands = lambda _, y: y[1]  # noqa: E731
        stands.direction = -1.0  # type: ignore[attr-defined]
        ends = [stands]
    else:
        passes = lambda _, y: y[0] - until  # noqa: E731
        passes.direction = 1.0  # type: ignore[attr-defined]
        ends = [passes]
    _integrate(
        case,
        at,
        lambda s, v: max(case.drag(s, v) - case.inertia_kg * case.braking(s), 0.0),
        ends,
        lambda s, _v, _f: -case.braking(s),
    )
    if goal < 1e-3:
        at.v_mps = 0.0

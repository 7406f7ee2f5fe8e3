"""Legs of a run, from stop to stop, as stages for the planner; and the ways that prices of time lead to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.eco import (
    CONTROLS,
    ECO,
    MODES,
    STAGE,
    cost_of,
    follow,
    keep_to_effort,
    lay_choices,
    lay_floors,
    lay_slopes,
    sweep,
)
from tractionpower.kernels.eco_drive import COLUMNS, tabulate_drive
from tractionpower.kernels.train_tables import MOVER, POWERED
from tractionpower.movement.compile import Movement
from tractionpower.movement.drives import NO_LIMIT

Floats = NDArray[np.float64]

SHORTEST_M, LONGEST_M, STAGES = 25.0, 60.0, 100
"""Stages are as long as a leg over a number of them, between two lengths [m]: on short legs each counts for more."""

NEAR_STOPS_M = (1.0, 3.0, 6.0, 10.0, 16.0, 25.0, 40.0, 60.0, 90.0, 130.0)
"""Ends of stages from a stop [m]."""

ROW_MPS, LEVEL_MPS = 0.1, 0.15
"""Between rows of a drive over speed, and between levels of the value [m/s]."""

SWITCH_S = 0.03
"""What a change between effort, holding, coasting and braking costs, as a time [s]."""

VOLTAGES = 12
"""Voltages of a profile for which drives are tabulated."""

_SLOPE_M = 25.0  # changes of slope nearer to each other share a stage, whose resistance is their mean
_SAME_M = 1e-6
_SAME_V = 1e-9
_SAME_W = 1e-6
_MEAN_OF = 201


@dataclass(frozen=True, eq=False)
class Supplies:
    """What feeds a train along a route.

    Attributes
    ----------
    from_m, lines
        From each place on [m]: voltage [V], 0 without power, and current limit [A].
    voltage
        The voltage as given, for what is fed back: rows (distance of the front [m], voltage [V]).
    """

    from_m: Floats
    lines: tuple[tuple[float, float], ...]
    voltage: Floats


def supplies_of(movement: Movement, k: int, voltage: Floats) -> Supplies:
    """Return the supplies along the route of train `k`; `voltage` has rows (distance of the front [m], voltage [V])."""
    tables = movement.tables
    train = tables.trains[k]
    limits = tables.limits[train["first_limit"] : train["first_limit"] + train["limits"]]
    offs = tables.points[train["first_off"] : train["first_off"] + train["offs"]]
    places = np.unique(np.concatenate(([0.0], limits["from_m"], offs["x"], _voltage_marks(voltage))))
    places = places[(places >= 0.0) & (places < train["route_m"])]
    ends = np.append(places[1:], train["route_m"])
    u = np.interp(0.5 * (places + ends), voltage[:, 0], voltage[:, 1])
    fed = u > _SAME_V
    if fed.any() and np.ptp(u[fed]) > _SAME_V:
        low, high = float(u[fed].min()), float(u[fed].max())
        u = np.where(fed, low + np.round((u - low) / (high - low) * (VOLTAGES - 1)) / (VOLTAGES - 1) * (high - low), u)
    amps = np.full(len(places), NO_LIMIT)
    if len(limits):
        amps = limits["max_a"][np.searchsorted(limits["from_m"], places, side="right").clip(1) - 1]
    if len(offs):
        u = np.where(offs["y"][np.searchsorted(offs["x"], places, side="right").clip(1) - 1] == POWERED, u, 0.0)
    lines = list(zip(u.tolist(), amps.tolist(), strict=True))
    first = [n for n in range(len(lines)) if n == 0 or lines[n] != lines[n - 1]]
    return Supplies(places[first], tuple(lines[n] for n in first), voltage)


def eco_record(train: np.void, voltage: Floats, returned: float, slowest_mps: float) -> NDArray[np.void]:
    """Return one record of `ECO`: `returned` is the share of what is taken from the brake that counts.

    Heating is that at the mean of the voltage over the route.
    """
    at = np.linspace(0.0, float(train["route_m"]), _MEAN_OF)
    u = float(np.sqrt(np.mean(np.interp(at, voltage[:, 0], voltage[:, 1]) ** 2)))
    eco = np.zeros(1, ECO)
    for name in ("inertia_kg", "a_n", "b_ns_per_m", "c_ns2_per_m2"):
        eco[name] = train[name]
    eco["own_w"] = train["auxiliary_w"] + train["heating_s"] * u * u
    eco["gain"] = train["brake_efficiency"] if train["regenerates"] else 0.0
    eco["back"] = returned
    eco["slow_w"], eco["dv"], eco["level_v"] = slowest_mps**2, ROW_MPS, LEVEL_MPS
    return eco


def drive_table(movement: Movement, k: int, lines: tuple[float, float]) -> Floats:
    """Return effort, brake and power over speed of train `k` on a supply (voltage [V], current [A])."""
    top = movement.runs[k].formation.max_mps
    drive = np.zeros((int(top / ROW_MPS) + 3, COLUMNS))
    tabulate_drive(movement.tables, k, np.zeros(1, MOVER), lines, ROW_MPS, drive)
    return drive


def taken_share(train: np.void, u: Floats) -> Floats:
    """Return which share of what a brake feeds back is taken at voltages [V]: its current folds back."""
    width = max(float(train["fold_to_v"] - train["fold_from_v"]), _SAME_V)
    return np.asarray(np.clip((float(train["fold_to_v"]) - u) / width, 0.0, 1.0))


def _voltage_marks(voltage: Floats) -> Floats:
    """Return places between which a voltage is taken as its mean: regular ones, and the ends of its steep stretches [m]."""
    if len(voltage) == 1:
        return np.zeros(0)
    steep = np.abs(np.diff(voltage[:, 1])) > np.ptp(voltage[:, 1]) / (2.0 * VOLTAGES)
    short = np.diff(voltage[:, 0]) < 4.0 * LONGEST_M
    ends = np.append(steep & short, False) | np.append(False, steep & short)
    return np.concatenate((np.arange(voltage[0, 0], voltage[-1, 0], 4.0 * LONGEST_M), voltage[ends, 0]))


@dataclass(frozen=True, eq=False)
class Way:
    """A way through the stages of a leg.

    Attributes
    ----------
    squares
        Squares of the speed at the ends of stages, one more than stages [m2/s2].
    times
        Time of each stage [s].
    """

    squares: Floats
    times: Floats


@dataclass(eq=False)
class LegModel:
    """A leg as stages, with the ways that have been found for it.

    Attributes
    ----------
    eco, drives
        The train: one record of `ECO`, and tables of its drive.
    stages
        Records of `STAGE`; places are counted from the start of the leg.
    ceilings
        Squares of the speed ceiling at the ends of stages, the lower one where it jumps [m2/s2].
    starts
        Squares of the speed ceiling just behind the start of each stage [m2/s2].
    start_w
        Square of the speed at its start [m2/s2].
    """

    eco: NDArray[np.void]
    drives: Floats
    stages: NDArray[np.void]
    ceilings: Floats
    starts: Floats
    start_w: float
    _choices: Floats | None = None
    _ways: dict[tuple[float, ...], Way] = field(default_factory=dict)

    def way(self, prices: tuple[float, ...]) -> Way:
        """Return the best way for prices of time by part [W]; an infinite one anywhere: the greatest effort everywhere."""
        if prices not in self._ways:
            self._ways[prices] = self._find(np.array(prices))
        return self._ways[prices]

    def _find(self, prices: Floats) -> Way:
        count, levels = len(self.stages), int(np.sqrt(self.ceilings.max()) / LEVEL_MPS) + 3
        value = np.zeros((0, MODES, levels))
        if np.isfinite(prices).all():
            if self._choices is None:
                self._choices = np.zeros((count, levels, CONTROLS, 3))
                lay_floors(self.stages, self.ceilings, self.drives, self.eco)
                lay_choices(self.stages, self.ceilings, self.drives, self.eco, self._choices)
            value = np.zeros((count + 1, MODES, levels))
            sweep(self.stages, self.ceilings, self.eco, self._choices, prices, SWITCH_S, value)
        squares = np.zeros(count + 1)
        squares[0] = min(self.start_w, self.ceilings[0])
        follow(self.stages, self.ceilings, self.drives, self.eco, prices, value, SWITCH_S, squares)
        return Way(squares, self.times(squares))

    def within_effort(self, squares: Floats) -> Floats:
        """Return squares of the speed, lowered to what the greatest effort comes to [m2/s2]."""
        keep_to_effort(self.stages, self.drives, self.eco, squares)
        return squares

    def times(self, squares: Floats) -> Floats:
        """Return the time of each stage [s] for squares of the speed at their ends."""
        speeds = np.sqrt(squares)
        return np.asarray(2.0 * self.stages["length_m"] / np.maximum(speeds[1:] + speeds[:-1], 1e-6))

    def cost(self, squares: Floats) -> tuple[float, Floats, Floats]:
        """Return net energy without auxiliaries [J], force of each stage [N], and its share of the greatest effort."""
        efforts, shares = np.zeros(len(self.stages)), np.zeros(len(self.stages))
        energy = cost_of(self.stages, self.drives, self.eco, squares, efforts, shares)
        return float(energy), efforts, shares


def cut_stages(
    movement: Movement, k: int, pieces: NDArray[np.void], supplies: Supplies, ends: tuple[float, float], marks: Sequence[float]
) -> tuple[NDArray[np.void], Floats, Floats]:
    """Return the stages of a leg, by places of the route and number of the supply, and `LegModel.ceilings` and `starts`.

    Parameters
    ----------
    pieces
        Speed ceiling of the whole run.
    supplies
        Supplies along the route.
    ends
        Where the leg begins and ends [m].
    marks
        Places inside it at which the price of time changes [m].
    """
    tables = movement.tables
    train = tables.trains[k]
    knots = tables.knots[train["first_knot"] : train["first_knot"] + train["knots"]]["at_m"]
    places = _places((pieces["from_m"], supplies.from_m, np.array(marks, float)), knots, float(train["spread_m"]), ends)
    stages = np.zeros(len(places) - 1, STAGE)
    stages["from_m"], stages["length_m"] = places[:-1], np.diff(places)
    middles = 0.5 * (places[1:] + places[:-1])
    stages["drive"] = np.searchsorted(supplies.from_m, middles, side="right") - 1
    stages["part"] = np.searchsorted(np.array(marks, float), middles, side="right")
    stages["back"] = taken_share(train, np.interp(middles, supplies.voltage[:, 0], supplies.voltage[:, 1]))
    lay_slopes(tables, k, np.zeros(1, MOVER), stages)
    return stages, *_ceilings(pieces, places)


def _ceilings(pieces: NDArray[np.void], places: Floats) -> tuple[Floats, Floats]:
    """Return the lower of the ceilings just before and just behind each place, and those behind; of a leg only what is inside."""
    sides = []
    for shift in (-_SAME_M, _SAME_M):
        n = (np.searchsorted(pieces["from_m"], places + shift, side="right") - 1).clip(0, max(len(pieces) - 2, 0))
        w = pieces["w"][n] + pieces["dw"][n] * (places - pieces["from_m"][n])
        sides.append(np.where(w > _SAME_W, w, 0.0))
    before, behind = sides
    found = np.minimum(before, behind)
    found[0], found[-1] = behind[0], before[-1]
    return found, behind[:-1]


def _places(fixed_m: tuple[Floats, ...], knots_m: Floats, spread_m: float, ends: tuple[float, float]) -> Floats:
    """Return the ends of stages: all of `fixed_m`, and changes of slope that are not too near to each other."""
    first, last = ends
    near = np.array(NEAR_STOPS_M)
    near = near[near < 0.5 * (last - first)]
    fixed = np.concatenate((*fixed_m, first + near, last - near))
    fixed = np.unique(np.concatenate(([first, last], fixed[(fixed > first) & (fixed < last)])))
    fixed = fixed[np.append(True, np.diff(fixed) > _SAME_M)]
    fixed[-1] = last
    slopes = np.union1d(knots_m, knots_m + spread_m)
    slopes = slopes[(slopes > first) & (slopes < last)]
    right = np.searchsorted(fixed, slopes).clip(1, len(fixed) - 1)
    slopes = slopes[np.minimum(fixed[right] - slopes, slopes - fixed[right - 1]) > _SLOPE_M]
    kept: list[float] = []
    for place in slopes.tolist():
        if not kept or place - kept[-1] > _SLOPE_M:
            kept.append(place)
    places = np.union1d(fixed, np.array(kept))
    longest = min(max((last - first) / STAGES, SHORTEST_M), LONGEST_M)
    counts = np.ceil(np.diff(places) / longest).astype(int).clip(1)
    starts = np.repeat(places[:-1], counts)
    steps = np.repeat(np.diff(places) / counts, counts)
    number = np.arange(len(starts)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.append(starts + steps * number, last)

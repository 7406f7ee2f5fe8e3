"""The trains of a scenario as the tables that kernels work on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tractionpower.alignment.axis import TrackAxis, compile_axes
from tractionpower.alignment.path import RoutePath, compile_path
from tractionpower.alignment.routes import stop_distance
from tractionpower.kernels.train_tables import (
    INVERTER,
    KNOT,
    LEAVE,
    LINE_LIMIT,
    PIECE,
    POWERED,
    STAY,
    STOP,
    STOP_THERE,
    TRAIN,
    TURN,
    TrainTables,
)
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.limits import Limit, SystemVoltages, find_limit, system_voltages
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import Call, Leg, TrainRun
from tractionpower.model.vehicle import Train
from tractionpower.movement.ceiling import compile_ceiling
from tractionpower.movement.drives import NO_LIMIT, DrivePools, compile_drive, pool_arrays
from tractionpower.movement.formation import KMH, Formation, form
from tractionpower.movement.pools import Pool
from tractionpower.movement.turns import link_turns

AT_START_M = 1e-3
"""A call this near to the start of the route is where the run begins, not where it ends [m]."""

KNEE_FACTOR = 0.9
"""Knee factor where the limits table has none for a system (EN 50388 as recalled)."""


@dataclass(frozen=True, slots=True)
class PlannedCall:
    """A call of a run on its route: the call, and where the front stops or passes [m]."""

    call: Call
    at_m: float


@dataclass(frozen=True)
class PlannedRun:
    """A run of the timetable on its route.

    Attributes
    ----------
    run, train, formation
        The run as declared, its train, and the train as one mass.
    path
        Its route, not shortened.
    calls
        Its calls in order.
    route_m
        Where the run ends [m]: at its last call if it stops there for good, else at the end of the route.
    end
        `LEAVE`, `STOP_THERE` or `STAY`.
    start_s, start_mps
        Time and speed at the start of the route.
    """

    run: TrainRun
    train: Train
    formation: Formation
    path: RoutePath
    calls: tuple[PlannedCall, ...]
    route_m: float
    end: int
    start_s: float
    start_mps: float


@dataclass(frozen=True)
class Movement:
    """The trains of a scenario: tables for kernels, and the runs they come from, in the same order (by identifier)."""

    tables: TrainTables
    runs: tuple[PlannedRun, ...]
    voltages: SystemVoltages

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Identifiers of the runs."""
        return tuple(planned.run.id for planned in self.runs)


def compile_trains(scenario: Scenario, runs: Sequence[str] | None = None) -> Movement:
    """Return the trains of a scenario in order, of which `check_movement` has found no errors.

    Parameters
    ----------
    scenario
        The scenario.
    runs
        Identifiers of the runs to take; left out: all.
    """
    voltages = system_voltages(scenario.limits, scenario.supply.system)
    chosen = sorted((run for run in scenario.runs if runs is None or run.id in runs), key=lambda run: run.id)
    planned = plan_runs(scenario, chosen)
    knee = knee_factor(scenario.limits, scenario.supply.system)
    pools, rows = _Pools(), []
    for item in planned:
        rows.append(_train_row(item, voltages, knee, scenario.coast_without_voltage_s, pools))
    tables = pools.tables(np.array(rows, TRAIN) if rows else np.zeros(0, TRAIN))
    tables = link_turns(tables, [item.run.id for item in planned], scenario.timetable)
    return Movement(tables, tuple(planned), voltages)


def knee_factor(limits: Sequence[Limit], system: str) -> float:
    """Return the share of the nominal voltage below which inverter drives reduce their current."""
    limit = find_limit(limits, system, "knee_factor")
    return limit.value if limit is not None else KNEE_FACTOR


def train_of(run: TrainRun, trains: Sequence[Train]) -> Train:
    """Return the train of a run; one that is given by its vehicles gets the identifier of the run."""
    if run.train is None:
        return Train(id=run.id, category=run.category, vehicles=run.vehicles)
    return next(train for train in trains if train.id == run.train)


class Routes:
    """The routes of runs as paths, each compiled once for the trains of a category.

    Parameters
    ----------
    line, axes
        The line and its tracks.
    behind_m
        Length of the longest train [m], whose tail stands behind the start of its route.
    """

    def __init__(self, line: Line, axes: Mapping[str, TrackAxis], behind_m: float) -> None:
        self._line, self._axes, self._behind_m = line, axes, behind_m
        self._paths: dict[tuple[tuple[Leg, ...], str | None], RoutePath] = {}

    def path(self, run: TrainRun, train: Train | None) -> RoutePath:
        """Return the path of a run; its category, or else that of its train, chooses the speed limits."""
        category = run.category if run.category is not None or train is None else train.category
        key = (run.route, category)
        if key not in self._paths:
            self._paths[key] = compile_path(self._line, self._axes, run.route, category, self._behind_m)
        return self._paths[key]


def plan_runs(scenario: Scenario, runs: Sequence[TrainRun]) -> list[PlannedRun]:
    """Return `runs` on their routes; runs of one route and category share its path."""
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    trains = [train_of(run, scenario.trains) for run in runs]
    formations = [form(train, vehicles) for train in trains]
    behind = max((formation.length_m for formation in formations), default=0.0)
    routes = Routes(scenario.line, compile_axes(scenario.line), behind)
    return [
        plan_run(run, train, formation, routes.path(run, train), scenario.line)
        for run, train, formation in zip(runs, trains, formations, strict=True)
    ]


def plan_run(run: TrainRun, train: Train, formation: Formation, path: RoutePath, line: Line) -> PlannedRun:
    """Return a run on its route; calls that the route does not come to are left out from the first of them on."""
    calls = place_calls(run, path, line)
    stops_last = bool(calls) and calls[-1].call.stops and calls[-1].at_m > AT_START_M
    end = {"leave": LEAVE, "stop": STOP_THERE, "stay": STAY, None: STOP_THERE if stops_last else LEAVE}[run.end]
    route_m = calls[-1].at_m if stops_last and end != LEAVE else path.length_m
    start_mps = run.start.speed_kmh / KMH if run.start is not None else 0.0
    return PlannedRun(run, train, formation, path, calls, route_m, end, start_time(run), start_mps)


def start_time(run: TrainRun) -> float:
    """Return when a run begins [s]."""
    start_s = run.start.time if run.start is not None else run.calls[0].departure
    assert start_s is not None  # a rule of the declaration
    return start_s


def place_calls(run: TrainRun, path: RoutePath, line: Line) -> tuple[PlannedCall, ...]:
    """Return the calls of a run, each behind the one before, up to the first that its route does not come to."""
    stations = {station.id: station for station in line.stations}
    placed: list[PlannedCall] = []
    for call in run.calls:
        at = stop_distance(path, stations[call.station], from_m=placed[-1].at_m if placed else 0.0)
        if at is None:
            break
        placed.append(PlannedCall(call, at))
    return tuple(placed)


class _Pools(DrivePools):
    """All pools of the train tables."""

    def __init__(self) -> None:
        super().__init__()
        self.knots, self.pieces = Pool(KNOT), Pool(PIECE)
        self.limits = Pool(LINE_LIMIT)
        self.stops: list[tuple[float, float, float, bool]] = []

    def tables(self, trains: Any) -> TrainTables:
        return TrainTables(
            trains=trains,
            knots=self.knots.array(),
            pieces=self.pieces.array(),
            stops=np.array(self.stops, STOP) if self.stops else np.zeros(0, STOP),
            limits=self.limits.array(),
            turns=np.zeros(0, TURN),
            **pool_arrays(self),
        )


def _train_row(item: PlannedRun, voltages: SystemVoltages, knee: float, coast_s: float, pools: _Pools) -> tuple[Any, ...]:
    mass = item.formation
    columns: dict[str, Any] = {
        "mass_kg": mass.mass_kg,
        "inertia_kg": mass.inertia_kg,
        "spread_m": mass.spread_m,
        "a_n": mass.a_n,
        "b_ns_per_m": mass.b_ns_per_m,
        "c_ns2_per_m2": mass.c_ns2_per_m2,
        "lowest_v": voltages.u_min2,
        "nominal_v": voltages.u_n,
        "auxiliary_w": mass.auxiliary_w,
        "heating_s": mass.heating_w / voltages.u_n**2,
        "service_mps2": mass.service_rate_mps2,
        "coast_s": coast_s,
        "route_m": item.route_m,
        "start_s": item.start_s,
        "start_mps": item.start_mps,
        "end": item.end,
    }
    columns |= compile_drive(mass, voltages, knee, pools)
    if item.run.max_power_kw is not None and columns["drive"] == INVERTER:  # the checks refuse it for other drives
        columns["power_w"] = min(columns["power_w"], item.run.max_power_kw * 1e3)
    columns["first_knot"], columns["knots"] = pools.knots.add(_knots(item))
    columns["first_piece"], columns["pieces"] = pools.pieces.add(ceiling_of(item))
    columns["first_limit"], columns["limits"] = pools.limits.add(_line_limits(item))
    columns["first_off"], columns["offs"] = pools.points.add(_power_off(item.path))
    columns["first_stop"], columns["stops"] = len(pools.stops), len(item.calls)  # calls are written to: never shared
    pools.stops += [_stop(planned) for planned in item.calls]
    return tuple(columns.get(name, 0) for name in TRAIN.names or ())


def _knots(item: PlannedRun) -> Any:
    path, (single, double) = item.path, item.formation.tunnel
    knots = np.zeros(len(path.at_m), KNOT)
    height = path.height_m + path.curve_m + single[0] * path.single_tunnel_m + double[0] * path.double_tunnel_m
    knots["at_m"], knots["height_m"] = path.at_m, height
    knots["drag_kg"] = single[1] * path.single_tunnel_m + double[1] * path.double_tunnel_m
    return knots


def ceiling_of(item: PlannedRun, share: float = 1.0, max_mps: float = np.inf) -> Any:
    """Return the speed ceiling of a run, as records of PIECE up to the end of the run.

    `share` lowers all limits, `max_mps` is a greatest speed beside that of the train [m/s].
    """
    mass, path = item.formation, item.path
    stops = [planned.at_m for planned in item.calls if planned.call.stops]
    pieces = compile_ceiling(
        path if share == 1.0 else replace(path, limit_mps=share * path.limit_mps),
        length_m=mass.length_m,
        max_mps=min(share * mass.max_mps, max_mps),
        rate_mps2=mass.service_rate_mps2,
        weight_per_inertia=mass.mass_kg * GRAVITY / mass.inertia_kg,
        spread_m=mass.spread_m,
        stops_m=[*stops, *([item.route_m] if item.end != LEAVE else [])],
        end_stops=item.end != LEAVE and item.route_m == path.length_m,
    )
    inside = pieces[pieces["from_m"] < item.route_m]
    last = np.zeros(1, PIECE)
    last["from_m"] = item.route_m
    last["w"] = inside["w"][-1] + inside["dw"][-1] * (item.route_m - inside["from_m"][-1])
    return np.concatenate((inside, last))


def _line_limits(item: PlannedRun) -> Any:
    """Return the largest train currents along the route; while the train moves that of its run holds as well."""
    path, own_a = item.path, item.run.max_current_a
    if own_a is None and not np.isfinite([*path.max_current_a, *path.standstill_current_a]).any():
        return []
    rows = np.zeros(len(path.current_from_m), LINE_LIMIT)
    rows["from_m"] = path.current_from_m
    rows["max_a"] = np.minimum(path.max_current_a, NO_LIMIT if own_a is None else own_a)
    still = np.where(np.isfinite(path.standstill_current_a), path.standstill_current_a, path.max_current_a)
    rows["standstill_a"] = np.minimum(still, NO_LIMIT)
    return rows


def _power_off(path: RoutePath) -> Any:
    if (path.power_kind == POWERED).all():
        return []
    return list(zip(path.power_from_m.tolist(), path.power_kind.tolist(), strict=True))


def _stop(planned: PlannedCall) -> tuple[float, float, float, bool]:
    departure = planned.call.departure
    return planned.at_m, -np.inf if departure is None else departure, planned.call.min_dwell_s, planned.call.stops

"""Checks of a run on its route: calls, speed limits, contact line, start, and what its train can climb and hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.checks import Axes
from tractionpower.alignment.intervals import Coverage, Interval, name_km, subtract
from tractionpower.alignment.path import RoutePath
from tractionpower.alignment.routes import check_route, check_speed_limits, name_stretches, stop_distance
from tractionpower.errors import Problem, Severity
from tractionpower.kernels.train_tables import POWERED
from tractionpower.kernels.wayside import HERE_M
from tractionpower.model.driving import Driving
from tractionpower.model.limits import SystemVoltages
from tractionpower.model.line import Line, Station
from tractionpower.model.timetable import Call, Leg, TrainRun
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.ceiling import LOWEST_SHARE
from tractionpower.movement.climbing import find_stall, hard_stretches, least_braking, starting_effort_n
from tractionpower.movement.compile import PlannedRun, Routes, ceiling_of, plan_run, train_of
from tractionpower.movement.driving.checks import check_driving
from tractionpower.movement.formation import KMH, Formation, form
from tractionpower.movement.stock_checks import auxiliary_current_a, check_train
from tractionpower.movement.telling import doubt, listed, unknown
from tractionpower.movement.timetable_checks import check_times

_TOO_FAST_MPS = 1e-6
_SHOWN = 4


@dataclass(frozen=True, slots=True)
class Site:
    """What the checks of all runs share.

    Attributes
    ----------
    line, axes
        The line and its tracks.
    trains, vehicles
        The rolling stock by identifier.
    faulty_vehicles, faulty_trains
        Identifiers of those in which errors were found.
    voltages
        Voltage limits of the system; None if some are missing.
    contact
        Where rows of the contact line lie.
    routes
        The routes of runs as paths.
    driving
        How trains are driven that do not say it.
    bare
        What of a route has no contact line, once it was asked for.
    """

    line: Line
    axes: Axes
    trains: Mapping[str, Train]
    vehicles: Mapping[str, Vehicle]
    faulty_vehicles: frozenset[str]
    faulty_trains: frozenset[str]
    voltages: SystemVoltages | None
    contact: Coverage
    routes: Routes
    driving: Driving | None = None
    bare: dict[tuple[Leg, ...], list[str]] = field(default_factory=dict)


def check_run(path: str, run: TrainRun, site: Site) -> list[Problem]:
    """Return everything that is wrong or doubtful with a run, which stands at `path` of the model."""
    problems = check_train(f"{path}.vehicles", run.vehicles, site.vehicles, site.voltages)
    if run.train is not None and run.train not in site.trains:
        problems.append(unknown("train", f"{path}.train", run.train, site.trains, "name a train that exists"))
    stations = {station.id: station for station in site.line.stations}
    remedy = "name a station of the line, or add it to line.stations"
    for k, call in enumerate(run.calls):
        if call.station not in stations:
            problems.append(unknown("station", f"{path}.calls[{k}].station", call.station, stations, remedy))
    problems += check_times(path, run)
    faults = check_route(f"{path}.route", run.route, site.line, site.axes)
    problems += faults
    if any(problem.severity == "error" for problem in faults):
        return problems
    train = _train(run, site)
    route = site.routes.path(run, train)
    misplaced, calls = _place_calls(path, run, route, stations)
    problems += misplaced
    if train is None:
        return problems
    problems += check_speed_limits(f"{path}.route", route)
    formation = form(train, site.vehicles)
    problems += _check_contact_line(path, run, route, formation, site)
    if calls == run.calls:
        return problems + _check_planned(path, plan_run(run, train, formation, route, site.line), site)
    if run.start is not None:  # where it stops is not known, how fast it may start is
        planned = plan_run(run.model_copy(update={"calls": calls, "end": "leave"}), train, formation, route, site.line)
        problems += _check_start(path, planned, float(ceiling_of(planned)["w"][0]))
    return problems


def _train(run: TrainRun, site: Site) -> Train | None:
    """Return the train of a run, or None if it or one of its vehicles does not exist."""
    if run.train is not None and run.train not in site.trains:
        return None
    train = train_of(run, tuple(site.trains.values()))
    return train if all(part.id in site.vehicles for part in train.vehicles) else None


def _place_calls(
    path: str, run: TrainRun, route: RoutePath, stations: Mapping[str, Station]
) -> tuple[list[Problem], tuple[Call, ...]]:
    """Return the calls that the route does not come to, or not in this order, and those that it does come to."""
    problems: list[Problem] = []
    placed: list[Call] = []
    at_m = 0.0
    for k, call in enumerate(run.calls):
        where, before = f"{path}.calls[{k}].station", placed[-1].station if placed else ""
        if call.station not in stations:  # told already
            continue
        found = stop_distance(route, stations[call.station], from_m=at_m)
        if call.station == before:
            remedy = "make it one call, or leave one out"
            problems.append(Problem("same_call_twice", where, f"{before}, as the call before", "another station", remedy))
        elif found is not None:
            at_m = found
            placed.append(call)
        elif stop_distance(route, stations[call.station]) is None:
            remedy = "correct the route, the station, or the tracks and stop_km of the station"
            problems.append(Problem("off_route", where, f"the route does not come to {call.station}", remedy=remedy))
        else:
            text, remedy = f"the route comes to {call.station} before {before}", "put the calls in the order of the route"
            problems.append(Problem("call_order", where, text, remedy=remedy))
    return problems, tuple(placed)


def _check_contact_line(path: str, run: TrainRun, route: RoutePath, formation: Formation, site: Site) -> list[Problem]:
    """Return an error if parts of the route have no contact line, and the train wants current."""
    if formation.driver is None and formation.auxiliary_w + formation.heating_w == 0.0:
        return []
    if run.route not in site.bare:
        site.bare[run.route] = name_stretches(route, list(_without_contact_line(route, site.contact)))
    bare = site.bare[run.route]
    if not bare:
        return []
    found = f"the train finds no contact line on {listed(bare, _SHOWN)}"
    remedy = "add a row to supply.contact_lines, or correct the route"
    return [Problem("no_contact_line", f"{path}.route", found, remedy=remedy)]


def _without_contact_line(route: RoutePath, contact: Coverage) -> Iterator[Interval]:
    """Yield the stretches of a route without contact line [m]."""
    for leg in route.legs:
        ends = sorted((leg.from_track_m, leg.from_track_m + leg.sign * leg.length_m))
        wired = [(part.start_m, part.end_m) for part in contact.get(leg.axis.track, ())]
        for gap in subtract([(ends[0], ends[1])], wired):
            low, high = sorted(leg.start_m + leg.sign * (end - leg.from_track_m) for end in gap)
            yield low, high


def _check_planned(path: str, planned: PlannedRun, site: Site) -> list[Problem]:
    ceiling = ceiling_of(planned)
    problems = [*_check_start(path, planned, float(ceiling["w"][0])), *_check_brakes(path, planned)]
    problems += _check_line_current(path, planned, site.voltages)
    problems += check_driving(path, planned, site.driving)
    if planned.formation.driver is None:
        return [*problems, _no_drive(path, planned, ceiling)]
    problems += _check_power_off(path, planned)
    if site.voltages is None or not _is_sound(planned, site):
        return problems
    return problems + _check_climb(path, planned, ceiling, starting_effort_n(planned.formation, site.voltages))


def _is_sound(planned: PlannedRun, site: Site) -> bool:
    """Tell whether train and vehicles of a run have no errors, so that its effort can be computed."""
    names = {part.id for part in planned.train.vehicles}
    faults = check_train("", planned.run.vehicles, site.vehicles)
    return (
        names.isdisjoint(site.faulty_vehicles)
        and planned.run.train not in site.faulty_trains
        and not any(problem.severity == "error" for problem in faults)
    )


def _check_start(path: str, planned: PlannedRun, ceiling_w: float) -> Iterator[Problem]:
    """Yield what is wrong with the speed at the start; `ceiling_w` is the square of the greatest one there [m2/s2]."""
    if planned.start_mps == 0.0:
        return
    where, speed = f"{path}.start.speed_kmh", f"{planned.start_mps * KMH:g} km/h"
    first = planned.calls[0] if planned.calls else None
    if first is not None and first.call.stops and first.at_m == 0.0:
        remedy = "leave the speed out, let the route begin farther back, or write stops: false"
        yield Problem("start_at_stop", where, f"{speed} at {first.call.station}, where the train stops", "0", remedy)
        return
    ceiling = float(np.sqrt(max(ceiling_w, 0.0)))
    if planned.start_mps > ceiling + _TOO_FAST_MPS:
        allowed = f"up to {np.floor(ceiling * KMH * 1e3) / 1e3:g} km/h, by limits and braking curves"
        remedy = "lower it, or let the route begin farther back"
        yield Problem("start_too_fast", where, f"{speed}, faster than the train may run there", allowed, remedy)


def _check_brakes(path: str, planned: PlannedRun) -> Iterator[Problem]:
    """Yield a warning if the service brake leaves less than its least share on the steepest fall."""
    at_m, left, permille = least_braking(planned)
    rate = planned.formation.service_rate_mps2
    if left > LOWEST_SHARE * rate:
        return
    track, km = planned.path.place(at_m)
    found = (
        f"a fall of {-permille:.1f} per mille under the train on track {track} at km {_km(km)} takes more than its"
        f" service brake of {rate:g} m/s2 has; the program brakes with {LOWEST_SHARE * rate:g} m/s2 there"
    )
    yield doubt("weak_brake", path, found, remedy="correct the gradients, or give a greater service_rate_mps2")


def _check_line_current(path: str, planned: PlannedRun, voltages: SystemVoltages | None) -> Iterator[Problem]:
    """Yield a warning if the line allows a train not even what its auxiliaries take."""
    if voltages is None or voltages.u_n <= 0.0 or planned.formation.driver is None:
        return
    taken, route = auxiliary_current_a(planned.formation, voltages.u_n), planned.path
    allowed = np.minimum(route.max_current_a, route.standstill_current_a)
    k = int(np.argmin(np.where(route.current_from_m < planned.route_m, allowed, np.inf)))
    if taken <= 0.0 or allowed[k] > taken:
        return
    track, km = route.place(float(route.current_from_m[k]))
    found = (
        f"the auxiliaries of the train take {taken:.0f} A at {voltages.u_n:g} V, the line allows {allowed[k]:g} A on track"
        f" {track} from km {_km(km)} on: nothing is left for traction"
    )
    yield doubt("no_traction", path, found, remedy="correct line.train_current_limits, or the auxiliaries")


def _check_power_off(path: str, planned: PlannedRun) -> Iterator[Problem]:
    """Yield a warning where the train stands and is to start, but gets no traction."""
    route = planned.path
    stops = [(call.at_m, f"stops at {call.call.station}") for call in planned.calls if call.call.stops]
    if planned.start_mps == 0.0 and not (stops and stops[0][0] <= HERE_M):
        stops.insert(0, (0.0, "starts from rest"))
    for at_m, what in stops:
        held = int(route.power_kind[np.searchsorted(route.power_from_m, at_m + HERE_M, side="right") - 1])
        if held == POWERED or at_m >= planned.route_m - HERE_M:
            continue
        track, km = route.place(at_m)
        found = f"the train {what}, on track {track} at km {_km(km)}, where it gets no traction to start again"
        yield doubt("stop_without_power", path, found, remedy="correct line.power_off, or the place where the train stops")


def _no_drive(path: str, planned: PlannedRun, ceiling: NDArray[np.void]) -> Problem:
    """Return that a train has no drive: an error if it starts from rest where it does not roll away."""
    stall = find_stall(planned, ceiling, 0.0)
    severity: Severity = "error" if stall is not None and planned.start_mps == 0.0 else "warning"
    found = "no vehicle of the train drives it"
    if stall is not None and stall.at_m > 0.0:
        track, km = planned.path.place(stall.at_m)
        found += f": it comes to a stand on track {track} at km {_km(km)} at the latest"
    return Problem("no_drive", path, found, remedy="add a vehicle with a drive, or set powered: true", severity=severity)


def _check_climb(path: str, planned: PlannedRun, ceiling: NDArray[np.void], effort_n: float) -> list[Problem]:
    """Return where the train surely gets stuck, or else where it could not start again."""
    remedy = "a lighter train, more effort, or correct gradients"
    stretches = hard_stretches(planned, effort_n)
    if not stretches:
        return []
    stall = find_stall(planned, ceiling, effort_n)
    if stall is not None:
        track, km = planned.path.place(stall.at_m)
        found = (
            f"the train cannot climb its line: {_why(planned, stall.from_m, stall.speed_mps)}, and is stuck on track {track}"
            f" at km {_km(km)} at the latest, held back by up to {stall.resistance_n / 1e3:.1f} kN against an effort of"
            f" {effort_n / 1e3:.1f} kN at most"
        )
        return [Problem("cannot_climb", path, found, remedy=remedy)]
    names = name_stretches(planned.path, [(low, high) for low, high, _ in stretches])
    most = max(resistance for *_, resistance in stretches)
    found = (
        f"having stopped on {listed(names, _SHOWN)} the train could not go on: it is held back by up to {most / 1e3:.1f} kN, its"
        f" greatest effort is {effort_n / 1e3:.1f} kN"
    )
    return [doubt("cannot_start", path, found, remedy=remedy)]


def _why(planned: PlannedRun, from_m: float, speed_mps: float) -> str:
    """Return from where and how fast a train comes to the place where it gets stuck."""
    track, km = planned.path.place(from_m)
    place = f"on track {track} at km {_km(km)}"
    if speed_mps > 1e-3:
        return f"it passes {place} with {speed_mps * KMH:.0f} km/h at most"
    stations = [call.call.station for call in planned.calls if call.call.stops and abs(call.at_m - from_m) < 1e-3]
    return f"it starts from rest {f'at {stations[-1]}, ' if stations else ''}{place}"


def _km(km: float) -> str:
    return name_km(round(km, 3))

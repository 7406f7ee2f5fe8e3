"""Checks of rotations, joins and splits: which runs they name, when and where one becomes the other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

from tractionpower.alignment.lines import tracks_by_line
from tractionpower.errors import Problem
from tractionpower.io.wording import shown
from tractionpower.kernels.train_tables import LEAVE
from tractionpower.kernels.wayside import HERE_M
from tractionpower.model.base import format_time
from tractionpower.model.scenario import Scenario
from tractionpower.model.services import DAY_BEFORE, run_names
from tractionpower.model.timetable import TrainRun
from tractionpower.movement.compile import PlannedRun, start_time
from tractionpower.movement.telling import doubt, listed, unknown
from tractionpower.movement.turns import Link, declared_links

_ROUNDING_S = 1e-3
_ROUNDING_KM = 1e-3


def check_turns(scenario: Scenario, planned: Mapping[str, PlannedRun]) -> list[Problem]:
    """Return what is wrong or doubtful with rotations, joins and splits.

    Parameters
    ----------
    scenario
        The scenario.
    planned
        Runs on their routes by identifier, as far as they have no errors; those of a service may share one.
    """
    links = list(declared_links(scenario.timetable))
    if not links:
        return []
    names = run_names(scenario.timetable)
    problems = list(_check_names(links, names))
    known = [link for link in links if link.first in names and link.then in names]
    for check in (_check_rotations, _check_once, _check_cycle):  # a link that cannot be is told for its first reason only
        told = list(check(known))
        problems += told
        known = _without(known, {problem.path for problem in told})
    runs = {run.id: run for run in scenario.runs if not run.id.endswith(DAY_BEFORE)}
    lines = tracks_by_line(scenario.line, scenario.supply)
    for link in known:
        first, then = runs.get(link.first), runs.get(link.then)
        if first is None or then is None:
            if then is not None:
                found = f"{link.first} does not run on this day: {link.then} begins by itself"
                problems.append(doubt("no_forerunner", link.path, found, remedy="give both the same days"))
            continue
        problems += _check_times(link, first, then)
        if link.kind == "rotation" and (first.train, first.vehicles) != (then.train, then.vehicles):
            found = f"{link.first} is a {_set(first)}, {link.then}, which it becomes, a {_set(then)}"
            problems.append(doubt("train_changes", link.path, found, remedy="a rotation keeps its train; correct one of them"))
        if link.first in planned and link.then in planned:
            problems += _check_place(link, planned[link.first], planned[link.then], lines)
    return problems


def _check_names(links: Sequence[Link], names: Mapping[str, object]) -> Iterator[Problem]:
    told = set()
    for link in links:
        places = [(link.path, link.then if link.kind != "join" else link.first)]
        root = link.path.rpartition(".")[0]
        if link.kind == "rotation":
            head, _, number = link.path.removesuffix("]").rpartition("[")
            places.insert(0, (f"{head}[{int(number) - 1}]", link.first))
        else:
            places.append(
                (f"{root}.{'into' if link.kind == 'join' else 'run'}", link.then if link.kind == "join" else link.first)
            )
        for path, name in places:
            if name not in names and path not in told:
                told.add(path)
                yield unknown("run", path, name, names, "name a train of the timetable, or a run of a service: ID HH:MM")


def _root(link: Link) -> str:
    """Return the path of the rotation, join or split that declares a link."""
    return link.path.rpartition(".")[0]


def _without(links: Sequence[Link], paths: Collection[str]) -> list[Link]:
    """Return links without those at paths; a join or split goes as a whole, as none of it can come about."""
    gone = {_root(link) for link in links if link.path in paths and link.kind != "rotation"}
    return [link for link in links if link.path not in paths and _root(link) not in gone]


def _check_rotations(links: Sequence[Link]) -> Iterator[Problem]:
    """Yield runs that a rotation names twice."""
    named: dict[str, set[str]] = defaultdict(set)
    for link in links:
        if link.kind != "rotation":
            continue
        before = named[_root(link)]
        before.add(link.first)
        if link.then in before:
            found = f"the rotation names {link.then} twice: it would never begin"
            yield Problem("circular_turns", link.path, found, remedy="a day's rotation has a first and a last run: leave one out")
        before.add(link.then)


def _check_once(links: Sequence[Link]) -> Iterator[Problem]:
    """Yield runs that would become several trains, or come from several, otherwise than by one split or join."""
    told: set[str] = set()
    for side, kind, what in (("first", "split", "become"), ("then", "join", "be made of")):
        owners: dict[str, list[Link]] = defaultdict(list)
        for link in links:
            owners[getattr(link, side)].append(link)
        for name, mine in owners.items():
            roots = {_root(link) for link in mine}
            blamed = mine[1].path if len(mine) > 1 and mine[1].kind == "rotation" else _root(mine[-1])
            if len(mine) > 1 and not (len(roots) == 1 and mine[0].kind == kind) and blamed not in told:
                told.add(blamed)
                found = f"{name} would {what} several trains: {listed(link.path for link in mine)}"
                yield Problem(
                    "turned_twice", mine[1].path, found, "one rotation, join or split at either end of a run", "leave one out"
                )


def _check_cycle(links: Sequence[Link]) -> Iterator[Problem]:
    sorter: TopologicalSorter[str] = TopologicalSorter()
    for link in links:
        sorter.add(link.then, link.first)
    try:
        sorter.prepare()
    except CycleError as error:
        circle = error.args[1]
        path = next(link.path for link in links if link.then == circle[1] and link.first == circle[0])
        found = f"{' becomes '.join(circle)}: none of them would ever begin"
        yield Problem("circular_turns", path, found, remedy="a day's rotation has a first and a last run: leave one out")


def _check_times(link: Link, first: TrainRun, then: TrainRun) -> Iterator[Problem]:
    if not first.calls:
        return
    last = first.calls[-1]
    arrival = last.arrival if last.arrival is not None else last.departure
    if arrival is None:
        return
    own = then.calls[0].departure if then.calls else None
    leaves = start_time(then) if own is None else own
    ready = max(arrival + last.min_dwell_s, last.departure or arrival) + link.turn_s
    what = f"{link.then} leaves at {format_time(leaves)}"
    if leaves < arrival - _ROUNDING_S:
        found = f"{what}, before {link.first}, which becomes it, has arrived at {format_time(arrival)}"
        remedy = "correct the times, or the order of the runs; past midnight hours go on beyond 24"
        yield Problem("leaves_before_arrival", link.path, found, f"from {format_time(arrival)} on", remedy)
    elif leaves < ready - _ROUNDING_S:
        found = f"{what}, {link.first} is ready for it at {format_time(ready)} only: it leaves {ready - leaves:g} s late"
        yield doubt(
            "short_turn_round", link.path, found, f"from {format_time(ready)} on", "shorten the turn-round, or leave later"
        )


def _check_place(link: Link, first: PlannedRun, then: PlannedRun, lines: Sequence[Sequence[str]]) -> Iterator[Problem]:
    """Yield an error if a train that has come to a stand does not start there as the next one."""
    if first.end == LEAVE:  # it comes back from beyond the line
        return
    opening = then.calls[0] if then.calls else None
    if opening is None or not opening.call.stops or opening.at_m > HERE_M or then.start_mps > 0.0:
        found = f"{link.then} does not begin with a stop, where {link.first} could stand until it leaves"
        remedy = (
            f"let its route begin at a station, its first call, without a speed; or let {link.first} leave the line (end: leave)"
        )
        yield Problem("turn_without_stop", link.path, found, remedy=remedy)
        return
    (track, km), (other_track, other_km) = first.path.place(first.route_m), then.path.place(0.0)
    if first.calls and first.calls[-1].call.station == opening.call.station:
        return
    length_km = max(first.formation.length_m, then.formation.length_m) / 1000.0
    same_line = track == other_track or any(track in line and other_track in line for line in lines)
    if same_line and abs(km - other_km) <= length_km + _ROUNDING_KM:
        return
    found = (
        f"{link.first} ends on track {track} at km {km:.3f}, {link.then}, which it becomes, starts on track {other_track} at km"
        f" {other_km:.3f}"
    )
    yield Problem(
        "turns_elsewhere", link.path, found, "the same station, or within the length of the train", "correct one of the routes"
    )


def _set(run: TrainRun) -> str:
    return f"train {shown(run.train)}" if run.train is not None else "train of " + listed(part.id for part in run.vehicles)

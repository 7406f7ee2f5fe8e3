"""Checks of every state that switching brings about: what nothing can feed, and loops without resistance."""

from __future__ import annotations

from dataclasses import dataclass, field

from tractionpower.alignment.intervals import TOLERANCE_M, Interval, Patch, group, merge, name_km, patch, subtract
from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.supply.event_checks import Timed, states_of
from tractionpower.supply.loops import find_loops
from tractionpower.supply.reach import ContactGraph
from tractionpower.supply.site import Site
from tractionpower.supply.switch_checks import joins_nothing

Dead = dict[str, list[Interval]]
"""Stretches that nothing feeds, by track [m]."""


@dataclass
class _Told:
    """What has been told of an earlier state."""

    loops: set[str]
    ends: set[str] = field(default_factory=set)
    stretches: set[Patch] = field(default_factory=set)


def check_states(site: Site) -> list[Problem]:
    """Return what is wrong or doubtful with the normal state and with those that events bring about."""
    normal = ContactGraph(site)
    known: dict[int, Dead] = {}
    told = _Told({f"supply.switches[{item.id}]" for item in site.supply.switches if joins_nothing(site, normal, item)})
    problems = _check_source(site)
    before = _dead(normal)
    if not problems and site.supply.substations:
        problems += _check_dead(site, before) + _check_dead_loads(site, normal)
    for events, state in states_of(site):
        if id(state) not in known:
            graph = ContactGraph(state) if events else normal
            problems += _check_loops(graph, events, told) + _check_sides(graph, events, told)
            known[id(state)] = _dead(graph)
        dead = known[id(state)]
        if events and site.supply.substations:
            problems += _check_dying(site, events, (before, dead), told)
        before = dead
    return problems


def _from(events: list[Timed]) -> str:
    return f"from {format_time(events[0][1].time)} on " if events else ""


# --- what nothing feeds ------------------------------------------------------------------------------------------


def _check_source(site: Site) -> list[Problem]:
    supply = site.supply
    if any(station.feeds for station in supply.substations) or not (supply.substations or supply.loads):
        return []
    remedy = "put a substation into service; without one nothing is fed"
    return [Problem("no_source", "supply.substations", "no substation is in service", "", remedy, "warning")]


def _dead(graph: ContactGraph) -> Dead:
    found: Dead = {}
    for item in graph.stretches:
        if not item.live:
            found.setdefault(item.track, []).append((item.start_m, item.end_m))
    return {track: merge(stretches) for track, stretches in found.items()}


def _check_dead(site: Site, dead: Dead) -> list[Problem]:
    patches = [
        patch(site.axes[track], ends, (_row_at(site, track, ends[0]),)) for track, stretches in dead.items() for ends in stretches
    ]
    remedy = "close a section cabin or section point, a switch or a feeder, or put a substation into service"
    return [
        Problem(
            "dead_stretch",
            f"supply.contact_lines[{item.rows[0]}]",
            f"no substation in service reaches {item}",
            remedy=remedy,
            severity="warning",
        )
        for item in group(patches)
    ]


def _check_dying(site: Site, events: list[Timed], states: tuple[Dead, Dead], told: _Told) -> list[Problem]:
    """Return a warning for each stretch that loses its feed, and has not lost it before in the same way."""
    before, now = states
    lost = [
        patch(site.axes[track], ends) for track, stretches in now.items() for ends in subtract(stretches, before.get(track, ()))
    ]
    news = [item for item in group(lost) if item not in told.stretches]
    told.stretches.update(news)
    remedy = "trains there coast, then brake; feed it from elsewhere, unless this is what the study is about"
    path = f"supply.switch_events[{events[-1][0]}]"
    return [
        Problem("dead_stretch", path, f"{_from(events)}no substation in service reaches {item}", "", remedy, "warning")
        for item in news
    ]


def _check_dead_loads(site: Site, graph: ContactGraph) -> list[Problem]:
    problems = []
    for load in site.supply.loads:
        place = site.place(load.track, load.km)
        around = [item for item in graph.stretches if place is not None and item.touches(place)]
        if around and not any(item.live for item in around):
            found = f"load {load.id} on track {load.track}, km {name_km(load.km)}, is reached by no substation in service"
            problems.append(Problem("dead_load", f"supply.loads[{load.id}].km", found, "", "", "warning"))
    return problems


def _row_at(site: Site, track: str, metre: float) -> int:
    """Return the row of the contact line that begins at or covers a place where there is one."""
    return next(part.row for part in site.contact[track] if part.end_m > metre + TOLERANCE_M)


# --- loops and sides ---------------------------------------------------------------------------------------------


def _check_loops(graph: ContactGraph, events: list[Timed], told: _Told) -> list[Problem]:
    problems = []
    for loop in find_loops(graph):
        path = loop[-1].path
        if path in told.loops:
            continue
        told.loops.add(path)
        names = ", ".join(tie.name for tie in loop)
        found = f"{_from(events)}a loop without resistance: {names}"
        if len(loop) == 1:
            found = f"{_from(events)}{names} lies across a contact line that is not cut there, without resistance"
        remedy = "give one of them a resistance, or open one: how the current divides among them is not defined"
        problems.append(Problem("zero_resistance_loop", path, found, "", remedy))
    return problems


def _check_sides(graph: ContactGraph, events: list[Timed], told: _Told) -> list[Problem]:
    """Return ends of switches and connections where the contact line has two sides and it is not said which is meant."""
    problems = []
    for switch in graph.site.supply.switches:
        for name, end in (("from", switch.from_), ("to", switch.to)):
            place, path = graph.site.place(end.track, end.km), f"supply.switches[{switch.id}].{name}"
            if place is not None and end.side is None and path not in told.ends and graph.is_cut(place):
                told.ends.add(path)
                found = f"{_from(events)}the contact line of track {end.track} is cut at km {name_km(end.km or 0.0)}"
                remedy = "give side: the switch could mean either part"
                problems.append(Problem("side_needed", f"{path}.side", found, "low_km | high_km", remedy))
    return problems + _check_cut_connections(graph, events, told)


def _check_cut_connections(graph: ContactGraph, events: list[Timed], told: _Told) -> list[Problem]:
    problems = []
    for index, item in enumerate(graph.site.line.connections):
        for name, end in (("from", item.from_), ("to", item.to)):
            place, path = graph.site.place(end.track, end.km), f"line.connections[{index}].{name}"
            if place is not None and path not in told.ends and graph.is_cut(place):
                told.ends.add(path)
                found = f"{_from(events)}the contact line of track {end.track} is cut at km {name_km(end.km)}"
                remedy = "there the connection joins rails only; current passes by feeders or switches"
                problems.append(Problem("connection_at_cut", path, found, "", remedy, "warning"))
    return problems

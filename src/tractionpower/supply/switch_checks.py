"""Checks of feeders and switches: what they name exists, and they join what can be joined."""

from __future__ import annotations

from tractionpower.alignment.axis import tracks_at
from tractionpower.alignment.checks import check_ids, check_tracks
from tractionpower.alignment.intervals import name_km
from tractionpower.errors import Problem
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.supply import SectionCabin
from tractionpower.model.switchgear import Feeder, Switch, SwitchEnd
from tractionpower.supply.place_checks import unknown_station
from tractionpower.supply.reach import TYING, ContactGraph, LinePoint
from tractionpower.supply.site import Site, Station

_STATIONS = "substation or section cabin"
_SIDES = {"low_km": "lower", "high_km": "higher"}


def check_feeders(site: Site) -> list[Problem]:
    """Return rows of feeders that name no feeder."""
    rows = site.supply.feeders
    problems = check_ids("supply.feeders", [row.id for row in rows], by_index=True)
    stations = {station.id: station for station in site.stations}
    places: dict[tuple[str, str], float] = {}
    for index, row in enumerate(rows):
        path = f"supply.feeders[{index}]"
        if row.at not in stations:
            problems += unknown_station(f"{path}.at", row.at, [*stations], _STATIONS)
            continue
        problems += _check_feeder(site, path, row, stations[row.at])
        if row.km is not None and places.setdefault((row.at, row.track), row.km) != row.km:
            before = f"km {name_km(places[row.at, row.track])}"
            found = f"{row.at} meets track {row.track} at km {name_km(row.km)} here, at {before} in a row before"
            remedy = "a station has one place on each track: give the same km, or leave it out but once"
            problems.append(Problem("feeder_places", f"{path}.km", found, before, remedy))
    return problems


def _check_feeder(site: Site, path: str, row: Feeder, station: Station) -> list[Problem]:
    if row.km is None and row.track not in site.axes:
        return check_tracks(f"{path}.track", (row.track,), site.axes)
    problems = []
    place = site.fed[station.id].get(row.track)
    if place is None and row.km is None:
        own = ", ".join(tracks_at(site.axes, station.km, station.tracks)) or "none"
        found = f"{row.at} at km {name_km(station.km)} does not stand on track {row.track}"
        remedy = "correct the track, or give km: the place on that track where the feeder leads to"
        problems.append(Problem("feeder_track", f"{path}.track", found, f"tracks: {own}", remedy))
    if row.side == "return":
        problems += _check_return_feeder(path, row, station)
        place = place if row.km is None else site.place(row.track, row.km)
        if place is not None and not site.rail_rows(place):
            found = f"track {row.track} has no return circuit at km {name_km(site.axes[row.track].km(place[1]))}"
            problems.append(Problem("no_return_circuit", path, found, remedy="correct the row, or add one to return_circuit"))
    elif place is not None and row.side not in site.line_sides(place):
        km = name_km(site.axes[row.track].km(place[1]))
        found = f"track {row.track} has no contact line on the side of {_SIDES[row.side]} km at km {km}"
        allowed = " | ".join(site.line_sides(place)) or "nothing there"
        problems.append(Problem("no_contact_line", f"{path}.side", found, allowed, "leave the row out, or correct it"))
    return problems


def _check_return_feeder(path: str, row: Feeder, station: Station) -> list[Problem]:
    problems = []
    if isinstance(station, SectionCabin):
        remedy = "a section cabin joins contact lines only; use bonds between rails"
        problems.append(Problem("cabin_return", f"{path}.side", f"a return feeder of the section cabin {row.at}", "", remedy))
    if row.trip_current_a is not None or row.reclose_after_s is not None:
        remedy = "leave trip_current_a and reclose_after_s out; breakers stand in the feeders to the contact line"
        problems.append(Problem("return_trip", path, f"a trip of the return feeder {row.id}", "", remedy))
    return problems


def check_switches(site: Site, graph: ContactGraph) -> list[Problem]:
    """Return switches that name no section, or join nothing."""
    problems = []
    for switch in site.supply.switches:
        path = f"supply.switches[{switch.id}]"
        for field, end in (("from", switch.from_), ("to", switch.to)):
            problems += _check_end(site, f"{path}.{field}", end)
        if joins_nothing(site, graph, switch):
            found = f"both ends of switch {switch.id} are the same place"
            remedy = "correct one of them; where a section point or station cuts the line the ends differ in their side"
            problems.append(Problem("switch_joins_nothing", path, found, "", remedy))
    return problems


def _check_end(site: Site, path: str, end: SwitchEnd) -> list[Problem]:
    if end.busbar is not None:
        return unknown_station(f"{path}.busbar", end.busbar, [station.id for station in site.stations], _STATIONS)
    place = site.place(end.track, end.km)
    if place is None or end.km is None:
        return []  # told as a place that does not exist
    at = f"track {end.track} at km {name_km(end.km)}"
    if not site.has_contact_line(place):
        remedy = "correct the km or the track, or add a row to contact_lines"
        return [Problem("names_no_section", f"{path}.km", f"the switch names no section: no contact line on {at}", "", remedy)]
    if end.side is not None and end.side not in site.line_sides(place):
        found = f"the switch names no section: no contact line on the side of {_SIDES[end.side]} km of {at}"
        return [
            Problem("names_no_section", f"{path}.side", found, " | ".join(site.line_sides(place)), "correct the side or the km")
        ]
    return []


def joins_nothing(site: Site, graph: ContactGraph, switch: Switch) -> bool:
    """Tell whether both ends of a switch are one node whatever is switched."""
    first, second = graph.point_of(switch.from_), graph.point_of(switch.to)
    if not (isinstance(first, LinePoint) and isinstance(second, LinePoint)):
        return first is not None and first == second
    if first.track != second.track or abs(first.metre - second.metre) >= SHARED_NODE_M:
        return False
    return first.side == second.side or not _may_be_cut(site, graph, first)


def _may_be_cut(site: Site, graph: ContactGraph, point: LinePoint) -> bool:
    """Tell whether a station or section point stands at a place."""
    places = [place for fed in site.fed.values() for place in fed.values()]
    places += [place for item in site.supply.section_points if (place := site.place(item.track, item.km)) is not None]
    metres = sorted(metre for track, metre in places if track == point.track)
    return ContactGraph.near(metres, point.metre) is not None and len(site.line_sides((point.track, point.metre))) == 2


def check_busbars(site: Site) -> list[Problem]:
    """Return a warning for each switch to a busbar that is in the network in no state."""
    moved = {event.device for event in site.supply.switch_events}
    out = {station.id: station.state for station in site.stations if station.state not in TYING and station.id not in moved}
    problems = []
    for switch in site.supply.switches:
        for field, end in (("from", switch.from_), ("to", switch.to)):
            if end.busbar in out:
                found = f"the busbar of {end.busbar}, which is {out[end.busbar]}, ties nothing"
                path = f"supply.switches[{switch.id}].{field}.busbar"
                remedy = "name the contact line instead, or put the station into service"
                problems.append(Problem("busbar_out", path, found, "", remedy, "warning"))
    return problems

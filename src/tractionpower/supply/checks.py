"""Checks of the supply system against the line and the limits of its system."""

from __future__ import annotations

from tractionpower.alignment.intervals import name_km
from tractionpower.errors import Problem
from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.event_checks import check_events
from tractionpower.supply.line_checks import check_conductor_rows
from tractionpower.supply.place_checks import (
    check_connected,
    check_identifiers,
    check_neighbours,
    check_places,
    check_rails_there,
)
from tractionpower.supply.reach import ContactGraph
from tractionpower.supply.return_checks import check_returns
from tractionpower.supply.site import Site, survey
from tractionpower.supply.state_checks import check_states
from tractionpower.supply.switch_checks import check_busbars, check_feeders, check_switches
from tractionpower.supply.voltage_checks import check_resistances, check_trips, check_units, check_voltages


def check_supply(supply: Supply, line: Line, limits: tuple[Limit, ...]) -> list[Problem]:
    """Return everything that is wrong or doubtful with a supply system.

    Parameters
    ----------
    supply
        The supply system.
    line
        The line along which it stands; its own faults are told by `alignment.checks.check_line`.
    limits
        The limits table, with the voltages of `supply.system`.
    """
    site = survey(supply, line)
    graph = ContactGraph(site)
    problems = check_identifiers(supply) + check_places(site) + check_conductor_rows(site)
    for check in (check_connected, check_rails_there, check_neighbours, check_feeders):
        problems += check(site)
    problems += check_switches(site, graph) + check_busbars(site) + check_events(site) + check_states(site)
    problems += check_returns(site, graph) + _check_connections(site)
    return problems + check_resistances(supply) + check_units(supply) + check_trips(supply) + check_voltages(supply, limits)


def _check_connections(site: Site) -> list[Problem]:
    """Return a warning for each connection of the line that has a contact line at one of its ends only."""
    problems = []
    for index, item in enumerate(site.line.connections):
        places = [site.place(end.track, end.km) for end in (item.from_, item.to)]
        wired = [place is not None and site.has_contact_line(place) for place in places]
        if None not in places and any(wired) and not all(wired):
            bare = item.to if wired[0] else item.from_
            found = f"no contact line on track {bare.track} at km {name_km(bare.km)}, but at the other end of the connection"
            remedy = "the contact line ends there; add a row to contact_lines if the line is wired on"
            problems.append(Problem("connection_without_line", f"line.connections[{index}]", found, "", remedy, "warning"))
    return problems

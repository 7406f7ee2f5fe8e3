"""Checks of the return circuit: bonds, earth, and whether currents find their way back."""

from __future__ import annotations

from tractionpower.alignment.intervals import Interval, group, merge, patch
from tractionpower.errors import Problem
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.earthing import Earthing
from tractionpower.supply.reach import ContactGraph
from tractionpower.supply.return_graph import ReturnGraph
from tractionpower.supply.site import Site


def check_returns(site: Site, contacts: ContactGraph) -> list[Problem]:
    """Return what is wrong or doubtful with bonds, earth and the ways of the current back to the substations."""
    close = [index for index, row in enumerate(site.supply.bonds) if row.every_km * 1000.0 < SHARED_NODE_M]
    if close:  # they would be too many to follow
        return [
            Problem(
                "bond_distance",
                f"supply.bonds[{index}].every_km",
                f"a bond every {site.supply.bonds[index].every_km * 1000.0:g} m",
                f"at least {SHARED_NODE_M:g} m",
                "write the distance in km, for example 0.5",
            )
            for index in close
        ]
    graph = ReturnGraph(site)
    return _check_bonds(site, graph) + _check_references(site, graph) + _check_ways_back(graph, contacts)


def _check_bonds(site: Site, graph: ReturnGraph) -> list[Problem]:
    problems = []
    for index, bonds in enumerate(site.supply.bonds):
        path = f"supply.bonds[{index}]"
        length = bonds.to_km - bonds.from_km
        if bonds.every_km > length + 1e-6:
            found = f"a bond every {bonds.every_km:g} km on {length:g} km: only the one at km {bonds.from_km:g}"
            problems.append(Problem("one_bond", f"{path}.every_km", found, f"up to {length:g} km for more", "", "warning"))
        groups = graph.bonded(bonds)
        if groups and all(len(set(numbers)) < 2 for numbers in groups):
            numbers = {number for numbers in groups for number in numbers}
            why = "the tracks share one return conductor there" if numbers else "there are no rails"
            if all(len(numbers) < 2 for numbers in groups) and numbers:
                why = "they have one track with rails only"
            remedy = "give each track its own row of return_circuit, or leave the bonds out"
            problems.append(Problem("bond_joins_nothing", path, f"the bonds join nothing: {why}", "", remedy, "warning"))
    return problems


def _check_references(site: Site, graph: ReturnGraph) -> list[Problem]:
    """Return devices to earth on rails whose potential nothing else ties to earth."""
    leaky = {
        graph.part[piece.number]
        for pieces in graph.pieces.values()
        for piece in pieces
        if site.supply.return_circuit[piece.row].leakage_s_per_km > 0.0
    }
    earthed: dict[int, list[Earthing]] = {}
    for item in site.supply.earthing:
        part = graph.part_at(site.place(item.track, item.km))
        part = graph.part_of_station(item.substation) if item.substation is not None else part
        if part is not None:
            earthed.setdefault(part, []).append(item)
    problems, limited = [], set()
    for device in site.supply.voltage_limiting_devices:
        part = graph.part_at(site.place(device.track, device.km))
        if part is not None:
            limited.add(part)
            if part not in leaky and part not in earthed:
                found = f"the rails at {device.id} have neither leakage nor earthing: their potential is not defined"
                remedy = "give leakage_s_per_km to the return circuit, or an earthing"
                path = f"supply.voltage_limiting_devices[{device.id}]"
                problems.append(Problem("no_earth_reference", path, found, "", remedy))
    for part, items in earthed.items():
        if len(items) == 1 and part not in leaky and part not in limited:
            found = f"{items[0].id} is the only connection of its rails with earth: no current flows through it"
            remedy = "give leakage_s_per_km to the return circuit if stray currents matter"
            problems.append(Problem("single_earthing", f"supply.earthing[{items[0].id}]", found, "", remedy, "warning"))
    return problems


def _check_ways_back(graph: ReturnGraph, contacts: ContactGraph) -> list[Problem]:
    """Return rails below a live contact line that hang together with no substation that feeds it."""
    site = graph.site
    lost: dict[tuple[str, int], list[Interval]] = {}
    for stretch in contacts.stretches:
        if stretch.live:
            home = {graph.part_of_station(station.id) for station in contacts.sources_of(stretch)}
            for piece in graph.pieces[stretch.track]:
                low, high = max(piece.start_m, stretch.start_m), min(piece.end_m, stretch.end_m)
                if high - low > SHARED_NODE_M and graph.part[piece.number] not in home:
                    lost.setdefault((stretch.track, piece.row), []).append((low, high))
    patches = [patch(site.axes[track], ends, (row,)) for (track, row), parts in lost.items() for ends in merge(parts)]
    remedy = "join them: by bonds, at a substation, or as one row of return_circuit"
    return [
        Problem(
            "no_way_back",
            f"supply.return_circuit[{item.rows[0]}]",
            f"the rails of {item} are joined with no substation that feeds there: currents cannot return",
            remedy=remedy,
            severity="warning",
        )
        for item in group(patches)
    ]

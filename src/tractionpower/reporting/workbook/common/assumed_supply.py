"""Assumptions that a supply system and its network rest on, as this run has them."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.model.supply import ContactLine, ReturnCircuit, Substation
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.assumption import Assumption, figure, names, span
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.supply.conductors import REFERENCE_C

BY_MODEL = mark("method of the program, docs/model.md")
OF_STUDY = mark("of the study")
DEFAULT = mark("default")


def network(facts: Facts) -> Iterator[Assumption]:
    """Yield what the network is taken to be."""
    yield Assumption(
        tr("Every step is a steady state of resistances, sources and demands; inductances, capacitances and ripple act on"
           " nothing."),
        tr("network"), tr(BY_MODEL),
    )  # fmt: skip
    ranged = [load.id for load in facts.scenario.supply.loads if load.limits == "range"]
    fixed = [load.id for load in facts.scenario.supply.loads if load.limits == "none"]
    if ranged:
        yield Assumption(
            tr("Fixed loads keep their power or current down to U_min2 and fall in proportion to the voltage below it; what"
               " feeds back"
               " ends at U_max2."),
            names(ranged), tr(DEFAULT),
        )  # fmt: skip
    if fixed:
        yield Assumption(
            tr("These loads keep their power or current at any voltage; what cannot be served is told as an event."),
            names(fixed), tr(OF_STUDY),
        )  # fmt: skip


def supply(facts: Facts) -> Iterator[Assumption]:
    """Yield what substations, conductors and rails are taken to be."""
    yield from _substations(facts)
    yield from _conductors(facts)
    yield from _rails(facts)
    devices = facts.scenario.supply
    breakers = (*devices.substations, *devices.feeders, *devices.section_cabins)
    moves = devices.switch_events or any(row.trip_current_a for row in breakers) or devices.voltage_limiting_devices
    if not moves:
        text = tr("Nothing switches during the run: all devices keep their normal state, and no breaker trips.")
        yield Assumption(text, tr("network"), tr(OF_STUDY))


def _substations(facts: Facts) -> Iterator[Assumption]:
    stations = facts.scenario.supply.substations
    if not stations:
        return
    where = tr("all substations")
    yield Assumption(
        tr("Substations feed along a straight external characteristic, no-load voltage less internal resistance times current."),
        where, tr(BY_MODEL),
    )  # fmt: skip
    forward = [station for station in stations if station.conducts == "forward"]
    both = [station.id for station in stations if station.conducts == "both"]
    if forward:
        whose = where if len(forward) == len(stations) else names(station.id for station in forward)
        yield Assumption(tr("Rectifiers are diodes: they feed and take nothing back."), whose, tr(OF_STUDY))
    if both:
        yield Assumption(
            tr("A source in both directions: it takes back what trains return, without a threshold."), names(both), tr(OF_STUDY)
        )
    yield from _grid(stations)
    split = [station.id for station in stations if station.unit_resistance_ohm is None and station.units > 1]
    if split:
        yield Assumption(
            tr("Internal resistances are those of the plants with all units; with k of n units the part without the grid is"
               " n/k times it."),
            names(split), tr(BY_MODEL),
        )  # fmt: skip
    unknown = [station.id for station in stations if station.dissipative_resistance_ohm is None]
    if unknown:
        yield Assumption(
            tr("How much of the internal drop is heat is not given: losses of these rectifiers are not told."),
            names(unknown),
            tr(DEFAULT),
        )
    bare = [station.id for station in stations if station.feeder_resistance_ohm == 0.0 and _no_rows(facts, station)]
    if bare:
        yield Assumption(tr("Feeders without resistance."), names(bare), tr(DEFAULT))
    direct = [station.id for station in stations if station.return_resistance_ohm == 0.0 and _no_rows(facts, station, "return")]
    if direct:
        yield Assumption(tr("Return feeders without resistance."), names(direct), tr(DEFAULT))


def _no_rows(facts: Facts, station: Substation, side: str = "") -> bool:
    """Tell whether no feeder of a substation has a row of its own."""
    rows = facts.scenario.supply.feeders
    return not any(row.at == station.id and (row.side == "return") == (side == "return") for row in rows)


def _grid(stations: tuple[Substation, ...]) -> Iterator[Assumption]:
    weak = [station for station in stations if station.grid_resistance_ohm > 0.0]
    if weak:
        yield Assumption(
            tr("The feeding grid is a constant voltage behind a constant resistance of {ohm} Ω on the direct-current side,"
               " which no unit"
               " shares; substations do not lower each other's voltage through it.",
               ohm=span(station.grid_resistance_ohm for station in weak)),
            names(station.id for station in weak), tr(OF_STUDY),
        )  # fmt: skip
    stiff = [station.id for station in stations if station.grid_resistance_ohm == 0.0]
    if stiff:
        yield Assumption(
            tr("The feeding grid is infinite: its voltage does not depend on what is taken from it; what its impedance adds is"
               " in the"
               " internal resistance as given."),
            names(stiff), tr(DEFAULT),
        )  # fmt: skip
    volts = [station.grid_voltage_pu for station in stations]
    default = all(value == 1.0 for value in volts)
    yield Assumption(
        tr("The voltage of the feeding grid is {value} times the declared one throughout the run.", value=span(volts)),
        tr("all substations"), tr(DEFAULT) if default else tr(OF_STUDY),
    )  # fmt: skip
    points: dict[str, list[str]] = {}
    for station in stations:
        if station.supply_point is not None:
            points.setdefault(station.supply_point, []).append(station.id)
    shared = [name for each in points.values() if len(each) > 1 for name in each]
    if shared:
        yield Assumption(
            tr("Substations on one supply point share its demand and contract, but not its voltage drop."),
            names(shared),
            tr(BY_MODEL),
        )


def _conductors(facts: Facts) -> Iterator[Assumption]:
    system = facts.scenario.supply
    lines, rails = system.contact_lines, system.return_circuit
    every: list[ContactLine | ReturnCircuit] = [*lines, *rails]
    found = [row for row in every if row.resistance_ohm_per_km is None]
    given = [row for row in every if row.resistance_ohm_per_km is not None]
    cool = [row for row in found if row.temperature_c is None]
    where = tr("contact lines and rails")
    if cool:
        yield Assumption(
            tr("Wires and rails are at {degrees} °C throughout the run: currents and weather do not warm"
               " them.", degrees=figure(REFERENCE_C)),
            where, tr(DEFAULT),
        )  # fmt: skip
    warm = [row.temperature_c for row in found if row.temperature_c is not None]
    if warm:
        yield Assumption(
            tr("Wires and rails with a temperature of their own are at {degrees} °C throughout the run.", degrees=span(warm)),
            where, tr(OF_STUDY),
        )  # fmt: skip
    if given:
        yield Assumption(
            tr("Resistances for each kilometre that the study gives hold as they are, at any current and temperature."),
            where,
            tr(OF_STUDY),
        )
    new = [row for row in rails if row.rail is not None and row.wear_percent == 0.0]
    if new:
        yield Assumption(tr("Rails are new: no wear."), tr("return circuit"), tr(DEFAULT))
    typed = [row.type for row in lines if row.type is not None and row.wear_percent is None]
    if typed:
        yield Assumption(
            tr("Contact lines of a type have the resistance that its source prints, with the wear that it means."),
            names(typed),
            tr(DEFAULT),
        )
    if any(row.cable is not None for row in system.feeders):
        yield Assumption(
            tr("Cables of feeders have their resistance at {degrees} °C.", degrees=figure(REFERENCE_C)),
            tr("feeders"),
            tr(BY_MODEL),
        )


def _rails(facts: Facts) -> Iterator[Assumption]:
    system, tracks = facts.scenario.supply, facts.scenario.line.tracks
    where = tr("return circuit")
    leaky = [row.leakage_s_per_km for row in system.return_circuit if row.leakage_s_per_km > 0.0]
    if leaky:
        yield Assumption(
            tr("The leakage conductance of {value} S/km is constant over time and weather.", value=span(leaky)),
            where,
            tr(OF_STUDY),
        )
    elif not system.earthing and not system.voltage_limiting_devices:
        yield Assumption(
            tr("Rails are insulated: nothing leaks into earth, and they have no potential against it."), where, tr(DEFAULT)
        )
    joined = [row for row in system.return_circuit if (len(tracks) if row.tracks is None else len(row.tracks)) > 1]
    if joined and len(tracks) > 1:
        yield Assumption(
            tr("Rails of tracks that share a row of the return circuit are one conductor: their cross bonds are perfect."),
            where,
            tr(OF_STUDY),
        )
    if system.bonds and all(row.resistance_ohm == 0.0 for row in system.bonds):
        yield Assumption(tr("Cross bonds have no resistance."), where, tr(DEFAULT))

"""From a scenario to the tables of the block: here trains and network come together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.kernels.block_tables import FLEET, LOAD, LOAD_STEP, SOURCE, WAY, BlockTables
from tractionpower.kernels.train_port import ROOM
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.model.supply import Supply
from tractionpower.movement.compile import Movement
from tractionpower.movement.driving.driven import compile_driven
from tractionpower.supply.characteristics import load_steps, no_load_voltage
from tractionpower.supply.compile import SupplyTables, compile_network
from tractionpower.supply.stretches import Stretch


@dataclass(frozen=True, slots=True, order=True)
class Way:
    """A part of a route within one span: its ends on the route [m], the stretch, and where in the span it begins [m]."""

    from_m: float
    to_m: float
    sign: int
    x_m: float
    stretch: Stretch = field(compare=False)


@dataclass(frozen=True)
class CompiledScenario:
    """A scenario as tables, with the names that their numbers stand for."""

    movement: Movement
    supply: SupplyTables
    block: BlockTables


def compile_scenario(scenario: Scenario) -> CompiledScenario:
    """Return the tables of a scenario of which `check.check_scenario` has found no errors."""
    return assemble(scenario, compile_driven(scenario), scenario.supply)


def assemble(scenario: Scenario, movement: Movement, states: Supply) -> CompiledScenario:
    """Return the tables of trains in a supply whose devices have the states that `states` says.

    The numbers of ports, links, places and triggers do not depend on the states.
    """
    room = [ROOM + 2 * int(train["curves"] + train["powers"]) for train in movement.tables.trains]
    supply = compile_network(states, scenario.line, scenario.limits, room, scenario.conductors)
    fleet, ways = _compile_fleet(movement, supply, room)
    clock = np.array([scenario.clock.start, scenario.clock.step_s, coupling_voltage(scenario, supply) or 0.0])
    entries = np.argsort(movement.tables.trains["start_s"], kind="stable").astype(np.int64)
    entries = entries[movement.tables.trains["waits"][entries] == 0]
    block = BlockTables(
        supply.network, supply.edges, _sources(supply), *_loads(supply), supply.link_table, supply.terms,
        supply.rail_table, supply.earth_edge, supply.triggers, supply.section_table, supply.gauge_table, clock,
        movement.tables, fleet, ways, entries,
    )  # fmt: skip
    return CompiledScenario(movement, supply, block)


def coupling_voltage(scenario: Scenario, supply: SupplyTables) -> float | None:
    """Return the voltage at which trains reckon their currents [V]; None where trains and network are coupled in full."""
    if scenario.coupling == "full":
        return None
    given = scenario.coupling_voltage_v
    return supply.voltages.u_n if given is None else given


def lay_ways(path: RoutePath, stretches: Iterable[Stretch]) -> list[Way]:
    """Return the parts of a route that lie within spans, in order; where there is none there is no contact line."""
    ways: list[Way] = []
    for leg in path.legs:
        ends = sorted((leg.from_track_m, leg.from_track_m + leg.sign * leg.length_m))
        for item in stretches:
            low, high = max(item.from_m, ends[0]), min(item.to_m, ends[1])
            if item.track == leg.axis.track and low < high:
                enters = low if leg.sign > 0 else high
                from_m = leg.start_m + leg.sign * (enters - leg.from_track_m)
                ways.append(Way(from_m, from_m + high - low, leg.sign, enters - item.from_m, item))
    return sorted(ways)


def _compile_fleet(movement: Movement, supply: SupplyTables, room: Sequence[int]) -> tuple[NDArray[np.void], NDArray[np.void]]:
    known: dict[int, tuple[int, int]] = {}  # by route
    ways: list[tuple[float, ...]] = []
    fleet = np.zeros(len(movement.runs), FLEET)
    for row, planned, port, segments in zip(fleet, movement.runs, supply.train_port, room, strict=True):
        if id(planned.path) not in known:
            laid = lay_ways(planned.path, supply.stretches)
            known[id(planned.path)] = (len(ways), len(laid))
            ways += [_way_row(way) for way in laid]
        row["port"], row["room"] = port, segments
        row["first_way"], row["ways"] = known[id(planned.path)]
    return fleet, np.array(ways, WAY) if ways else np.zeros(0, WAY)


def _way_row(way: Way) -> tuple[float, ...]:
    to = way.stretch
    return way.from_m, to.span, to.positive, to.negative, way.x_m, way.sign, to.length_m, to.no_load_v, to.earthed


def _sources(supply: SupplyTables) -> NDArray[np.void]:
    sources = np.zeros(len(supply.substations), SOURCE)
    sources["port"] = supply.source_port
    sources["positive"], sources["negative"] = supply.busbar.T
    sources["no_load_v"] = [no_load_voltage(substation) for substation in supply.substations]
    return sources


def _loads(supply: SupplyTables) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return the loads and the steps of their demand."""
    loads = np.zeros(len(supply.loads), LOAD)
    steps = [np.array(load_steps(load), LOAD_STEP) for load in supply.loads]
    loads["port"] = supply.load_port
    loads["from_s"] = [-np.inf if load.from_ is None else load.from_ - ROUNDING_S for load in supply.loads]
    loads["to_s"] = [np.inf if load.to is None else load.to - ROUNDING_S for load in supply.loads]
    loads["steps"] = [len(rows) for rows in steps]
    loads["first_step"] = np.cumsum(loads["steps"]) - loads["steps"]
    pool = np.concatenate([np.zeros(0, LOAD_STEP), *steps])
    pool["time_s"] -= ROUNDING_S
    return loads, pool

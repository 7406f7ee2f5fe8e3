"""Which train causes how much of a current: the network of one step, linear, with its trains one by one.

At one instant a source that conducts is a voltage behind a resistance, one that does not is not there, trains and loads take
the currents that they have. Such a network is linear, so every current in it is the sum of what each train, all loads and the
unequal no-load voltages of the sources cause alone. It is solved by the block of steps itself: one "step" with nothing on,
one with all loads, one for each train, one with all of them, which must come to the step that was recorded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import FLEET, LOAD, LOAD_STEP, WAY, BlockTables, Buffers, new_buffers, new_state
from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S, PORT, SEGMENT
from tractionpower.supply.characteristics import internal_resistance, no_load_voltage

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

CONDUCTS_A = 1e-5
"""A source of a smaller current is blocked: its tiny conductance carries less [A]."""

_UNLIMITED = float("-inf")


@dataclass(frozen=True)
class Instant:
    """What is on in one step.

    Attributes
    ----------
    source_a, load_a
        Currents of all substations and loads [A].
    train, s_m, train_a
        Numbers of the trains on the line, distances on their routes [m], currents [A].
    """

    source_a: Floats
    load_a: Floats
    train: Numbers
    s_m: Floats
    train_a: Floats


class Superposition:
    """The network of one step.

    Parameters
    ----------
    compiled
        Tables of the states that the supply has then.
    instant
        What is on.
    """

    def __init__(self, compiled: CompiledScenario, instant: Instant) -> None:
        self._compiled, self.instant = compiled, instant

    @cached_property
    def rows(self) -> Buffers:
        """Rows of "steps": nothing on, all loads, each train, all together."""
        tables, steps = self._tables(), len(self.instant.train) + 3
        state, buffers = new_state(tables), new_buffers(tables, steps, 0)
        done, _ = advance(tables, state, buffers, steps)
        assert done == steps  # nothing ends such a block early
        return buffers

    def _tables(self) -> BlockTables:
        block = self._compiled.block
        ports, segments = self._ports()
        first = len(block.network.ports) - len(block.fleet)
        loads, load_steps = self._switching(first)
        return block._replace(
            network=block.network._replace(ports=ports, segments=segments),
            loads=loads,
            load_steps=load_steps,
            triggers=block.triggers[:0],
            clock=np.array([0.0, 1.0, 0.0]),
            fleet=np.zeros(0, FLEET),
            ways=np.zeros(0, WAY),
            entries=np.zeros(0, np.int64),
        )

    def _ports(self) -> tuple[NDArray[np.void], NDArray[np.void]]:
        """Return the ports of sources, loads and probes, then one for each train on the line, each with one segment."""
        block, instant, supply = self._compiled.block, self.instant, self._compiled.supply
        fixed = len(block.network.ports) - len(block.fleet)
        ports = np.zeros(fixed + len(instant.train), PORT)
        ports[:fixed] = block.network.ports[:fixed]
        segments = np.zeros(len(ports), SEGMENT)
        segments["from_v"] = _UNLIMITED
        for k, station in enumerate(supply.substations):
            g = 1.0 / internal_resistance(station)
            if abs(instant.source_a[k]) < CONDUCTS_A and station.conducts == "forward":
                g = BLOCKED_CONDUCTANCE_S
            segments[k]["a"], segments[k]["b"] = -no_load_voltage(station) * g, g
        segments["a"][supply.load_port] = instant.load_a
        segments["a"][fixed:] = instant.train_a
        for k, (train, s_m) in enumerate(zip(instant.train, instant.s_m, strict=True)):
            self._place(ports[fixed + k], int(train), float(s_m))
        ports["first_segment"], ports["segments"] = np.arange(len(ports)), 1
        ports["floor_v"], ports["ceiling_v"] = 0.0, 0.0  # no demand is refused
        return ports, segments

    def _place(self, port: np.void, train: int, s_m: float) -> None:
        """Put the port of a train to where its front is, as a run does."""
        block = self._compiled.block
        fleet = block.fleet[train]
        ways = block.ways[fleet["first_way"] : fleet["first_way"] + fleet["ways"]]
        way = ways[max(int(np.searchsorted(ways["from_m"], s_m, side="right")) - 1, 0)]
        for name in ("span", "positive", "negative", "start_v"):
            port[name] = way[name]
        port["x_m"] = np.clip(way["x_m"] + way["sign"] * (s_m - way["from_m"]), 0.0, way["length_m"])
        port["demand"], port["scale"] = True, 1.0

    def _switching(self, first: int) -> tuple[NDArray[np.void], NDArray[np.void]]:
        """Return which loads and trains are on in which step, the trains at the ports from `first` on."""
        fixed, count = self._compiled.supply.load_port, len(self.instant.train)
        loads = np.zeros(len(fixed) + count, LOAD)
        loads["port"] = np.concatenate([fixed, first + np.arange(count)])
        loads["from_s"], loads["to_s"], loads["steps"] = -np.inf, np.inf, 3
        loads["first_step"] = 3 * np.arange(len(loads))
        steps = np.zeros((len(loads), 3), LOAD_STEP)
        on = np.concatenate([np.ones(len(fixed)), 2.0 + np.arange(count)])
        steps["time_s"] = np.stack([on, on + 1.0, np.full(len(loads), 2.0 + count)], axis=1) - 0.5
        steps["factor"] = [1.0, 0.0, 1.0]
        return loads, steps.ravel()

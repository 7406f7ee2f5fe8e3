"""The error that lumping the rails into the contact line would make, at the step with the lowest voltage of a train.

Programs that know one conductor for each track add the resistance of its own rails to that of its contact line, whatever
joins the rails of the tracks. The same currents at the same places are solved in such a network, and the voltages compared.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Placed
from tractionpower.kernels.block_tables import Buffers
from tractionpower.kernels.network import CONVERGED, solve
from tractionpower.kernels.spans import place_ports
from tractionpower.kernels.tables import new_work
from tractionpower.model.base import format_time
from tractionpower.model.conductors import Conductor
from tractionpower.model.line import Line, Track
from tractionpower.model.loads import Load
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.model.supply import ContactLine, ReturnCircuit, Supply
from tractionpower.supply.bundles import return_tracks
from tractionpower.supply.compile import SupplyTables, compile_network
from tractionpower.supply.conductors import contact_line_resistance, return_resistance

Row = TypeVar("Row", ContactLine, ReturnCircuit)


class WorstStep:
    """Keeps the trains and loads of the step with the lowest voltage of a train on a fed contact line."""

    def __init__(self, scenario: Scenario, names: Sequence[str], tracks: Sequence[str]) -> None:
        self._scenario, self._names, self._tracks = scenario, names, tracks
        self._from_s = scenario.clock.counts_from_s
        self._lowest_v = np.inf
        self._loads: tuple[Load, ...] = ()
        self._train, self._tap = "", ""
        self._time_s = np.nan
        self._supply: Supply | None = None

    def add(self, rows: Buffers, placed: Placed, supply: SupplyTables) -> None:
        """Look at steps, the places of whose trains are `placed`."""
        counts = (rows.trains["voltage_v"] > 0.0) & (rows.trains["time_s"] >= self._from_s - ROUNDING_S)
        volts = np.where(counts, rows.trains["voltage_v"], np.inf)
        if not len(volts) or volts.min() >= self._lowest_v:
            return
        worst = int(volts.argmin())
        self._lowest_v, self._supply = float(volts[worst]), supply.supply
        number = rows.trains["train"][worst]
        self._train, self._tap, self._time_s = self._names[number], _tap_of(number), float(rows.trains["time_s"][worst])
        ends = np.cumsum(rows.steps["trains"])
        step = int(np.searchsorted(ends, worst, side="right"))
        here = slice(int(ends[step] - rows.steps["trains"][step]), int(ends[step]))
        self._loads = tuple(self._taps(rows.trains[here], placed, here, rows.load_a[step], supply))

    def _taps(
        self, trains: NDArray[np.void], placed: Placed, here: slice, load_a: NDArray[np.float64], supply: SupplyTables
    ) -> Iterator[Load]:
        """Yield trains and loads as taps of the currents that they took."""
        for row, track, km in zip(trains, placed.track[here], placed.km[here], strict=True):
            ampere = float(row["current_a"])
            yield Load(id=_tap_of(row["train"]), track=self._tracks[track], km=float(km), current_a=ampere, limits="none")
        for number, (load, ampere) in enumerate(zip(supply.loads, load_a.tolist(), strict=True)):
            yield Load(id=f"load {number}", track=load.track, km=load.km, current_a=ampere, limits="none")

    def compare(self) -> dict[str, Any]:
        """Return the lowest voltage with rails of their own and lumped into the contact lines, for ``run.json``."""
        if self._supply is None:
            return {}
        scenario = self._scenario
        own = self._supply.model_copy(update={"loads": self._loads})
        lumped = lump_rails(own, scenario.line, scenario.conductors)
        volts = [self._solve(supply) for supply in (own, lumped)]
        if volts[0] is None or volts[1] is None:
            return {}
        return {
            "train": self._train,
            "time": format_time(self._time_s),
            "voltage_v": volts[0][self._tap],
            "lumped_voltage_v": volts[1][self._tap],
            "largest_difference_v": max((abs(volts[1][k] - volts[0][k]) for k in volts[0]), default=0.0),
        }

    def _solve(self, supply: Supply) -> dict[str, float] | None:
        """Return the voltages of all taps [V], or None if their currents have no solution."""
        scenario = self._scenario
        tables = compile_network(supply, scenario.line, scenario.limits, (), scenario.conductors)
        work = new_work(tables.network)
        place_ports(tables.network, work)
        status, *_ = solve(tables.network, work, False)
        volts = work.ports["u"][tables.load_port].tolist()
        return dict(zip((load.id for load in tables.loads), volts, strict=True)) if status == CONVERGED else None


def _tap_of(train: int) -> str:
    """Return the identifier of a train's tap, by its number: with a word before it a long name would be too long for one."""
    return f"train {train}"


def lump_rails(supply: Supply, line: Line, conductors: Sequence[Conductor]) -> Supply:
    """Return a supply whose rails have no resistance and no leakage, and whose contact lines have that of their rails as well."""
    lines = tuple(row for track in line.tracks for row in _lumped_lines(supply, line, track, conductors))
    free = {"resistance_ohm_per_km": 0.0, "rail": None, "leakage_s_per_km": 0.0, "wear_percent": 0.0, "temperature_c": None}
    rails = tuple(row.model_copy(update=free) for row in supply.return_circuit)
    changes = {"contact_lines": lines, "return_circuit": rails, "switch_events": ()}
    return supply.model_copy(update=changes | {"earthing": (), "voltage_limiting_devices": ()})


def _lumped_lines(supply: Supply, line: Line, track: Track, conductors: Sequence[Conductor]) -> Iterator[ContactLine]:
    contacts = [row for row in supply.contact_lines if row.tracks is None or track.id in row.tracks]
    rails = [row for row in supply.return_circuit if track.id in return_tracks(row, line)]
    kms = {km for row in (*contacts, *rails) for km in (row.from_km, row.to_km)}
    inside = sorted({track.from_km, track.to_km, *(km for km in kms if track.from_km < km < track.to_km)})
    for low, high in pairwise(inside):
        contact, rail = _over(contacts, low, high), _over(rails, low, high)
        if contact is not None and rail is not None:
            shared = return_tracks(rail, line)
            here = sum(other.id in shared and other.from_km <= low < other.to_km for other in line.tracks)
            ohm = contact_line_resistance(contact, conductors) + here * return_resistance(rail, here, conductors)
            # Both are within the bounds of an input, their sum need not be.
            yield ContactLine.model_construct(tracks=(track.id,), from_km=low, to_km=high, resistance_ohm_per_km=ohm)


def _over(rows: Sequence[Row], low: float, high: float) -> Row | None:
    return next((row for row in rows if row.from_km <= low and high <= row.to_km), None)

"""What becomes of the rows of trains: the table, sums and extremes of each train, ledgers, voltages along the line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.calls import call_rows, departs, late_at_end, overdue_by, time_at_stops
from tractionpower.cosimulation.overlaps import Overlaps
from tractionpower.cosimulation.places import Placed, Places
from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.cosimulation.train_events import TrainEvents
from tractionpower.kernels.block_tables import State
from tractionpower.kernels.sums import add_by_group
from tractionpower.kernels.train_tables import GONE, OUTSIDE, STAYING
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.movement.journey import JourneyCall, calls_of
from tractionpower.movement.ledgers import (
    ELECTRIC_SHARE,
    MECHANICAL_SHARE,
    TrainLedger,
    mechanical_parts,
    pantograph_parts,
    told_kwh,
)
from tractionpower.movement.turns import together
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.spells import TrainSpells
from tractionpower.results.trains import (
    CallRow,
    SupplySummary,
    TrainSummary,
    supply_figures,
    train_figures,
    useful_figures,
)
from tractionpower.results.useful_voltage import Means, UsefulVoltage
from tractionpower.results.windows import TrainWindows

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]
NO_VOLTAGE_V = 1e-9
"""Below it a train is on a dead contact line, where its voltage is 0 exactly [V]."""

Rows = NDArray[np.void]

MECHANICAL = ("wheel", "kinetic", "potential", "resistance", "brakes")
PANTOGRAPH = (
    "line",
    "wheel",
    "drive_loss",
    "starting_resistors",
    "auxiliaries",
    "recovered",
    "coupling",
    "fitted",
    "out_of_nothing",
)
FIGURES = ("taken", "returned", "refused", "auxiliaries", "drive_loss", "starting_resistors", "moved")

STUCK_S = 60.0
"""A train that has held itself for so long at the end of the run is stuck [s]."""


@dataclass(slots=True)
class Extreme:
    """Extreme values of each train, with time [s] and distance on its route [m]."""

    value: Floats
    time_s: Floats
    at_m: Floats

    @classmethod
    def of(cls, trains: int, start: float) -> Extreme:
        """Return extremes of which nothing is known yet."""
        return cls(np.full(trains, start), np.full(trains, np.nan), np.full(trains, np.nan))

    def add(self, rows: Rows, groups: list[Numbers], field: str, lowest: bool) -> None:
        """Look at a field of rows, of which those of one train each are a group."""
        for mine in groups:
            values = rows[field][mine]
            n = int(values.argmin() if lowest else values.argmax())
            row, k = rows[mine[n]], int(rows["train"][mine[0]])
            if (values[n] < self.value[k]) if lowest else (values[n] > self.value[k]):
                self.value[k], self.time_s[k], self.at_m[k] = values[n], row["time_s"], row["s_m"]


class TrainRecorder:
    """Takes the rows of trains as they come.

    Parameters
    ----------
    scenario, compiled
        What runs.
    state
        State of the run, which tells at its end how far the trains have come.
    """

    def __init__(self, scenario: Scenario, compiled: CompiledScenario, state: State) -> None:
        self._state, self._block = state, compiled.block
        self.movement, self.step_s = compiled.movement, scenario.clock.step_s
        self._from_s = scenario.clock.counts_from_s
        self.names, self.places = self.movement.names, Places(scenario, self.movement)
        trains, voltages = len(self.names), compiled.supply.voltages
        lengths = np.array([planned.formation.length_m for planned in self.movement.runs]) / 1000.0
        self.overlaps = Overlaps(self.names, lengths, self.places.tracks, together(scenario.timetable, self.names))
        self.events = TrainEvents(self.names, self.places, voltages, self.step_s)
        self._mechanical = np.zeros((trains, len(MECHANICAL)))
        self._pantograph = np.zeros((trains, len(PANTOGRAPH)))
        self._figures = np.zeros((trains, len(FIGURES)))
        self.lowest_v, self.highest_v = Extreme.of(trains, np.inf), Extreme.of(trains, -np.inf)
        self._current_a, self._speed_mps = Extreme.of(trains, -np.inf), Extreme.of(trains, -np.inf)
        self.ten_seconds = TrainWindows(trains, self.step_s, (10.0,), "lowest")
        self.useful = UsefulVoltage(trains, len(self.places.zones))
        self.spells = {
            "u_max1": TrainSpells(trains, voltages.u_max1),
            "u_max2": TrainSpells(trains, voltages.u_max2),
            "u_min2": TrainSpells(trains, voltages.u_min2, above=False),
        }
        self.without_voltage = TrainSpells(trains, NO_VOLTAGE_V, above=False, tolerance=0.0)
        self._bin_v = np.zeros((self.places.bins, 2))  # sum and count
        self._bin_lowest, self._bin_highest = np.full(self.places.bins, np.inf), np.full(self.places.bins, -np.inf)
        self._groups = _groups_of(self.movement)

    # -- rows ----------------------------------------------------------------------------------------------------

    def add(self, rows: Rows) -> Placed:
        """Take rows, ordered by time and then train, and return their places; key figures leave the warm-up out."""
        placed = self.places.place(rows["train"], rows["s_m"])
        self.overlaps.add(rows["time_s"], rows["train"], placed)
        self.events.add(rows)
        self._add_ledgers(rows)
        counted = rows["time_s"] >= self._from_s - ROUNDING_S
        if counted.all():
            self._count(rows, placed)
        elif counted.any():
            self._count(rows[counted], Placed(placed.track[counted], placed.km[counted], placed.sign[counted]))
        return placed

    def _add_ledgers(self, rows: Rows) -> None:
        seconds = np.full(len(rows), self.step_s)
        train = np.ascontiguousarray(rows["train"])
        which = self._groups[0][train]
        parts = np.zeros((len(rows), len(MECHANICAL)))
        for number in np.unique(which):
            here, planned = which == number, self.movement.runs[self._groups[1][number]]
            named = mechanical_parts(rows[here], seconds[here], planned.formation, planned.path)
            parts[here] = np.stack([named[name] for name in MECHANICAL], axis=1)
        add_by_group(self._mechanical, train, parts)
        named = pantograph_parts(rows, seconds)
        add_by_group(self._pantograph, train, np.stack([named[name] for name in PANTOGRAPH], axis=1))

    def _count(self, rows: Rows, placed: Placed) -> None:
        volts, time_s, train = (np.ascontiguousarray(rows[name]) for name in ("voltage_v", "time_s", "train"))
        taken = rows["power_w"] + rows["returned_w"]
        powers = (taken, *(rows[f"{name}_w"] for name in ("returned", "refused", "auxiliary", "drive_loss", "starting_resistor")))
        add_by_group(self._figures, train, np.stack([*(power * self.step_s for power in powers), rows["moved_m"]], axis=1))
        groups = _by_train(train)
        self._current_a.add(rows, groups, "current_a", lowest=False)
        self._speed_mps.add(rows, groups, "v_mps", lowest=False)
        self.without_voltage.add(time_s, train, volts, self.step_s)
        fed = volts != 0.0  # a dead contact line has no voltage that could be low
        if fed.all():
            self._count_voltages(rows, placed)
        elif fed.any():
            self._count_voltages(rows[fed], Placed(placed.track[fed], placed.km[fed], placed.sign[fed]))

    def _count_voltages(self, rows: Rows, placed: Placed) -> None:
        """Count voltages at the pantographs of trains that have one."""
        volts, time_s, train = (np.ascontiguousarray(rows[name]) for name in ("voltage_v", "time_s", "train"))
        groups = _by_train(train)
        self.lowest_v.add(rows, groups, "voltage_v", lowest=True)
        self.highest_v.add(rows, groups, "voltage_v", lowest=False)
        self.ten_seconds.add(time_s, train, volts, rows["s_m"])
        for spells in self.spells.values():
            spells.add(time_s, train, volts, self.step_s)
        zone = self.places.zone(placed)
        self.useful.add(train, zone, volts, rows["current_a"], rows["traction_n"] > 0.0, self.step_s)
        bins = self.places.bin(placed)
        add_by_group(self._bin_v, bins, np.stack([volts, np.ones(len(volts))], axis=1))
        np.minimum.at(self._bin_lowest, bins, volts)
        np.maximum.at(self._bin_highest, bins, volts)

    # -- what is known at the end ----------------------------------------------------------------------------------

    def note_calls(self) -> list[CallRow]:
        """Note what trains did at the ends of their runs and at calls as events; return the rows of table ``calls``."""
        table: list[CallRow] = []
        clock_s = float(self._block.clock[0])
        for k, planned in enumerate(self.movement.runs):
            mover, calls = self._state.trains.movers[k], self._calls(k)
            if mover["status"] == OUTSIDE:
                table += call_rows(self.names[k], calls, planned.route_m)
                continue
            if self._entered_s(k) >= clock_s:
                self.events.note("train_entered", k, self._entered_s(k), 0.0)
            for call in calls:
                if call.kind == "stop" and call.arrival_s >= clock_s:
                    self.events.note("stop", k, call.arrival_s, call.at_m, call.station)
                if call.kind == "stop" and call.departure_s >= clock_s and departs(call, planned.route_m):
                    self.events.note("departure", k, call.departure_s, call.at_m, call.station)
            if mover["status"] == GONE and mover["finished_s"] >= clock_s:
                self.events.note("train_left", k, float(mover["finished_s"]), planned.route_m)
            table += call_rows(self.names[k], calls, planned.route_m)
        return table

    def _calls(self, k: int) -> tuple[JourneyCall, ...]:
        return calls_of(self.movement.runs[k], self._state.trains, int(self._block.trains.trains[k]["first_stop"]))

    def _entered_s(self, k: int) -> float:
        """Return when train `k` came onto the line, or took others over there [s]."""
        return float(self._state.trains.entered_s[k])

    def on_dead_line(self) -> list[str]:
        """Return the trains that stand or coast on a contact line that nothing feeds."""
        movers = self._state.trains.movers
        dead = np.isfinite(movers["lost_s"]) & (movers["status"] != GONE)
        return [self.names[k] for k in np.flatnonzero(dead).tolist()]

    def profile(self) -> dict[str, Any]:
        """Return voltages at pantographs along the line, as columns of table ``profile``; only where trains were."""
        seen = self._bin_v[:, 1] > 0.0
        return {
            "km": self.places.bin_km[seen],
            "track": self.places.bin_track[seen],
            "lowest_voltage_v": self._bin_lowest[seen],
            "mean_voltage_v": self._bin_v[seen, 0] / self._bin_v[seen, 1],
            "highest_voltage_v": self._bin_highest[seen],
            "count": self._bin_v[seen, 1].astype(np.int64),
        }

    def ledgers(self) -> dict[str, dict[str, Any]]:
        """Return for each kind of ledger whether it closes for every train, the train with the greatest gap, and energies."""
        kinds = {
            "mechanical": (MECHANICAL, self._mechanical, MECHANICAL_SHARE),
            "pantograph_to_wheel": (PANTOGRAPH, self._pantograph, ELECTRIC_SHARE),
        }
        return {kind: self._ledger(kind, *details) for kind, details in kinds.items()}

    def _ledger(self, kind: str, names: tuple[str, ...], energies: Floats, share: float) -> dict[str, Any]:
        ledgers = [TrainLedger(dict(zip(names, row, strict=True)), share) for row in energies.tolist()]
        worst = max(range(len(ledgers)), key=lambda k: ledgers[k].gap_share, default=None)
        found: dict[str, Any] = {
            "closes": all(ledger.closes for ledger in ledgers),
            "worst_gap_share": 0.0 if worst is None else ledgers[worst].gap_share,
            "train": "" if worst is None else self.names[worst],
        }
        return found | told_kwh(kind, dict(zip(names, energies.sum(axis=0).tolist(), strict=True)))

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which trains have rows that count."""
        return np.isfinite(self.lowest_v.value)

    def status(self, now_s: float) -> list[dict[str, Any]]:
        """Return how far each train has come at the time `now_s` [s], and by how much it is overdue at a call not reached."""
        clock_s = float(self._block.clock[0])
        return [
            {
                "train": self.names[k],
                "status": _status(mover, clock_s),
                "entered_s": None if mover["status"] == OUTSIDE else self._entered_s(k),
                "finished_s": None if np.isnan(mover["finished_s"]) else float(mover["finished_s"]),
                "distance_m": float(mover["s_m"]),
                "overdue_s": overdue_by(call_rows(self.names[k], self._calls(k), planned.route_m), now_s),
                **self._worst_place(k),
            }
            for k, (planned, mover) in enumerate(zip(self.movement.runs, self._state.trains.movers, strict=True))
        ]

    def _worst_place(self, k: int) -> dict[str, Any]:
        """Return where train `k` has its lowest voltage."""
        if not self.seen[k]:
            return {"lowest_voltage_track": None, "lowest_voltage_km": None, "lowest_voltage_s": None}
        track, km = self.places.name(k, float(self.lowest_v.at_m[k]))
        return {"lowest_voltage_track": track, "lowest_voltage_km": float(km), "lowest_voltage_s": float(self.lowest_v.time_s[k])}

    def where(self, extreme: Extreme, k: int) -> str:
        """Return in words where an extreme of train `k` was."""
        track, km = self.places.name(k, float(extreme.at_m[k]))
        return f"train {self.names[k]}, track {track}, km {km:.2f}"

    def figures(self, end_s: float) -> Iterator[KeyFigure]:
        """Yield the key figures of all trains that have rows, and of all zones."""
        useful, zones = self.useful.of_trains(), self.useful.of_zones()
        for k, planned in enumerate(self.movement.runs):
            if not self.seen[k]:
                continue
            mover, calls = self._state.trains.movers[k], self._calls(k)
            finished = float(mover["finished_s"]) if np.isfinite(mover["finished_s"]) else end_s
            begin = max(self._entered_s(k), self._from_s)
            whole = finished - begin
            stood = time_at_stops(calls, begin, finished)
            sums = dict(zip(FIGURES, self._figures[k].tolist(), strict=True))
            yield from train_figures(
                TrainSummary(
                    self.names[k], sums["moved"], whole, whole - stood,
                    float(self._speed_mps.value[k]), float(self._speed_mps.time_s[k]), sums["taken"], sums["returned"],
                    float(self._current_a.value[k]), float(self._current_a.time_s[k]),
                )
            )  # fmt: skip
            late = late_at_end(call_rows(self.names[k], calls, planned.route_m), end_s)
            yield from supply_figures(self._supply(k, sums, late, useful))
        for k, name in enumerate(self.places.zones):
            yield from useful_figures(f"zone {name}", zones, k)

    def _supply(self, k: int, sums: dict[str, float], late_s: float, useful: Means) -> SupplySummary:
        window = self.ten_seconds
        energy_j, charge_c, mean_v = self.useful.energies()
        return SupplySummary(
            self.names[k], sums["auxiliaries"], sums["drive_loss"], sums["starting_resistors"], sums["refused"],
            float(self.lowest_v.value[k]), float(self.lowest_v.time_s[k]),
            float(window.best[0, k]), float(window.best_from_s[0, k]),
            float(self.highest_v.value[k]), float(self.highest_v.time_s[k]), float(mean_v[k]),
            useful, k, float(energy_j[k]), float(charge_c[k]), late_s,
        )  # fmt: skip


def _groups_of(movement: Any) -> tuple[Numbers, list[int]]:
    """Return for each train the group of those with its formation and route, and for each group one train."""
    known: dict[tuple[int, Any], int] = {}
    members: list[int] = []
    numbers = np.zeros(len(movement.runs), np.int64)
    for k, planned in enumerate(movement.runs):
        key = (id(planned.path), planned.formation)
        if key not in known:
            known[key] = len(members)
            members.append(k)
        numbers[k] = known[key]
    return numbers, members


def _status(mover: np.void, clock_s: float) -> str:
    if mover["status"] == OUTSIDE:
        return "outside"
    if mover["status"] == GONE:
        return "left" if mover["finished_s"] >= clock_s else "before"
    if mover["status"] == STAYING:
        return "stays"
    return "stuck" if mover["held_s"] >= STUCK_S else "on_line"


def _by_train(train: Numbers) -> list[Numbers]:
    """Return the rows of each train."""
    order = np.argsort(train, kind="stable")
    return [mine for mine in np.split(order, np.flatnonzero(np.diff(train[order])) + 1) if len(mine)]

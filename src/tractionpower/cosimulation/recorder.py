"""What becomes of the rows of a run: tables, extremes, ledgers, events, key figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.events import EventLog
from tractionpower.cosimulation.link_recorder import LinkRecorder
from tractionpower.cosimulation.lumping import WorstStep
from tractionpower.cosimulation.places import Placed
from tractionpower.cosimulation.rail_recorder import RailRecorder
from tractionpower.cosimulation.tables import CompiledScenario
from tractionpower.cosimulation.train_recorder import TrainRecorder
from tractionpower.cosimulation.voltage_verdicts import VoltageVerdicts
from tractionpower.kernels.block_tables import Buffers, State, take_rows
from tractionpower.kernels.network import FLAG_A
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.extremes import Array, Extremes
from tractionpower.results.key_figures import (
    PlantSums,
    SubstationWindows,
    ledger_figures,
    load_figures,
    plant_figures,
    substation_figures,
    window_figures,
)
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.results.tables import loads_table, make_table, substations_table
from tractionpower.results.trains import calls_table, trains_table
from tractionpower.supply.characteristics import dissipative_resistances, no_load_voltage
from tractionpower.supply.compile import SupplyTables

Watch = Callable[[Array, Buffers, SupplyTables], None]
"""Called with the starts of some steps [s], their rows, which it must not keep, and the supply in its states then."""


class Recorder:
    """Takes the buffers of a run as they fill, writes rows and keeps what the key figures need."""

    def __init__(
        self, scenario: Scenario, compiled: CompiledScenario, state: State, writer: Any, watches: Sequence[Watch] = ()
    ) -> None:
        supply = compiled.supply
        self.scenario, self.supply, self.writer, self.watches = scenario, supply, writer, list(watches)
        self.trains = TrainRecorder(scenario, compiled, state)
        self.worst_step = WorstStep(scenario, self.trains.names, self.trains.places.tracks)
        self.rails = RailRecorder(scenario, supply, tuple(self.trains.names), self.trains.places.tracks)
        clock = scenario.clock
        self.step_s = clock.step_s
        self.every = 1 if scenario.output.every_s is None else round(scenario.output.every_s / clock.step_s)
        self.figures_from_s = clock.counts_from_s
        wanted = scenario.output.tables
        self.wanted = set(TABLES if wanted is None else wanted)
        self.substation_a = Extremes(len(supply.substations))
        self.substation_w = Extremes(len(supply.substations))
        self.plants = PlantSums.of(len(supply.substations))
        self.load_v, self.load_w = Extremes(len(supply.loads)), Extremes(len(supply.loads))
        self.links = LinkRecorder(scenario, supply)
        self.section_v = Extremes(len(supply.sections))
        self.voltages = VoltageVerdicts(scenario, supply, self.trains, self.section_v, self.load_v)
        self.windows = SubstationWindows.of(len(supply.substations), clock.step_s)
        self.ledger, self.counted = ElectricLedger(), ElectricLedger()
        self.events = EventLog(supply, clock.step_s, clock.start)
        self.now_s = clock.start
        self.worst_a, self.iterations, self.steps = 0.0, 0, 0

    # -- rows ----------------------------------------------------------------------------------------------------

    def add(self, first_step: int, rows: int, buffers: Buffers, supply: SupplyTables) -> None:
        """Take the first `rows` of `buffers`: the steps from `first_step` on, with the devices in the states of `supply`."""
        self.supply = supply
        number = np.arange(first_step, first_step + rows)
        time_s: Array = self.scenario.clock.start + number.astype(float) * self.step_s
        taken = take_rows(buffers, slice(rows))
        self._note(time_s, taken)
        placed = self.trains.add(taken.trains)
        for watch in self.watches:
            watch(time_s, taken, supply)
        self.worst_step.add(taken, placed, supply)
        self.rails.add_trains(*self._counted(taken.trains, placed))
        written = number % self.every == 0
        self._write(time_s[written], take_rows(taken, written))
        if "rails" in self.wanted:
            self.rails.write(number, time_s, taken, self.writer.append)
        if "trains" in self.wanted and len(taken.trains):
            kept = np.repeat(written, taken.steps["trains"])
            self._write_trains(taken.trains[kept], placed.track[kept], placed.km[kept])
        self.now_s = float(time_s[-1]) + self.step_s

    def _note(self, time_s: Array, rows: Buffers) -> None:
        self.worst_a = max(self.worst_a, float(rows.steps["worst_a"].max()))
        self.iterations += int(rows.steps["iterations"].sum())
        self.steps += len(rows.steps)
        self.ledger.add(rows.steps, self.step_s)
        self.events.add(time_s, rows.steps)
        one_way = [substation.conducts == "forward" for substation in self.supply.substations]
        rectifier_v = np.where(one_way, self._no_load_v(), np.nan)  # a plant that conducts both ways never blocks
        self.events.add_blocked(time_s, rows.source_v, rectifier_v)
        counted = time_s >= self.figures_from_s - ROUNDING_S
        t, rows = time_s[counted], take_rows(rows, counted)
        self.counted.add(rows.steps, self.step_s)
        self.substation_a.add(t, rows.source_a)
        power = np.nan_to_num(rows.source_v) * rows.source_a
        self.substation_w.add(t, power)
        source = self._no_load_v(), dissipative_resistances(self.supply.substations)
        self.plants.add(t, source, rows.source_v, rows.source_a)
        self.windows.add(t, rows.source_a, power)
        self.links.add(t, rows.link_a, self.supply.links)
        self.load_v.add(t, np.where(self._fed, rows.load_v, np.nan))
        self.load_w.add(t, rows.load_v * rows.load_a)
        self.section_v.add(t, rows.section_v)
        self.rails.add(t, rows)

    def _counted(self, rows: NDArray[np.void], placed: Placed) -> tuple[NDArray[np.void], Placed]:
        """Return the rows of trains that count in key figures, with their places."""
        counted = rows["time_s"] >= self.figures_from_s - ROUNDING_S
        if counted.all():
            return rows, placed
        return rows[counted], Placed(placed.track[counted], placed.km[counted], placed.sign[counted])

    def _write(self, time_s: Array, rows: Buffers) -> None:
        supply, append = self.supply, self.writer.append
        if "substations" in self.wanted and supply.substations:
            names = [substation.id for substation in supply.substations]
            ohm = dissipative_resistances(supply.substations)
            append(
                "substations",
                substations_table(time_s, names, self._no_load_v(), ohm, rows.source_v, rows.source_a),
            )
        self.links.write(self.wanted, time_s, rows.link_a, supply.links, append)
        if "loads" in self.wanted and supply.loads:
            load_v = np.where(self._fed, rows.load_v, 0.0)  # what nothing feeds is left with a rounding of the solver
            append("loads", loads_table(time_s, [load.id for load in supply.loads], load_v, rows.load_a))
        if "earthing" in self.wanted:
            self.rails.write_devices(time_s, rows, append)

    @property
    def _fed(self) -> NDArray[np.bool_]:
        """Which loads stand on a contact line that something feeds in the present states."""
        return np.asarray(self.supply.network.ports["start_v"][self.supply.load_port] > 0.0)

    def _no_load_v(self) -> Array:
        """Return E of the substations that feed in the present states [V], NaN for others."""
        supply = self.supply
        return np.where(supply.source_port >= 0, [no_load_voltage(s) for s in supply.substations], np.nan)

    def _write_trains(self, rows: NDArray[np.void], track: NDArray[np.int64], km: Array) -> None:
        trains = self.trains
        rail_v = rows["rail_v"] if self.rails.exists else None
        table = trains_table(rows, (rows["train"], trains.names), (track, trains.places.tracks), km, rail_v)
        self.writer.append("trains", table)

    def close(self, switched: Sequence[dict[str, Any]] = ()) -> None:
        """Write the tables that are known at the end only; `switched` are the events of what was switched."""
        calls = self.trains.note_calls()
        self.links.add_trips(switched, self.figures_from_s)
        if "calls" in self.wanted and calls:
            self.writer.append("calls", calls_table(calls))
        if "profile" in self.wanted:
            self.writer.append("profile", make_table("profile", self._profile()))
        if "rail_profile" in self.wanted and self.rails.exists:
            self.writer.append("rail_profile", self.rails.profile())
        if "events" in self.wanted:
            self.events.add_rows(switched)
            self.events.add_rows(self.trains.events.rows)
            self.events.add_violations(self._verdicts())
            self.writer.append("events", self.events.table())

    def _profile(self) -> dict[str, Any]:
        """Voltages at the cross-sections; where a contact line is cut there, both sides count as one place.

        Steps without a voltage do not count, and a place that never has one has no row.
        """
        places = [(km, track) for track, km in self.supply.sections]
        places += [(load.km, load.track) for load in self.supply.loads]
        low, high, total, counts = (
            np.concatenate([getattr(self.section_v, name), getattr(self.load_v, name)])
            for name in ("lowest", "highest", "total", "counts")
        )
        groups: dict[tuple[float, str], list[int]] = {}
        for number in np.flatnonzero(counts).tolist():
            groups.setdefault(places[number], []).append(number)
        order = sorted(groups, key=lambda place: (place[1], place[0]))
        tracks, found = self.trains.places.tracks, self.trains.profile()
        fixed: dict[str, Any] = {
            "km": [km for km, _ in order],
            "track": [tracks.index(track) for _, track in order],
            "lowest_voltage_v": [low[groups[place]].min() for place in order],
            "mean_voltage_v": [total[groups[place]].sum() / counts[groups[place]].sum() for place in order],
            "highest_voltage_v": [high[groups[place]].max() for place in order],
            "count": [counts[groups[place]].max() for place in order],
        }
        columns: dict[str, Any] = {name: np.concatenate((values, found[name])) for name, values in fixed.items()}
        where = np.repeat([0, 1], [len(order), len(found["km"])])
        return columns | {"track": (columns["track"].astype(int), tracks), "where": (where, ["cross_section", "pantograph"])}

    # -- what sums it up -----------------------------------------------------------------------------------------

    @property
    def flagged(self) -> bool:
        """Whether a step is flagged or a ledger does not close."""
        closes = self.ledger.closes and all(ledger["closes"] for ledger in self.trains.ledgers().values())
        return self.events.flagged_steps > 0 or not closes

    def summary(self) -> dict[str, Any]:
        """Return what ``run.json`` says of the solution."""
        return {
            "worst_residual_a": self.worst_a,
            "residual_limit_a": FLAG_A,
            "mean_iterations": self.iterations / max(self.steps, 1),
            "flagged_steps": self.events.flagged_steps,
            "ledgers": {"electric": self.ledger.as_dict(), **self.trains.ledgers()},
            "verdicts": self._verdicts(),
            "overlaps": self.trains.overlaps.summary(),
            "trains": self.trains.status(self.now_s),
            "lumping": self.worst_step.compare(),
            "notes": list(self._notes()),
            "links": self.links.summary(),
            **self.rails.summary(),
        }

    def _notes(self) -> Iterator[str]:
        """Yield what a reader of the results has to know."""
        if self.scenario.coupling != "full":
            yield "trains take the currents of a constant voltage: the voltages that these cause do not limit them"
        dark_s = self.trains.without_voltage.longest_s
        if dark_s.max(initial=0.0) > 0.0:
            dark = [self.trains.names[k] for k in np.flatnonzero(dark_s).tolist()]
            yield f"without voltage for up to {dark_s.max():g} s: {_trains(dark)}"
        dead = self.trains.on_dead_line()
        stuck = [
            train["train"]
            for train in self.trains.status(self.now_s)
            if train["status"] == "stuck" and train["train"] not in dead
        ]
        if dead:
            yield f"on a dead contact line at the end: {_trains(dead)}"
        if stuck:
            yield f"stuck, since effort or power lack: {_trains(stuck)}"

    def _verdicts(self) -> list[dict[str, Any]]:
        return [*self.voltages.verdicts(), *self.rails.verdicts()] if self.section_v.count else []

    def key_figures(self) -> list[dict[str, Any]]:
        """Return the key figures of the run."""
        if not self.section_v.count:
            return []
        substations = [substation.id for substation in self.supply.substations]
        figures = [
            *self.voltages.figures(),
            *substation_figures(substations, self.substation_a, self.substation_w, self.step_s),
            *plant_figures(substations, self.plants, [each.conducts == "both" for each in self.supply.substations], self.step_s),
            *window_figures(substations, self.windows),
            *self.links.figures(),
            *load_figures([load.id for load in self.supply.loads], self.load_w, self.step_s),
            *self.trains.figures(self.now_s),
            *self.rails.figures(),
            *ledger_figures(self.counted),
        ]
        return [figure.as_dict() for figure in figures]


def _trains(names: Sequence[str]) -> str:
    return f"train{'s' if len(names) > 1 else ''} {', '.join(names)}"

"""What becomes of the rows of a run: tables, extremes, ledgers, events, key figures."""

from __future__ import annotations

from typing import Any

import numpy as np

from tractionpower.cosimulation.events import EventLog
from tractionpower.kernels.network import FLAG_A
from tractionpower.kernels.tables import Buffers, take_rows
from tractionpower.model.base import format_time
from tractionpower.model.limits import find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.extremes import Array, Extremes
from tractionpower.results.key_figures import ledger_figures, load_figures, substation_figures, voltage_figure
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.results.tables import feeders_table, loads_table, make_table, substations_table
from tractionpower.supply.characteristics import no_load_voltage
from tractionpower.supply.compile import SupplyTables

VOLTAGE_TOLERANCE_V = 0.1
"""A voltage limit counts as exceeded beyond this [V]."""


class Recorder:
    """Takes the buffers of a run as they fill, writes rows and keeps what the key figures need."""

    def __init__(self, scenario: Scenario, supply: SupplyTables, writer: Any) -> None:
        self.scenario, self.supply, self.writer = scenario, supply, writer
        clock = scenario.clock
        self.step_s = clock.step_s
        self.every = 1 if scenario.output.every_s is None else round(scenario.output.every_s / clock.step_s)
        self.figures_from_s = clock.start + (clock.warm_up or 0.0)
        wanted = scenario.output.tables
        self.wanted = set(TABLES if wanted is None else wanted)
        feeds = supply.source_port >= 0
        self.no_load_v = np.where(feeds, [no_load_voltage(s) for s in supply.substations], np.nan)
        self.dissipative_ohm = np.array([_given(s.dissipative_resistance_ohm) for s in supply.substations])
        self.substation_a = Extremes(len(supply.substations))
        self.substation_w = Extremes(len(supply.substations))
        self.load_v, self.load_w = Extremes(len(supply.loads)), Extremes(len(supply.loads))
        self.section_v = Extremes(len(supply.sections))
        self.ledger = ElectricLedger()
        self.events = EventLog(supply, clock.step_s)
        self.worst_a, self.iterations, self.steps = 0.0, 0, 0

    # -- rows ----------------------------------------------------------------------------------------------------

    def add(self, first_step: int, rows: int, buffers: Buffers) -> None:
        """Take the first `rows` of `buffers`; they are the steps from `first_step` on."""
        number = np.arange(first_step, first_step + rows)
        time_s: Array = self.scenario.clock.start + number.astype(float) * self.step_s
        taken = take_rows(buffers, slice(rows))
        self._note(time_s, taken)
        written = number % self.every == 0
        self._write(time_s[written], take_rows(taken, written))

    def _note(self, time_s: Array, rows: Buffers) -> None:
        self.worst_a = max(self.worst_a, float(rows.steps["worst_a"].max()))
        self.iterations += int(rows.steps["iterations"].sum())
        self.steps += len(rows.steps)
        self.ledger.add(rows.steps, self.step_s)
        self.events.add(time_s, rows.steps)
        counted = time_s >= self.figures_from_s - 1e-9
        t, rows = time_s[counted], take_rows(rows, counted)
        self.substation_a.add(t, rows.source_a)
        self.substation_w.add(t, np.nan_to_num(rows.source_v) * rows.source_a)
        self.load_v.add(t, rows.load_v)
        self.load_w.add(t, rows.load_v * rows.load_a)
        self.section_v.add(t, rows.section_v)

    def _write(self, time_s: Array, rows: Buffers) -> None:
        supply, append = self.supply, self.writer.append
        if "substations" in self.wanted and supply.substations:
            names = [substation.id for substation in supply.substations]
            append(
                "substations",
                substations_table(time_s, names, self.no_load_v, self.dissipative_ohm, rows.source_v, rows.source_a),
            )
        if "feeders" in self.wanted and supply.feeders:
            feeders = [(feeder.substation, feeder.track, feeder.side) for feeder in supply.feeders]
            append("feeders", feeders_table(time_s, feeders, rows.feeder_a))
        if "loads" in self.wanted and supply.loads:
            append("loads", loads_table(time_s, [load.id for load in supply.loads], rows.load_v, rows.load_a))

    def close(self) -> None:
        """Write the tables that are known at the end only."""
        if "profile" in self.wanted:
            self.writer.append("profile", make_table("profile", self._profile()))
        if "events" in self.wanted:
            self.writer.append("events", self.events.table())

    def _profile(self) -> dict[str, Any]:
        """Voltages at the cross-sections; where a contact line is cut there, both sides count as one place."""
        places = [(km, track) for track, km in self.supply.sections]
        places += [(load.km, load.track) for load in self.supply.loads]
        low = np.concatenate([self.section_v.lowest, self.load_v.lowest])
        mean = np.concatenate([self.section_v.mean, self.load_v.mean])
        high = np.concatenate([self.section_v.highest, self.load_v.highest])
        groups: dict[tuple[float, str], list[int]] = {}
        for number, place in enumerate(places):
            groups.setdefault(place, []).append(number)
        order = sorted(groups, key=lambda place: (place[1], place[0]))
        tracks = sorted({track for _, track in order})
        return {
            "km": [km for km, _ in order],
            "track": ([tracks.index(track) for _, track in order], tracks),
            "lowest_voltage_v": [low[groups[place]].min() for place in order],
            "mean_voltage_v": [mean[groups[place]].mean() for place in order],
            "highest_voltage_v": [high[groups[place]].max() for place in order],
            "count": [self.section_v.count] * len(order),
        }

    # -- what sums it up -----------------------------------------------------------------------------------------

    @property
    def flagged(self) -> bool:
        """Whether a step is flagged or a ledger does not close."""
        return self.events.flagged_steps > 0 or not self.ledger.closes

    def summary(self) -> dict[str, Any]:
        """Return what ``run.json`` says of the solution."""
        return {
            "worst_residual_a": self.worst_a,
            "residual_limit_a": FLAG_A,
            "mean_iterations": self.iterations / max(self.steps, 1),
            "flagged_steps": self.events.flagged_steps,
            "ledgers": {"electric": self.ledger.as_dict()},
            "verdicts": self._verdicts(),
        }

    def _lowest(self) -> tuple[float, str, float]:
        return self._extreme("lowest", min)

    def _highest(self) -> tuple[float, str, float]:
        return self._extreme("highest", max)

    def _extreme(self, which: str, pick: Any) -> tuple[float, str, float]:
        """Return value [V], place and time [s] of the extreme voltage along the line."""
        found = [
            (value, f"track {track}, km {km:g}", when)
            for (track, km), value, when in zip(
                self.supply.sections, getattr(self.section_v, which), getattr(self.section_v, which + "_s"), strict=True
            )
        ]
        found += [
            (value, f"load {load.id}, track {load.track}, km {load.km:g}", when)
            for load, value, when in zip(
                self.supply.loads, getattr(self.load_v, which), getattr(self.load_v, which + "_s"), strict=True
            )
        ]
        best: tuple[float, str, float] = pick(found, key=lambda item: item[0])
        return best

    def _verdicts(self) -> list[dict[str, Any]]:
        if not self.section_v.count:
            return []
        voltages, system = self.supply.voltages, self.scenario.supply.system
        lowest, low_place, low_s = self._lowest()
        highest, high_place, high_s = self._highest()
        rows = [
            ("lowest voltage", "u_min2", lowest, low_place, low_s, lowest >= voltages.u_min2 - VOLTAGE_TOLERANCE_V),
            ("highest voltage", "u_max2", highest, high_place, high_s, highest <= voltages.u_max2 + VOLTAGE_TOLERANCE_V),
        ]
        verdicts = []
        for title, name, value, place, when, met in rows:
            limit = find_limit(self.scenario.limits, system, name)
            assert limit is not None  # supply.checks has seen it
            verdicts.append(
                {
                    "name": title, "value": value, "unit": "V", "place": place, "time": format_time(when),
                    "limit": name, "limit_value": limit.value, "source": limit.source, "status": limit.status,
                    "met": bool(met),
                }
            )  # fmt: skip
        return verdicts

    def key_figures(self) -> list[dict[str, Any]]:
        """Return the key figures of the run."""
        if not self.section_v.count:
            return []
        substations = [substation.id for substation in self.supply.substations]
        figures = [
            voltage_figure("lowest", *self._lowest()),
            voltage_figure("highest", *self._highest()),
            *substation_figures(substations, self.substation_a, self.substation_w, self.step_s),
            *load_figures([load.id for load in self.supply.loads], self.load_w, self.step_s),
            *ledger_figures(self.ledger),
        ]
        return [figure.as_dict() for figure in figures]


def _given(value: float | None) -> float:
    return np.nan if value is None else value

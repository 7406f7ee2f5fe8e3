"""What becomes of the rows of a run: tables, extremes, ledgers, events, key figures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.events import EventLog
from tractionpower.kernels.network import FLAG_A
from tractionpower.kernels.tables import Buffers
from tractionpower.model.base import format_time
from tractionpower.model.limits import find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.key_figures import ElectricLedger, Extremes, KeyFigure
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
        time_s = self.scenario.clock.start + number * self.step_s
        steps, *series = (array[:rows] for array in buffers)
        self._note(time_s, steps, *series)
        written = number % self.every == 0
        self._write(time_s[written], *(array[written] for array in series))

    def _note(self, time_s: Any, steps: Any, source_v: Any, source_a: Any, load_v: Any, load_a: Any, *more: Any) -> None:
        self.worst_a = max(self.worst_a, float(steps["worst_a"].max()))
        self.iterations += int(steps["iterations"].sum())
        self.steps += len(steps)
        self.ledger.add(steps, self.step_s)
        self.events.add(time_s, steps)
        counted = time_s >= self.figures_from_s - 1e-9
        t = time_s[counted]
        self.substation_a.add(t, source_a[counted])
        self.substation_w.add(t, np.nan_to_num(source_v[counted]) * source_a[counted])
        self.load_v.add(t, load_v[counted])
        self.load_w.add(t, (load_v * load_a)[counted])
        self.section_v.add(t, more[1][counted])

    def _write(self, time_s: Any, source_v: Any, source_a: Any, load_v: Any, load_a: Any, *more: Any) -> None:
        supply = self.supply
        if "substations" in self.wanted and supply.substations:
            feeds = supply.source_port >= 0
            no_load = np.where(feeds, [no_load_voltage(s) for s in supply.substations], np.nan)
            dissipative = [np.nan if s.dissipative_resistance_ohm is None else s.dissipative_resistance_ohm
                           for s in supply.substations]  # fmt: skip
            names = [s.id for s in supply.substations]
            rows = substations_table(time_s, names, no_load, np.array(dissipative), source_v, source_a)
            self.writer.append("substations", rows)
        if "feeders" in self.wanted and supply.feeders:
            feeders = [(feeder.substation, feeder.track, feeder.side) for feeder in supply.feeders]
            self.writer.append("feeders", feeders_table(time_s, feeders, more[0]))
        if "loads" in self.wanted and supply.loads:
            self.writer.append("loads", loads_table(time_s, [load.id for load in supply.loads], load_v, load_a))

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
        figures = [_voltage_figure("lowest", self._lowest()), _voltage_figure("highest", self._highest())]
        hours = self.section_v.count * self.step_s / 3600.0
        for k, substation in enumerate(self.supply.substations):
            figures += _substation_figures(substation.id, self.substation_a, self.substation_w, k, hours)
        for k, load in enumerate(self.supply.loads):
            energy = self.load_w.mean[k] * hours / 1000.0
            figures.append(KeyFigure("load_energy_kwh", energy, f"load {load.id}", definition="sum of U I over the steps"))
        names = {
            "source": ("source_energy_kwh", "sum of E I over the whole run"),
            "regulation": ("regulation_energy_kwh", "sum of (E - U) I over the whole run"),
            "conductor": ("line_loss_kwh", "heat in contact lines, return circuit and feeders over the whole run"),
        }
        for name, (title, definition) in names.items():
            figures.append(KeyFigure(title, self.ledger.energy_j[name] / 3.6e6, definition=definition))
        return [figure.as_dict() for figure in figures]


def _voltage_figure(which: str, found: tuple[float, str, float]) -> KeyFigure:
    value, place, when = found
    return KeyFigure(
        f"{which}_voltage_v", float(value), place, format_time(when),
        f"{which} voltage between contact line and rail at cross-sections and loads",
    )  # fmt: skip


def _substation_figures(name: str, current: Extremes, power: Extremes, k: int, hours: float) -> list[KeyFigure]:
    place = f"substation {name}"

    def figure(title: str, value: NDArray[np.float64] | float, definition: str, when: float | None = None) -> KeyFigure:
        return KeyFigure(title, float(value), place, "" if when is None else format_time(when), definition)

    return [
        figure("highest_current_a", current.highest[k], "highest mean of a step", current.highest_s[k]),
        figure("mean_current_a", current.mean[k], "mean over the run"),
        figure("rms_current_a", current.rms[k], "root of the mean square over the run"),
        figure("highest_power_kw", power.highest[k] / 1000.0, "highest mean of a step, U I", power.highest_s[k]),
        figure("energy_kwh", power.mean[k] * hours / 1000.0, "sum of U I over the steps"),
    ]

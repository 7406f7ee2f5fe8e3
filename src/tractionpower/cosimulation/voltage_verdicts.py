"""What the voltages of a run come to: extremes along the line, spells beyond limits, verdicts against the limits table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tractionpower.cosimulation.train_recorder import TrainRecorder
from tractionpower.model.base import format_time
from tractionpower.model.limits import Limit, find_limit, useful_limit
from tractionpower.model.scenario import Scenario
from tractionpower.results.extremes import Extremes
from tractionpower.results.key_figures import KeyFigure, voltage_figure
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import sense_of_limit
from tractionpower.supply.compile import SupplyTables


class VoltageVerdicts:
    """Judges the voltages at fixed places, loads and trains.

    Parameters
    ----------
    scenario, supply
        What runs.
    trains, section_v, load_v
        What was gathered of the voltages [V]; looked at when something is asked.
    """

    def __init__(
        self, scenario: Scenario, supply: SupplyTables, trains: TrainRecorder, section_v: Extremes, load_v: Extremes
    ) -> None:
        self.scenario, self.supply, self.trains = scenario, supply, trains
        self.section_v, self.load_v = section_v, load_v

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
        extreme = self.trains.lowest_v if which == "lowest" else self.trains.highest_v
        found += [
            (float(extreme.value[k]), self.trains.where(extreme, k), float(extreme.time_s[k]))
            for k in np.flatnonzero(self.trains.seen).tolist()
        ]
        known = [item for item in found if np.isfinite(item[0])]  # a contact line that nothing feeds has no voltage
        best: tuple[float, str, float] = pick(known, key=lambda item: item[0], default=(np.nan, "", np.nan))
        return best

    def figures(self) -> Iterator[KeyFigure]:
        """Yield the key figures of the voltages."""
        for which, found in (("lowest", self._lowest()), ("highest", self._highest())):
            if np.isfinite(found[0]):
                yield voltage_figure(which, *found)
        yield from self._spell_figures()

    def verdicts(self) -> list[dict[str, Any]]:
        """Return the verdicts; none where nothing has a voltage."""
        return list(self._judge()) if np.isfinite(self._lowest()[0]) else []

    def _judge(self) -> Iterator[dict[str, Any]]:
        voltages = self.supply.voltages
        low, high = self._lowest(), self._highest()
        yield self._verdict("lowest voltage", "u_min2", "V", *low, low[0] >= voltages.u_min2 - TOLERANCE_V)
        yield self._verdict("highest voltage", "u_max2", "V", *high, high[0] <= voltages.u_max2 + TOLERANCE_V)
        trains = self.trains
        spell = trains.spells["u_max1"]
        if trains.seen.any() and find_limit(self.scenario.limits, self.scenario.supply.system, "t_max2"):
            k = int(spell.longest_s.argmax())
            limit = self._limit("t_max2").value
            place = f"train {trains.names[k]}" if spell.longest_s[k] > 0.0 else ""
            longest = float(spell.longest_s[k])
            yield self._verdict(
                "longest spell above U_max1", "t_max2", "s", longest, place, float(spell.longest_from_s[k]), longest <= limit
            )
        useful = useful_limit(self.scenario.limits, self.scenario.supply.system, self.scenario.sizing.useful_voltage.line_class)
        if useful is not None:
            yield from self._judge_useful_voltage(useful)

    def _judge_useful_voltage(self, limit: Limit) -> Iterator[dict[str, Any]]:
        trains = self.trains
        zones = [f"zone {zone}" for zone in trains.places.zones]
        names = [f"train {name}" for name in trains.names]
        of_trains, of_zones = trains.useful.of_trains(), trains.useful.of_zones()
        rows = {
            "mean useful voltage of trains, current-weighted": (names, of_trains.current_weighted_v),
            "mean useful voltage of trains, time mean": (names, of_trains.time_mean_v),
            "mean useful voltage of zones, current-weighted": (zones, of_zones.current_weighted_v),
            "mean useful voltage of zones, time mean": (zones, of_zones.time_mean_v),
        }
        for title, (places, volts) in rows.items():
            if np.isfinite(volts).any():
                k = int(np.nanargmin(volts))
                lowest = float(volts[k])
                yield self._verdict(title, limit.name, "V", lowest, places[k], np.nan, lowest >= limit.value - TOLERANCE_V)

    def _limit(self, name: str) -> Limit:
        limit = find_limit(self.scenario.limits, self.scenario.supply.system, name)
        assert limit is not None  # supply.checks has seen it, or the caller
        return limit

    def _verdict(self, title: str, name: str, unit: str, value: float, place: str, when: float, met: bool) -> dict[str, Any]:
        limit = self._limit(name)
        return {
            "name": title, "value": value, "unit": unit, "place": place, "time": format_time(when) if np.isfinite(when) else "",
            "limit": name, "limit_value": limit.value, "source": limit.source, "status": limit.status,
            "sense": sense_of_limit(name), "met": bool(met),
        }  # fmt: skip

    def _spell_figures(self) -> Iterator[KeyFigure]:
        """Yield the longest spells at a pantograph beyond the limits of the voltage (EN 50163)."""
        if not self.trains.seen.any():
            return
        kinds = {"u_max1": "above U_max1", "u_max2": "above U_max2", "u_min2": "below U_min2"}
        found = [(self.trains.spells[name], words, ", 0.1 V tolerance") for name, words in kinds.items()]
        for spells, words, tolerance in [*found, (self.trains.without_voltage, "without voltage", "")]:
            k = int(spells.longest_s.argmax())
            longest, when = float(spells.longest_s[k]), float(spells.longest_from_s[k])
            place = f"train {self.trains.names[k]}" if longest > 0.0 else ""
            figure, told = f"longest_spell_{words.replace(' ', '_').lower()}_s", format_time(when) if longest > 0.0 else ""
            yield KeyFigure(figure, longest, place, told, f"longest time of a train {words}, without a break{tolerance}")

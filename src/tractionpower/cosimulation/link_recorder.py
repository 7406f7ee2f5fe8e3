"""What becomes of the currents of feeders and switches: tables, key figures, what there is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.results.extremes import Array, Extremes
from tractionpower.results.key_figures import KeyFigure, link_figures, link_heat
from tractionpower.results.tables import feeders_table, switches_table
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.protection import protections
from tractionpower.supply.topology import Link

Append = Callable[[str, pa.Table], None]


class LinkRecorder:
    """Takes the currents of feeders, return feeders and switches as they come; those of a breaker count in either direction.

    Parameters
    ----------
    scenario, supply
        What runs, with all devices in their normal states.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        self.links: tuple[Link, ...] = tuple(supply.links)
        kinds = [link.kind for link in self.links]
        self.feeders = [k for k, kind in enumerate(kinds) if kind in ("feeder", "return")]
        self.cabins = [k for k, kind in enumerate(kinds) if kind == "cabin"]
        self.switches = [k for k, kind in enumerate(kinds) if kind == "switch"]
        self.magnitude_a = Extremes(len(self.links))
        self._step_s = scenario.clock.step_s
        self.closed_steps = np.zeros(len(self.links), np.int64)
        self.trips: Counter[str] = Counter()
        self._protected = protections(scenario.supply, self.links)

    def add(self, time_s: Array, link_a: Array, links: Sequence[Link]) -> None:
        """Take steps that count in key figures: start [s], currents [A], and the links in the states that they had then."""
        self.magnitude_a.add(time_s, np.abs(link_a))
        self.closed_steps += len(time_s) * np.array([link.closed for link in links], np.int64)

    def add_trips(self, switched: Sequence[dict[str, Any]], from_s: float) -> None:
        """Count the trips among the events of what was switched, those from a time on [s]."""
        self.trips.update(row["subject"] for row in switched if row["kind"] == "tripped" and row["time_s"] >= from_s - ROUNDING_S)

    def write(self, wanted: set[str], time_s: Array, link_a: Array, links: Sequence[Link], append: Append) -> None:
        """Write the rows of steps into those of the tables ``feeders``, ``cabins`` and ``switches`` that are wanted."""
        for table, chosen in (("feeders", self.feeders), ("cabins", self.cabins)):
            if table in wanted and chosen:
                places = [(links[k].station, links[k].track, links[k].side) for k in chosen]
                append(table, feeders_table(time_s, places, link_a[:, chosen], table))
        if "switches" in wanted and self.switches:
            states = [(links[k].id, links[k].closed) for k in self.switches]
            append("switches", switches_table(time_s, states, link_a[:, self.switches]))

    def figures(self) -> Iterator[KeyFigure]:
        """Yield the key figures of all links."""
        for k, link in enumerate(self.links):
            trips = self.trips[link.id] if link.kind in ("feeder", "cabin") else None
            yield from link_figures(_place(link), self.magnitude_a, k, int(self.closed_steps[k]), trips)
            yield from link_heat(_place(link), float(self.magnitude_a.squares[k]), link.ohm, self._step_s)

    def summary(self) -> list[dict[str, Any]]:
        """Return what ``run.json`` says of the links: what they are, their normal states and trips."""
        return [
            {
                "place": _place(link), "kind": link.kind, "track": link.track, "km": link.km,
                "normal_state": "closed" if link.closed else "open",
                "resistance_ohm": link.ohm,
                "trip_current_a": self._protected[link.id].trip_current_a if link.id in self._protected else None,
            }
            for link in self.links
        ]  # fmt: skip


def _place(link: Link) -> str:
    return f"{'switch' if link.kind == 'switch' else 'feeder'} {link.id}"

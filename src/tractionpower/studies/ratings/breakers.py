"""Table ``breakers``: currents of feeders against the settings of their breakers, how high and for how long."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.kernels.windows import SPELL, add_spells
from tractionpower.model.scenario import Scenario
from tractionpower.results.extremes import Extremes
from tractionpower.results.windows import as_rows
from tractionpower.results.words import yes_or_no
from tractionpower.studies.ratings.counted import counted
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.protection import protections

Floats = NDArray[np.float64]

LEVELS_PERCENT = (50.0, 70.0, 80.0, 90.0, 100.0)
"""Shares of the setting above which durations are counted."""


class BreakerWatch:
    """Sums up how long the currents of feeders, in either direction, are above parts of the settings of their breakers.

    Parameters
    ----------
    scenario
        What runs.
    supply
        Its supply, with all devices in their normal states.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        clock = scenario.clock
        self._from_s, self._step_s = clock.counts_from_s, clock.step_s
        settings = protections(scenario.supply, supply.links)
        self._links = [k for k, link in enumerate(supply.links) if link.kind in ("feeder", "cabin")]
        self._names = [supply.links[k].id for k in self._links]
        given = [settings[name].trip_current_a if name in settings else None for name in self._names]
        self._setting_a = np.array([math.nan if value is None else value for value in given])
        self._peaks = Extremes(len(self._links))
        self._spells = [np.zeros(len(self._links), SPELL) for _ in LEVELS_PERCENT]
        for spells in self._spells:
            spells["last_s"] = -np.inf

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        time_s, rows = counted(self._from_s, time_s, rows)
        amps = np.abs(rows.link_a[:, self._links])
        self._peaks.add(time_s, amps)
        for spells, level in zip(self._spells, LEVELS_PERCENT, strict=True):
            step, feeder = np.nonzero(amps > self._setting_a * level / 100.0)  # a row that is missing ends a spell
            if len(step):
                add_spells(spells, 0.0, self._step_s, as_rows(time_s[step]), as_rows(feeder, np.int64), np.ones(len(step)))

    def rows(self, trips: Mapping[str, int], allowed_percent: float = 100.0) -> Iterator[dict[str, Any]]:
        """Yield the rows of table ``breakers``: levels of every feeder; one row of a feeder whose breaker does not trip.

        Parameters
        ----------
        trips
            How often each has tripped, by feeder.
        allowed_percent
            Highest peak that is met, of the setting [%].
        """
        for k, name in enumerate(self._names):
            setting_a, peak_a = float(self._setting_a[k]), max(float(self._peaks.highest[k]), 0.0)
            share = 100.0 * peak_a / setting_a
            row = {
                "device": name, "setting_a": setting_a, "peak_a": peak_a, "peak_s": float(self._peaks.highest_s[k]),
                "share_percent": share, "trips": trips.get(name, 0),
                "met": yes_or_no(None if math.isnan(share) else share <= allowed_percent),
            }  # fmt: skip
            if math.isnan(setting_a):
                yield row
                continue
            for level, spells in zip(LEVELS_PERCENT, self._spells, strict=True):
                longest_s, total_s = float(spells[k]["longest_s"]), float(spells[k]["total_s"])
                yield {**row, "level_percent": level, "longest_s": longest_s, "total_s": total_s}

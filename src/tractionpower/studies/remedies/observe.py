"""A run of the study as it is, watched: greatest currents and powers, and whose demand causes the loss of the late trains."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from tractionpower.alignment.lines import tracks_by_line
from tractionpower.cosimulation.run import Run
from tractionpower.model.limits import system_voltages
from tractionpower.model.scenario import Output, Scenario
from tractionpower.studies.remedies.case import Peak

REACH_KM = 10.0
"""Distance over which the effect of a train's current on another's voltage is taken to fall to 1/e [km]: it only ranks."""

_COLUMNS = ["time_s", "train", "track", "position_km", "voltage_v", "current_a", "wheel_power_kw"]


class Watcher:
    """Takes the rows of a run: peaks of all trains, and the demand around trains that are late.

    Parameters
    ----------
    scenario
        The study.
    late
        Runs that are late.
    """

    def __init__(self, scenario: Scenario, late: Collection[str]) -> None:
        self._nominal_v = system_voltages(scenario.limits, scenario.supply.system).u_n
        lines = tracks_by_line(scenario.line, scenario.supply)
        self._line = {track: number for number, tracks in enumerate(lines) for track in tracks}
        self._late = frozenset(late)
        self.peaks: dict[str, Peak] = {}
        self.demand: dict[str, float] = {}

    def append(self, table: str, rows: pa.Table) -> None:
        """Take rows of a table; those of trains count."""
        if table == "trains" and rows.num_rows:
            frame = rows.select(_COLUMNS).to_pandas()
            frame["train"], frame["track"] = frame["train"].astype(object), frame["track"].astype(object)
            self._add_peaks(frame)
            self._add_demand(frame)

    def _add_peaks(self, frame: pd.DataFrame) -> None:
        for name, peak in frame.groupby("train")[["current_a", "wheel_power_kw"]].max().iterrows():
            known = self.peaks.get(str(name), Peak())
            self.peaks[str(name)] = Peak(
                max(known.current_a, float(peak["current_a"])), max(known.power_kw, float(peak["wheel_power_kw"]))
            )

    def _add_demand(self, frame: pd.DataFrame) -> None:
        """Add every train's current, weighed by the sag and the current of each late train and by the distance to it."""
        frame = frame.assign(line=frame["track"].map(self._line), taken=frame["current_a"].clip(lower=0.0))
        late = frame[frame["train"].isin(self._late)]
        late = late.assign(weight=late["taken"] * (self._nominal_v - late["voltage_v"]).clip(lower=0.0))
        late = late.loc[late["weight"] > 0.0, ["time_s", "line", "position_km", "weight"]]
        pairs = late.merge(
            frame[["time_s", "train", "line", "position_km", "taken"]], on=["time_s", "line"], suffixes=("_late", "")
        )
        near = np.exp(-(pairs["position_km"] - pairs["position_km_late"]).abs() / REACH_KM)
        share = (pairs["weight"] * pairs["taken"] * near).groupby(pairs["train"]).sum()
        for name, value in share.items():
            self.demand[str(name)] = self.demand.get(str(name), 0.0) + float(value)

    def culprits(self) -> tuple[str, ...]:
        """Return the runs by their demand around the late trains, the greatest first; those without any are left out."""
        ranked = sorted(self.demand.items(), key=lambda item: (-item[1], item[0]))
        return tuple(name for name, value in ranked if value > 0.0 and math.isfinite(value))


def watch(scenario: Scenario, late: Collection[str]) -> Watcher:
    """Run a study as it is and return what was seen of its trains."""
    watcher = Watcher(scenario, late)
    whole: dict[str, Any] = {"output": Output(tables=("trains",))}
    Run(scenario.model_copy(update=whole), watcher).execute()
    return watcher

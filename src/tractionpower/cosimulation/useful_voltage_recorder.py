"""What the trains of a run get: their mean useful voltages, by zone and part of the day, and how long they have which voltage."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.alignment.axis import compile_axes
from tractionpower.cosimulation.feeding_zones import ZoneMap, lay_zones
from tractionpower.cosimulation.places import Placed, Places
from tractionpower.kernels.block_tables import Buffers
from tractionpower.model.limits import Limit, find_limit, system_voltages, useful_limit
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.movement.compile import Movement
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.tables import make_table
from tractionpower.results.useful_voltage import Means
from tractionpower.results.useful_windows import Window, WindowedUsefulVoltage, WindowMeans, windows_of
from tractionpower.results.voltage_bands import VoltageDurations, bands_of
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]

NO, YES, OPEN = 0, 1, 2
_WORDS = ["no", "yes", ""]


class Lowest(NamedTuple):
    """The lowest mean useful voltage of a kind [V], and of what; NaN and empty where there is none."""

    value_v: float
    subject: str


class UsefulVoltageRecorder:
    """Sums up the voltages at the pantographs of a run as its rows come; a `Watch`.

    Rows of the warm-up do not count, nor do those without a voltage: a dead contact line has none that could be low.

    Parameters
    ----------
    scenario, movement
        What runs.
    places
        Finds places of rows; left out: its own.
    whole_run_only
        Leave out hours and given windows.
    """

    def __init__(
        self, scenario: Scenario, movement: Movement, places: Places | None = None, *, whole_run_only: bool = False
    ) -> None:
        study, clock = scenario.sizing.useful_voltage, scenario.clock
        self.names = movement.names
        self.places = Places(scenario, movement) if places is None else places
        self.zones = ZoneMap(lay_zones(scenario), self.places.tracks, compile_axes(scenario.line))
        self._step_s, self._from_s = clock.step_s, clock.counts_from_s
        given = [(window.from_, window.to) for window in study.windows]
        windows = windows_of(self._from_s, clock.end, given)
        self._useful = WindowedUsefulVoltage(
            len(self.names),
            self.zones.parts,
            self.zones.members,
            windows[:1] if whole_run_only else windows,
            study.shortest_stay_s,
        )
        limits, system = scenario.limits, scenario.supply.system
        self.limit = useful_limit(limits, system, study.line_class)
        times = {name: find_limit(limits, system, name) for name in ("t_min2", "t_max2")}
        voltages = system_voltages(limits, system)
        bands = bands_of(voltages, _value(times["t_min2"]), _value(times["t_max2"]))
        self.durations = VoltageDurations(len(self.names), bands, voltages.u_n, clock.step_s)
        self.limits = tuple(limit for limit in (self.limit, *times.values()) if limit is not None)

    def __call__(self, time_s: Floats, steps: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        self.add(steps.trains)

    def add(self, rows: NDArray[np.void], placed: Placed | None = None) -> None:
        """Take rows of trains (`TRAIN_ROW`), ordered by time; `placed` are their places, where they are known."""
        if not len(rows):
            return
        counted = (rows["time_s"] >= self._from_s - ROUNDING_S) & (rows["voltage_v"] != 0.0)
        if not counted.any():
            return
        where = self.places.place(rows["train"], rows["s_m"]) if placed is None else placed
        if not counted.all():
            rows, where = rows[counted], Placed(where.track[counted], where.km[counted], where.sign[counted])
        time_s, train, volts = (np.ascontiguousarray(rows[name]) for name in ("time_s", "train", "voltage_v"))
        self.durations.add(time_s, train, volts)
        part = self.zones.part(where)
        self._useful.add(time_s, train, part, volts, rows["current_a"], rows["traction_n"] > 0.0, self._step_s)

    # -- what is known at the end --------------------------------------------------------------------------------

    def means(self) -> tuple[WindowMeans, ...]:
        """Return the means of all windows, that of the whole run first."""
        return self._useful.means()

    def useful_voltage(self) -> pa.Table:
        """Return table ``useful_voltage``: of each window zones and trains that were there; all zones for the run."""
        zones, trains = [zone.id for zone in self.zones.zones], self.names
        parts = []
        for means in self.means():
            is_run = means.window.kind == "run"
            parts.append(self._rows("zone", zones, means.window, means.zones, keep_all=is_run))
            parts.append(self._rows("train", trains, means.window, means.trains, keep_all=False))
        return pa.concat_tables(parts).unify_dictionaries()

    def _rows(self, kind: str, names: list[str] | tuple[str, ...], window: Window, means: Means, *, keep_all: bool) -> pa.Table:
        kept = np.flatnonzero((means.trains + means.left_out > 0) | keep_all)
        count = len(kept)
        limit = _value(self.limit)
        columns: dict[str, Any] = {
            "kind": (np.zeros(count, int), [kind]),
            "subject": (kept, list(names)),
            "window": (np.zeros(count, int), [window.kind]),
            "from_s": np.full(count, window.from_s),
            "to_s": np.full(count, window.to_s),
            "current_weighted_v": means.current_weighted_v[kept],
            "time_mean_v": means.time_mean_v[kept],
            "power_sum_kw": means.power_w[kept] / 1000.0,
            "current_sum_a": means.current_a[kept],
            "voltage_time_vs": means.voltage_time_vs[kept],
            "counted_s": means.counted_s[kept],
            "trains": means.trains[kept],
            "left_out": means.left_out[kept],
            "limit_v": np.full(count, limit),
            "met": (_met(means, limit)[kept], _WORDS),
        }
        return make_table("useful_voltage", columns)

    def voltage_durations(self) -> pa.Table:
        """Return table ``voltage_durations``."""
        return self.durations.table(self.names)

    def lowest(self, kind: str, definition: str = "current_weighted_v", means: WindowMeans | None = None) -> Lowest:
        """Return the lowest mean of a zone, or of a train: that of the dimensioning train.

        Parameters
        ----------
        kind
            zone or train.
        definition
            current_weighted_v or time_mean_v.
        means
            Means of a window; left out: of the whole run.
        """
        found = self.means()[0] if means is None else means
        volts = getattr(found.zones if kind == "zone" else found.trains, definition)
        if not np.isfinite(volts).any():
            return Lowest(np.nan, "")
        k = int(np.nanargmin(np.round(volts, 6)))  # equal trains shall not be told apart by roundings
        return Lowest(float(volts[k]), self.zones.zones[k].id if kind == "zone" else self.names[k])


def _value(limit: Limit | None) -> float:
    return np.nan if limit is None else limit.value


def _met(means: Means, limit_v: float) -> NDArray[np.int64]:
    """Return `YES` where no known mean is below the limit, `NO` where one is, `OPEN` without a limit or a mean."""
    volts = np.stack([means.current_weighted_v, means.time_mean_v])
    known = np.isfinite(volts)
    below = (volts < limit_v - TOLERANCE_V) & known
    judged = known.any(axis=0) & np.isfinite(limit_v)
    return np.where(judged, np.where(below.any(axis=0), NO, YES), OPEN)

"""The worst of all outages: along the line, and of each device, with the case that causes it. Cases come one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tractionpower.studies.contingency.outages import BASE
from tractionpower.studies.runner.outcomes import rows_table

Row = Mapping[str, Any]


class LineEnvelope:
    """Worst voltages and rail potentials along the line."""

    def __init__(self) -> None:
        self._base: dict[tuple[str, str, float], float] = {}
        self._worst: dict[tuple[str, str, float], tuple[float, str]] = {}

    def add_profile(self, rows: pa.Table, case: Row) -> pa.Table:
        """Take the rows of ``case_profile`` of a case, and return them."""
        self._add("voltage", rows, np.asarray(rows["lowest_voltage_v"]), case)
        return rows

    def add_rails(self, rows: pa.Table, case: Row) -> pa.Table:
        """Take the rows of ``case_rails`` of a case, and return them."""
        low, high = np.asarray(rows["lowest_potential_v"]), np.asarray(rows["highest_potential_v"])
        self._add("rail_potential", rows, np.maximum(np.abs(low), np.abs(high)), case)
        return rows

    def _add(self, quantity: str, rows: pa.Table, volts: Any, case: Row) -> None:
        name, sign = case["case"], 1.0 if quantity == "voltage" else -1.0
        for track, km, value in zip(rows["track"].to_pylist(), rows["km"].to_pylist(), volts.tolist(), strict=True):
            place = quantity, track, km
            if name == BASE:
                self._base[place] = value
            known = self._worst.get(place)
            if known is None or sign * value < sign * known[0]:
                self._worst[place] = value, name

    def table(self) -> pa.Table:
        """Return table ``envelope``: voltages, then rail potentials, by track and kilometre."""
        order = sorted(self._worst, key=lambda place: (place[0] != "voltage", *place[1:]))
        return rows_table(
            "envelope",
            [
                {"track": place[1], "km": place[2], "quantity": place[0], "base_v": self._base.get(place),
                 "worst_v": self._worst[place][0], "case": self._worst[place][1]}
                for place in order
            ],
        )  # fmt: skip


class DeviceEnvelope:
    """Highest utilisation and peak of each device.

    Attributes
    ----------
    failing
        Cases in which a device does not hold, by device.
    """

    def __init__(self) -> None:
        self._rows: dict[str, dict[str, Any]] = {}
        self.failing: dict[str, list[str]] = {}

    def add(self, rows: pa.Table, case: Row) -> pa.Table:
        """Take the rows of ``case_devices`` of a case, and return them."""
        name = case["case"]
        for row in rows.to_pylist():
            device = row["device"]
            known = self._rows.setdefault(device, {"device": device, "kind": row["kind"], "met": "", "case": "", "peak_case": ""})
            if name == BASE:
                known["base_percent"] = row["utilisation_percent"]
            if _is_above(row["peak_a"], known.get("peak_a")):
                known |= {"peak_a": row["peak_a"], "peak_case": name}
            if _is_above(row["utilisation_percent"], known.get("utilisation_percent")):
                taken = ("utilisation_percent", "window_s", "load_a", "permitted_a")
                known |= {key: row[key] for key in taken} | {"case": name}
            if row["met"] == "no":
                self.failing.setdefault(device, []).append(name)
            known["met"] = "no" if "no" in (known["met"], row["met"]) else known["met"] or row["met"]
        return rows

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the rows of table ``device_envelope`` in the order of the devices."""
        yield from self._rows.values()

    def table(self) -> pa.Table:
        """Return table ``device_envelope``."""
        return rows_table("device_envelope", list(self._rows.values()))


class Delays:
    """How much more trains are late than in the base case at the same grid voltage."""

    def __init__(self) -> None:
        self._base: dict[str, dict[str, float | None]] = {}

    def add(self, rows: pa.Table, case: Row) -> pa.Table:
        """Take the rows of ``case_trains`` of a case, base cases before the others, and return them with what is added."""
        late = dict(zip(rows["train"].to_pylist(), rows["late_s"].to_pylist(), strict=True))
        if case["kind"] == BASE:
            self._base[case["grid"]] = late
        base = self._base.get(case["grid"], {})
        before = pa.array([base.get(train) for train in late], rows.schema.field("late_s").type)
        added = pc.subtract(rows["late_s"].combine_chunks(), before)  # nothing where one of them has no value
        at = rows.schema.get_field_index("added_late_s")
        return rows.set_column(at, rows.schema.field(at), added)


def _is_above(value: float | None, known: float | None) -> bool:
    return value is not None and (known is None or value > known)

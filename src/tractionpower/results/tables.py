"""From the solver's rows to tables for the world: here volts times amperes become kilowatts, codes become names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.results.columns import TABLES

Array = NDArray[Any]

_TYPES = {
    "f8": pa.float64(),
    "f4": pa.float32(),
    "i4": pa.int32(),
    "bool": pa.bool_(),
    "text": pa.dictionary(pa.int32(), pa.string()),
}


def schema_of(table: str) -> pa.Schema:
    """Return the Arrow schema of a table, with unit and meaning of each column as metadata."""
    return pa.schema(
        [
            pa.field(c.name, _TYPES[c.kind], metadata={"unit": c.quantity.unit, "meaning": c.quantity.meaning})
            for c in TABLES[table]
        ]
    )


def make_table(table: str, columns: dict[str, Any]) -> pa.Table:
    """Return an Arrow table with the declared columns; NaN in a voltage or loss means that there is no value, -0.0 is 0.0.

    Parameters
    ----------
    table
        Name of the table.
    columns
        By name: arrays of equal length; text as ``(codes, names)``.
    """
    schema = schema_of(table)
    arrays = []
    for field in schema:
        values = columns[field.name]
        if pa.types.is_dictionary(field.type):
            codes, names = values
            arrays.append(pa.DictionaryArray.from_arrays(pa.array(codes, pa.int32()), pa.array(names, pa.string())))
        elif pa.types.is_floating(field.type):
            numbers = np.asarray(values, field.type.to_pandas_dtype()) + field.type.to_pandas_dtype()(0.0)  # no -0.0
            arrays.append(pa.array(numbers, field.type, from_pandas=True))
        else:
            arrays.append(pa.array(values, field.type))
    return pa.Table.from_arrays(arrays, schema=schema)


def substations_table(
    time_s: Array, names: Sequence[str], no_load_v: Array, dissipative_ohm: Array, voltage_v: Array, current_a: Array
) -> pa.Table:
    """Return the rows of table ``substations``.

    Parameters
    ----------
    time_s
        Start of the steps [s], shape (steps,).
    names
        Substations, length n.
    no_load_v, dissipative_ohm
        E [V], NaN for a substation that does not feed, and the dissipative part of its resistance [ohm], NaN where not
        given; shape (n,).
    voltage_v, current_a
        Busbar voltage [V] and fed current [A], shape (steps, n).
    """
    feeds = np.isfinite(no_load_v)
    regulation = np.where(feeds, (no_load_v - voltage_v) * current_a, 0.0)
    return make_table(
        "substations",
        _by_device(time_s, "substation", names)
        | {
            "voltage_v": voltage_v.ravel(),
            "current_a": current_a.ravel(),
            "power_kw": (np.where(feeds, voltage_v * current_a, 0.0) / 1000.0).ravel(),
            "regulation_kw": (regulation / 1000.0).ravel(),
            "loss_kw": (dissipative_ohm * current_a**2 / 1000.0).ravel(),
            "blocked": (feeds & (voltage_v > no_load_v) & (np.abs(current_a) < 1e-3)).ravel(),
        },
    )


def feeders_table(time_s: Array, feeders: Sequence[tuple[str, str, str]], current_a: Array, table: str = "feeders") -> pa.Table:
    """Return the rows of table ``feeders`` or ``cabins``.

    `feeders` are (substation or section cabin, track, side), currents of shape (steps, n).
    """
    steps = len(time_s)
    texts = {}
    for position, name in enumerate(("substation" if table == "feeders" else "section_cabin", "track", "side")):
        words = [feeder[position] for feeder in feeders]
        known = sorted(set(words))
        texts[name] = (np.tile([known.index(word) for word in words], steps), known)
    return make_table(table, {"time_s": np.repeat(time_s, len(feeders)), "current_a": current_a.ravel(), **texts})


def switches_table(time_s: Array, switches: Sequence[tuple[str, bool]], current_a: Array) -> pa.Table:
    """Return the rows of table ``switches``; `switches` are (identifier, closed), currents of shape (steps, n)."""
    closed = np.tile([is_closed for _, is_closed in switches], len(time_s))
    rows = _by_device(time_s, "switch", [name for name, _ in switches])
    return make_table("switches", rows | {"closed": closed, "current_a": current_a.ravel()})


def loads_table(time_s: Array, names: Sequence[str], voltage_v: Array, current_a: Array) -> pa.Table:
    """Return the rows of table ``loads``; voltages and currents of shape (steps, loads)."""
    return make_table(
        "loads",
        _by_device(time_s, "load", names)
        | {
            "voltage_v": voltage_v.ravel(),
            "current_a": current_a.ravel(),
            "power_kw": (voltage_v * current_a / 1000.0).ravel(),
        },
    )


def _by_device(time_s: Array, key: str, names: Sequence[str]) -> dict[str, Any]:
    return {
        "time_s": np.repeat(time_s, len(names)),
        key: (np.tile(np.arange(len(names)), len(time_s)), list(names)),
    }

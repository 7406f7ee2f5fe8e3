"""From arrays to tables."""

import numpy as np
import pytest

from tractionpower.results.columns import TABLES
from tractionpower.results.tables import feeders_table, make_table, schema_of, substations_table


@pytest.mark.parametrize("table", TABLES)
def test_every_column_has_a_meaning_and_its_unit_in_its_name(table):
    for field in schema_of(table):
        unit = field.metadata[b"unit"].decode()
        assert field.metadata[b"meaning"].decode().endswith(".")
        short = {"km/h": "kmh", "m/s²": "mps2", "m/s": "mps", "%": "percent"}
        spelled = short.get(unit, unit.lower().replace("/", "_per_").replace(" ", ""))
        assert f"_{field.name}".endswith(f"_{spelled}") or unit in {"", "-", "km"}


def test_devices_change_fastest():
    rows = feeders_table(np.array([0.0, 1.0]), [("B", "1", "low_km"), ("A", "2", "high_km")], np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert [tuple(row.values()) for row in rows.to_pylist()] == [
        (0.0, "B", "1", "low_km", 1.0), (0.0, "A", "2", "high_km", 2.0),
        (1.0, "B", "1", "low_km", 3.0), (1.0, "A", "2", "high_km", 4.0),
    ]  # fmt: skip


def test_substations_that_feed_block_or_are_not_in_the_network():
    no_load = np.array([3600.0, 3600.0, np.nan, np.nan])
    voltage = np.array([[3500.0, 3700.0, 3400.0, np.nan]])
    current = np.array([[1000.0, -1e-7, 0.0, 0.0]])
    ohm = np.array([0.02, np.nan, np.nan, np.nan])
    rows = substations_table(np.array([5.0]), list("ABCD"), no_load, ohm, voltage, current).to_pylist()
    assert [row["voltage_v"] for row in rows] == [3500.0, 3700.0, 3400.0, None]
    assert [row["blocked"] for row in rows] == [False, True, False, False]
    assert [row["loss_kw"] for row in rows] == [20.0, None, None, None]
    assert rows[0]["power_kw"] == 3500.0
    assert rows[0]["regulation_kw"] == 100.0
    assert [(row["power_kw"], row["regulation_kw"]) for row in rows[2:]] == [(0.0, 0.0)] * 2


def test_a_column_that_is_missing_is_a_defect():
    with pytest.raises(KeyError):
        make_table("loads", {"time_s": [0.0]})


def test_no_zero_is_negative():
    rows = feeders_table(np.array([0.0]), [("A", "1", "low_km"), ("A", "2", "low_km")], np.array([[-0.0, -1e-60]]))
    assert [str(value) for value in rows["current_a"].to_pylist()] == ["0.0", "0.0"]

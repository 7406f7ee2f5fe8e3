import math

import numpy as np
import pyarrow as pa
import pytest
from fake_cases import measure_load
from small_studies import load, make_scenario

from tractionpower.studies.runner.case import CaseResult
from tractionpower.studies.runner.packed import is_whole, pack, row_of, table_of


def outcome():
    return measure_load(make_scenario(load("depot")))


def test_figures_come_back_to_the_last_bit_and_nan_as_none():
    row = row_of(
        pack(CaseResult({"lowest_voltage_v": np.float64(0.1) + 0.2, "late_trains": np.int32(3), "useful_train_v": math.nan}))
    )
    assert row == {"status": "complete", "reason": "", "lowest_voltage_v": 0.1 + 0.2, "late_trains": 3, "useful_train_v": None}
    assert type(row["late_trains"]) is int


def test_tables_come_back_in_their_declared_columns():
    data = pack(outcome())
    profile = table_of(data, "case_profile")
    assert profile.column_names == ["track", "km", "lowest_voltage_v"]
    assert profile.column("lowest_voltage_v").to_pylist() == [np.float32(3000.0 / (k + 3.0)) for k in range(3)]
    assert table_of(data, "case_trains").column("late_s").to_pylist() == [3000.0, None]
    assert table_of(data, "case_rails") is None


def test_equal_outcomes_are_equal_bytes():
    assert pack(outcome()) == pack(outcome())


def test_what_is_broken_is_not_whole():
    data = pack(outcome())
    assert is_whole(data)
    for length in range(0, len(data), 7):
        assert not is_whole(data[:length]), length
    at = data.index(b"0.142857" if b"0.142857" in data else b"case.json") + 40
    assert not is_whole(data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])


@pytest.mark.parametrize(("figures", "tables"), [({"lowest": 1.0}, {}), ({}, {"trains": pa.table({})})])
def test_what_is_not_declared_is_refused(figures, tables):
    with pytest.raises(ValueError, match=r"not declared for cases: (lowest|trains)"):
        pack(CaseResult(figures, tables))

"""The sheet of how long which voltage lasts, read back."""

import pandas as pd
from read_workbook import read_table

from tractionpower.reporting.workbook.sizing.voltage_durations import _beyond


def test_durations_tell_what_is_permitted(book):
    rows = read_table(book["Voltage durations"])
    assert {row["train"] for row in rows} == {"all trains"}
    bands = {row["band"]: row for row in rows}
    assert (bands["U_max1 to U_max2"]["permitted [s]"], bands["U_max1 to U_max2"]["holds"]) == (300, "yes")
    assert bands["U_n to U_max1"]["holds"] == "not limited"
    trains = read_table(book["Voltage durations"], 2)
    assert {row["band"] for row in trains} == {"U_max1 to U_max2"}


def test_times_beyond_a_band_are_sums_towards_the_ends(book):
    """Totals of the bands by rising voltage: 0, 1200, 3600, 90, 0 s; U_n lies between the second and the third."""
    rows = read_table(book["Voltage durations"])
    assert [row["time in it or beyond [s]"] for row in rows] == [0.0, 1200.0, 3690.0, 90.0, 0.0]
    for row in rows:
        assert row["longest of these without a break [s]"] <= row["time in it or beyond [s]"]


def test_the_longest_is_never_longer_than_the_time_in_the_band_or_beyond():
    rows = pd.DataFrame(
        {
            "train": ["A"] * 4, "band": ["below U_min2", "U_min2 to U_n", "U_n to U_max1", "above U_max1"],
            "total_s": [5.0, 10.0, 100.0, 7.0],
        }
    )  # fmt: skip
    assert list(_beyond(rows)) == [5.0, 15.0, 107.0, 7.0]

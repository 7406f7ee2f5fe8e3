"""Numbers in workbooks are those of the Parquet files: what stands under the heading of a table's column is of that column."""

import math
from itertools import count

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from fake_books import make_kind
from openpyxl import load_workbook
from read_workbook import read_table

from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.frame.page import heading_of

SHEETS = {
    "feasibility": {
        "Extract trains": "trains", "Extract worst train": "trains", "Voltage profile": "profile", "Events": "events",
        "Timetable": "calls", "Delays": "delays", "Sections": "sections",
    },
    "size": {
        "Ratings by window": "ratings", "Loads by window": "ratings", "Peaks": "peaks",
        "Useful voltage by hour": "useful_voltage", "Voltage durations": "voltage_durations", "Sharing": "sharing",
        "Demand": "demand",
    },
    "contingency": {
        "Envelope": "envelope", "Device envelope": "device_envelope", "Delays in outages": "case_trains", "All cases": "cases",
        "Outage voltages": "cases", "Outage loads": "cases", "Outage trains": "cases",
    },
}  # fmt: skip
OTHER_HEADINGS = {
    "place [km]": ("position_km", "km"), "time of day": ("time_s",), "shortest, at nominal voltage [s]": ("shortest_s",),
    "with train current limits [s]": ("limited_s",), "on the voltages of the run [s]": ("recorded_s",),
    "computed [s]": ("actual_s",), "lost to low voltage [s]": ("lost_voltage_s",), "most lost at [km]": ("worst_km",),
    "load: highest RMS in it [A]": ("load_a",), "permitted in it [A]": ("permitted_a",), "that window begins": ("from_s",),
    "10 s [A]": ("load_a",), "whole run [A]": ("load_a",), "takes then [A]": ("train_current_a",),
    "part of the peak [A]": ("part_a",), "weighted by current [V]": ("current_weighted_v",),
    "mean over time [V]": ("time_mean_v",), "time in the band [s]": ("total_s",), "worst of all cases [V]": ("lowest_voltage_v",),
    "utilisation in the worst case [%]": ("utilisation_percent",), "load in it [A]": ("load_a",), "added [s]": ("added_late_s",),
}  # fmt: skip
"""Headings of a column in other words than its own."""

LEAST = {"feasibility": 20, "size": 15, "contingency": 5}
"""Columns that are found at least: with headings of other words the test would look at nothing."""


@pytest.mark.parametrize("kind", SHEETS)
def test_numbers_are_those_of_the_files_to_the_last_digit(kind, tmp_path):
    results, scenario = make_kind(kind, tmp_path)
    for name in results.tables:
        pq.write_table(pa.concat_tables(results.batches(name)), tmp_path / f"{name}.parquet")
    book = load_workbook(write_workbook(results, scenario, tmp_path / "book.xlsx"), data_only=True)
    compared = 0
    for sheet, table in SHEETS[kind].items():
        if sheet not in book.sheetnames:
            continue
        frame = pq.read_table(tmp_path / f"{table}.parquet").to_pandas()
        for heading, shown in _columns(book[sheet]):
            names = [name for name in frame if heading in (heading_of(name), *_other(name))]
            numbers = [value for value in shown if isinstance(value, int | float)]
            if not names or not numbers or frame[names[0]].dtype.kind not in "iuf":
                continue
            known = np.unique(np.concatenate([frame[name].to_numpy(float) for name in names]))
            assert not [value for value in numbers if not _in(value, known)], f"{sheet}: {heading}"
            compared += 1
    assert compared >= LEAST[kind], compared


def test_key_figures_are_those_of_the_run(tmp_path):
    results, scenario = make_kind("run", tmp_path)
    book = load_workbook(write_workbook(results, scenario, tmp_path / "book.xlsx"), data_only=True)
    shown = [(row.get("place", row.get("of")), row["value"]) for row in read_table(book["Key figures"])]
    own = [figure["value"] for figure in results.key_figures]
    assert len(shown) == len(results.key_figures)
    assert sorted(value for _, value in shown) == pytest.approx(sorted(own), rel=1e-15)


def _columns(sheet):
    """Yield heading and values of every column of every table of a sheet."""
    for number in count(1):
        if not any(name.endswith(f"_{number}") for name in sheet.tables):
            return
        rows = read_table(sheet, number)
        for heading in rows[0] if rows else ():
            yield heading, [row[heading] for row in rows]


def _other(name):
    return [heading for heading, names in OTHER_HEADINGS.items() if name in names]


def _in(value, known):
    """Return whether a number is among others, but for the last bits of single precision; cells hold times in days."""
    place = np.searchsorted(known, value)
    near = known[max(place - 1, 0) : place + 1]
    return any(math.isclose(value, one, rel_tol=2e-7, abs_tol=1e-9) or (one > 3600.0 and abs(value - one) < 2e-6) for one in near)

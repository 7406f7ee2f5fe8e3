"""The sheets of the mean useful voltage, read back."""

import numpy as np
import pyarrow as pa
import pytest
from fake_results import make_case
from fake_sizing import sized
from read_workbook import read_table, texts

from tractionpower.reporting.workbook.sizing.useful_voltage import mean_cell


def test_useful_voltages_by_both_definitions(book, formulas, study):
    rows = {row["zone"]: row for row in read_table(book["Useful voltage"])}
    table = study[0].table("useful_voltage")
    run = table[(table["kind"] == "zone") & (table["window"] == "run")]
    for row in run.to_dict("records"):
        shown = rows[row["subject"]]
        assert shown["weighted by current [V]"] == pytest.approx(row["current_weighted_v"])
        assert shown["mean over time [V]"] == pytest.approx(row["time_mean_v"])
        sums = shown["sum of mean U |I| [kW]"], shown["sum of mean |I| [A]"]
        assert shown["weighted by current [V]"] == pytest.approx(1000.0 * sums[0] / sums[1], rel=1e-12)
        assert shown["holds"] == row["met"]
    for row in read_table(formulas["Useful voltage"]):
        assert row["weighted by current [V]"].startswith("=1000*")
        assert row["mean over time [V]"].startswith("=")
    said = " ".join(texts(book["Useful voltage"]))
    assert "recalled from memory" in said
    assert "no statement about a standard" in said


def test_hours_are_told_by_zone_and_in_full(book, formulas, study):
    table = study[0].table("useful_voltage")
    hours = table[(table["kind"] == "zone") & (table["window"] == "hour")]
    for number, name in ((1, "current_weighted_v"), (2, "time_mean_v")):
        rows = read_table(book["Useful voltage by hour"], number)
        assert len(rows) == hours["from_s"].nunique()
        for row in hours.to_dict("records"):
            shown = next(each for each in rows if each["hour begins"] == row["from_s"])[row["subject"]]
            assert shown == (None if np.isnan(row[name]) else pytest.approx(row[name]))
    assert len(read_table(book["Useful voltage by hour"], 3)) == len(hours)


def test_zones_by_hour_stand_along_the_line_without_empty_ones(write):
    """The second zone has trains an hour before the first one has, the third one never has any."""
    results, scenario = make_case(substations=4, hours=2.0)
    full = sized(results, scenario)
    rows = full._source["useful_voltage"].to_pandas()
    names = list(dict.fromkeys(rows.loc[rows["kind"] == "zone", "subject"].astype(str)))
    hours = (rows["kind"] == "zone") & (rows["window"] == "hour")
    first = rows.loc[hours, "from_s"].min()
    late = hours & (rows["subject"] == names[0]) & (rows["from_s"] == first)
    rows.loc[hours & (rows["subject"] == names[2]), ["current_weighted_v", "time_mean_v"]] = np.nan
    full._source["useful_voltage"] = pa.Table.from_pandas(rows[~late], preserve_index=False)
    book = write(full, scenario)
    for number in (1, 2):
        assert list(read_table(book["Useful voltage by hour"], number)[0])[1:] == names[:2]
    assert {row["zone"] for row in read_table(book["Useful voltage by hour"], 3)} == {*names[:2]}


def test_acceptance_has_the_lowest_of_the_zones(book, study):
    table = study[0].table("useful_voltage")
    zones = table[(table["kind"] == "zone") & (table["window"] == "run")]
    rows = [
        row for row in read_table(book["Acceptance"]) if row["what is judged"].startswith("mean useful voltage of zones, current")
    ]
    lowest = zones.loc[zones["current_weighted_v"].idxmin()]
    shown = next(row for row in rows if "worst hour" not in row["what is judged"])
    assert shown["found"] == pytest.approx(lowest["current_weighted_v"])
    assert shown["place of the worst"] == f"zone {lowest['subject']}"


def test_results_without_sums_show_their_means(write):
    results, scenario = make_case(substations=3, hours=2.0)
    full = sized(results, scenario)
    old = full._source["useful_voltage"].drop_columns(["power_sum_kw", "current_sum_a", "voltage_time_vs", "counted_s"])
    full._source["useful_voltage"] = old
    rows = read_table(write(full, scenario)["Useful voltage"])
    assert rows[0]["weighted by current [V]"] == pytest.approx(old.to_pandas()["current_weighted_v"].iloc[0])
    assert "sum of dt [s]" not in rows[0]


def test_a_mean_without_a_voltage_is_empty():
    row = {"current_weighted_v": np.nan, "time_mean_v": 3000.0, "voltage_time_vs": 6000.0, "counted_s": 2.0}
    assert mean_cell(row, "weighted") is None
    assert mean_cell(row, "mean").value == 3000.0

"""The sheets of a study of ratings, read back."""

import pytest
from fake_results import make_case
from fake_sizing import sized
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.reporting.workbook import write_workbook

SHEETS = [
    "Ratings", "Ratings by window", "Peaks", "Breakers", "Current duration", "Demand", "Sharing", "Useful voltage",
    "Voltage durations",
]  # fmt: skip


@pytest.fixture(scope="module")
def study():
    results, scenario = make_case(substations=9, hours=2.0)
    return sized(results, scenario), scenario


@pytest.fixture(scope="module")
def book(study, tmp_path_factory):
    return load_workbook(write_workbook(*study, tmp_path_factory.mktemp("sized") / "report.xlsx"))


def test_the_sheets_stand_behind_the_cover(book, small):
    assert book.sheetnames[2:11] == SHEETS
    assert not set(SHEETS) & set(small.sheetnames)


def test_a_row_for_each_device_with_its_ruling_window(book, study):
    rows = {row["device"]: row for row in read_table(book["Ratings"])}
    table = study[0].table("ratings")
    assert set(rows) == set(table["device"])
    for row in table[table["ruling"]].to_dict("records"):
        shown = rows[row["device"]]
        assert shown["utilisation [%]"] == pytest.approx(row["utilisation_percent"])
        assert shown["left [A]"] == pytest.approx(row["permitted_a"] - row["load_a"])
        assert shown["holds"] == row["met"]
        assert shown["status of the rating"] == "recalled from memory"
    unrated = [row for row in rows.values() if row["kind"] == "Rail sections"]
    assert {(row["holds"], row["utilisation [%]"], row["window that rules"]) for row in unrated} == {
        ("not rated", None, "whole run")
    }


def test_the_verdict_counts_what_fails(book, study):
    table = study[0].table("ratings")
    ruling = table[table["ruling"]]
    many = (ruling["met"] == "no").sum()
    worst = ruling.loc[ruling["utilisation_percent"].idxmax()]
    assert many > 0
    sentence = next(text for text in texts(book["Ratings"]) if "rated devices beyond" in text)
    assert sentence.startswith(f"{many} of {len(ruling)} rated devices beyond 100 %. Most: {worst['device']},")
    assert sentence in texts(book["Cover"])
    assert any("no statement about a standard" in text for text in texts(book["Ratings"]))


def test_all_windows_are_told(book, study):
    rows = read_table(book["Ratings by window"])
    assert len(rows) == len(study[0].table("ratings"))
    assert {row["window"] for row in rows} == {"10 s", "1 min", "15 min", "2 h", "whole run"}
    assert sum(row["rules"] == "rules" for row in rows) == study[0].table("ratings")["ruling"].sum()


def test_peaks_tell_trains_and_parts(book):
    rows = read_table(book["Peaks"])
    assert {row["train"] for row in rows} == {"1000", "1001", "all fixed loads"}
    assert all(row["part [%]"] == pytest.approx(100.0 * row["part of the peak [A]"] / row["highest current [A]"]) for row in rows)


def test_breakers_have_a_column_for_each_level(book, study):
    rows = read_table(book["Breakers"])
    table = study[0].table("breakers").set_index(["device", "level_percent"])
    for row in rows:
        for level in (50, 80, 100):
            own = table.loc[(row["feeder"], float(level))]
            assert row[f"longest above {level} % [s]"] == pytest.approx(own["longest_s"], abs=1e-4)
            assert row[f"in all above {level} % [s]"] == pytest.approx(own["total_s"], abs=1e-4)


def test_load_duration_and_demand_have_charts(book, study):
    assert len(book["Current duration"]._charts) == 4
    assert len(book["Demand"]._charts) == 1
    rows = {row["supply point"]: row for row in read_table(book["Demand"])}
    demand = study[0].table("demand")
    for name, own in demand.groupby("supply_point", observed=True):
        assert rows[name]["highest demand [kW]"] == pytest.approx(own["power_kw"].max())
        assert rows[name]["quarter begins"] == own.loc[own["power_kw"].idxmax(), "from_s"]
        assert rows[name]["quarters beyond it"] == (own["met"] == "no").sum()


def test_useful_voltages_by_both_definitions(book, study):
    rows = {row["zone"]: row for row in read_table(book["Useful voltage"])}
    table = study[0].table("useful_voltage")
    run = table[(table["kind"] == "zone") & (table["window"] == "run")]
    for row in run.to_dict("records"):
        shown = rows[row["subject"]]
        assert shown["weighted by current [V]"] == pytest.approx(row["current_weighted_v"])
        assert shown["mean over time [V]"] == pytest.approx(row["time_mean_v"])
        assert shown["holds"] == row["met"]
    hourly = read_table(book["Useful voltage"], 2)
    assert len(hourly) == 2
    said = " ".join(texts(book["Useful voltage"]))
    assert "recalled from memory" in said
    assert "no statement about a standard" in said


def test_durations_tell_what_is_permitted(book):
    rows = read_table(book["Voltage durations"])
    assert {row["train"] for row in rows} == {"all trains"}
    bands = {row["band"]: row for row in rows}
    assert (bands["U_max1 to U_max2"]["permitted [s]"], bands["U_max1 to U_max2"]["holds"]) == (300, "yes")
    assert bands["U_n to U_max1"]["holds"] == "not limited"
    trains = read_table(book["Voltage durations"], 2)
    assert {row["band"] for row in trains} == {"U_max1 to U_max2"}


def test_a_device_that_is_named_like_a_formula_stays_text(write):
    results, scenario = make_case(nasty=True)
    book = write(sized(results, scenario), scenario)
    cells = [cell for row in book["Ratings"].iter_rows() for cell in row if str(cell.value).startswith("=")]
    assert cells
    assert all(cell.data_type == "s" for cell in cells)
    assert all(cell.data_type != "f" for name in SHEETS for row in book[name].iter_rows() for cell in row)


def test_sources_stand_once_below_the_ratings(book):
    said = texts(book["Ratings"])
    (source,) = (text for text in said if text.startswith("1: "))
    assert source.startswith("1: recalled from memory. IEC 60146-1-1 as recalled")
    assert {row["source"] for row in read_table(book["Ratings"])} == {1, None}


def test_devices_stand_along_the_line(write):
    results, scenario = make_case(substations=11)
    book = write(sized(results, scenario), scenario)
    for sheet, first in (("Peaks", "device"), ("Breakers", "feeder")):
        feeders = [row[first] for row in read_table(book[sheet]) if row[first].endswith("1 low_km")]
        assert list(dict.fromkeys(feeders)) == [f"Substation {k} 1 low_km" for k in range(1, 12)]

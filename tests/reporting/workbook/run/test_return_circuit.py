"""The sheet of the return circuit."""

import pytest
from fake_rails import rail_run
from fake_results import changed
from openpyxl import load_workbook
from read_workbook import exactly, read_table, texts

from tractionpower.reporting.workbook import write_workbook

SHEET = "Return circuit"
LUMPING = {
    "train": "7", "time": "06:10:00", "voltage_v": 2700.0, "lumped_voltage_v": 2731.5, "largest_difference_v": 40.25,
}  # fmt: skip


@pytest.fixture(scope="module")
def made():
    return rail_run()


@pytest.fixture(scope="module")
def book(made, tmp_path_factory):
    return load_workbook(write_workbook(made.results, made.scenario, tmp_path_factory.mktemp("rails") / "report.xlsx"))


@pytest.fixture(scope="module")
def sheet(book):
    return book[SHEET]


def test_touch_voltages_are_those_of_the_run(sheet, made):
    told = made.results.run["return_circuit"]["touch_voltage"]
    rows = read_table(sheet, 2)
    assert [row["above [V]"] for row in rows] == [120.0, 150.0, 160.0, 60.0]
    for row, expected in zip(rows, told, strict=True):
        assert row["longest spell [s]"] == exactly(expected["longest_s"])
        name = f"limit_{expected['limit']}_s"
        assert row["may last [s]"] in (f'=IF(ISNUMBER({name}),{name},"")', expected["may_last_s"])
        word = {True: "met", False: "violated", None: "not judged"}[expected["met"]]
        assert word == row["verdict"] or row["verdict"].startswith("=IF(AND(ISNUMBER(C")
        assert (row["place"] or "") == expected["place"]
    assert rows[-1]["verdict"] == "not judged"
    assert rows[-1]["status of the limit"] == "recalled from memory"


def test_stray_currents_of_a_short_run_are_not_judged(sheet):
    rows = read_table(sheet, 3)
    assert rows[0]["what"] == "mean stray current"
    assert {row["verdict"] for row in rows} == {"not judged"}
    assert any("shorter (0 h 20 min)" in text for text in texts(sheet))


def test_devices_have_their_figures(sheet, made):
    depot, device = read_table(sheet, 4)
    assert (depot["device"], depot["kind"], depot["place [km]"]) == ("depot", "earthing", 2.0)
    assert (device["device"], device["kind"]) == ("VLD 10", "voltage-limiting device")
    charge = made.results.key_figure("charge_through_earth_ah", "earthing depot")
    assert depot["charge through earth [Ah]"] == exactly(charge)


def test_the_profile_has_every_place_and_a_chart(book, sheet, made):
    rows = read_table(book["Rail potential"])
    profile = made.results.table("rail_profile")
    assert len(rows) == len(profile)
    assert [row["highest potential [V]"] for row in rows] == pytest.approx(profile["highest_potential_v"].tolist())
    (chart,) = sheet._charts
    assert len(chart.series) == 6


def test_the_error_of_lumped_rails_is_told_where_it_is_known(case, made, write):
    for results, scenario, number in ((changed(case[0], lumping=LUMPING), case[1], 1),
                                      (changed(made.results, lumping=LUMPING), made.scenario, 5)):  # fmt: skip
        (row,) = read_table(write(results, scenario)[SHEET], number)
        assert (row["train"], row["error [V]"], row["time of day"]) == (
            "7",
            "=C4-B4" if number == 1 else row["error [V]"],
            6 * 3600 + 600,
        )
        assert row["largest error at any train or load [V]"] == 40.25


def test_limits_of_all_systems_are_among_the_inputs(made, write):
    names = {row["name"] for row in read_table(write(made.results, made.scenario)["Inputs limits"])}
    assert {"u_n", "touch_permanent", "stray_current"} <= names


def test_the_cover_says_how_long_a_spell_may_last(book):
    assert "Longest spell of the rail potential above 150 V" in texts(book["Cover"])
    (row,) = [row for row in read_table(book["Acceptance"]) if row["what is judged"].endswith("rail potential above 150 V")]
    assert (row["limit"], row["limit value"], row["unit"]) == ("time above touch_300s", 1, "s")
    assert row["status of the limit"].startswith("secondary")


def test_a_run_without_earth_has_no_such_sheet(small):
    assert SHEET not in small.sheetnames


def test_leakage_of_32_bits_shows_no_noise(book):
    sheet = book["Rail potential"]
    headings = [cell for row in sheet.iter_rows() for cell in row if str(cell.value).startswith("leakage")]
    (head,) = [cell for cell in headings if "S/km" in cell.value]
    cells = [sheet.cell(row, head.column) for row in range(head.row + 1, sheet.max_row + 1)]
    assert {cell.number_format for cell in cells} == {"0.0000"}

"""The sheets of a judged timetable, and what the cover says of it."""

import shutil

import pytest
from fake_feasibility import REMEDIES, judged
from fake_results import make_case
from office import recalculated
from openpyxl import load_workbook

from tractionpower.reporting.workbook import write_workbook

SHEETS = ["Feasibility", "What would save it", "Delays by cause", "Delays", "Sections", "Lost time"]
LATE = {"1001": {"voltage": 70.0, "dwell": 5.0}}


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    results, scenario = make_case()
    file = write_workbook(
        judged(results, scenario, LATE, **REMEDIES), scenario, tmp_path_factory.mktemp("judged") / "report.xlsx"
    )
    return load_workbook(file, data_only=True)


@pytest.fixture
def write(tmp_path):
    """Return a function that writes results and reads the values of the workbook back."""
    return lambda results, scenario: load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"), data_only=True)


def rows_of(sheet, first="train"):
    """Return the rows of the table whose first heading is `first`, by heading."""
    cells = [[cell.value for cell in row] for row in sheet.iter_rows()]
    top = next(k for k, row in enumerate(cells) if row[0] == first)
    below = cells[top + 1 :]
    end = next((k for k, row in enumerate(below) if row[0] is None and not any(row)), len(below))
    return [dict(zip(cells[top], row, strict=True)) for row in below[:end]]


def test_the_sheets_stand_behind_the_cover(book):
    assert book.sheetnames[:8] == ["Cover", "Acceptance", *SHEETS]


def test_the_cover_says_the_verdict_first(book):
    told = {row[0].value: row[1].value for row in book["Cover"].iter_rows(max_col=2) if row[0].value}
    assert told["Feasibility"].startswith(("Is the", "Infeasible"))
    texts = [row[1].value for row in book["Cover"].iter_rows(max_col=2)]
    assert any(
        str(text).startswith("Infeasible: 1 of 4 trains late or not there. Worst: train 1001, late 75 s") for text in texts
    )


def test_trains_that_fail_come_first(book):
    rows = rows_of(book["Feasibility"])
    assert rows[0]["train"] == "1001"
    assert (rows[0]["verdict"], rows[0]["late at worst [s]"], rows[0]["main cause"]) == ("infeasible", 75.0, "low voltage")
    assert rows[0]["where it is latest"] == "Alfa"
    assert {row["verdict"] for row in rows[1:]} == {"feasible"}
    assert [row["quality index (running-time ratio)"] > 1.0 for row in rows] == [True] * 4
    assert len(book["Feasibility"].conditional_formatting) >= 3


def test_parts_of_delays_add_up(book):
    rows = rows_of(book["Delays"])
    assert len(rows) == 8
    for row in rows:
        parts = [row[key] or 0.0 for key in row if key.endswith("[s]") and not key.startswith(("delay [s]", "first arose"))]
        assert sum(parts) == pytest.approx(row["delay [s]"])
        assert sum(row[key] or 0.0 for key in row if key.startswith("first arose")) == pytest.approx(row["delay [s]"])
    assert [row["main cause"] for row in rows if row["delay [s]"]] == ["low voltage"]


def test_sections_tell_where_seconds_are_lost(book):
    row = next(row for row in rows_of(book["Sections"]) if row["train"] == "1001")
    assert row["lost to low voltage [s]"] == pytest.approx(70.0)
    assert row["reserve [s]"] - row["lost to low voltage [s]"] == pytest.approx(row["reserve left [s]"])
    assert (row["from"], row["to"], row["most lost at [km]"]) == ("Łódź Bravo", "Alfa", 5.5)


def test_lost_time_by_area_and_kilometre_with_charts(book):
    sheet = book["Lost time"]
    assert len(sheet._charts) == 2
    areas = rows_of(sheet, "area of")
    below = areas.pop()
    total = sum(row["lost [s]"] for row in areas)
    assert (below["area of"], below["lost [s]"]) == ("all", pytest.approx(total))
    assert total == pytest.approx(76.0, abs=0.1)  # 70 s, and 2 s of each other train
    assert areas == sorted(areas, key=lambda row: -row["lost [s]"])
    kms = [row for row in sheet.iter_rows(values_only=True) if row[1] in (1.5, 5.5, 9.5) and row[5] == 4]
    assert sum(row[2] for row in kms) == pytest.approx(total, abs=0.1)


def test_what_would_save_it(book):
    sheet = book["What would save it"]
    first, second = rows_of(sheet, "kind")
    assert (first["kind"], first["size"], first["saves it"], first["verified by a run"]) == (
        "departure shift",
        "+60 s",
        "yes",
        "yes",
    )
    assert first["as options of the command line"] == "--set 'timetable.trains[1001].calls[0].departure=06:06:00'"
    assert (second["subject"], second["saves it"], second["lost after [s]"]) == ("=cmd()", "no", None)
    assert sheet.cell(*next((c.row, c.column) for row in sheet.iter_rows() for c in row if c.value == "=cmd()")).data_type == "s"
    (sensitivity,) = rows_of(sheet, "what is changed")
    assert sensitivity["change of loss, all trains [s]"] == -6.2


def test_a_feasible_timetable_and_a_run_that_was_not_judged(write):
    results, scenario = make_case()
    book = write(judged(results, scenario, {}), scenario)
    assert "What would save it" not in book.sheetnames
    texts = [str(row[1].value) for row in book["Cover"].iter_rows(max_col=2)]
    assert any(text.startswith("Feasible: none of 4 trains is late; 15 s of reserve left") for text in texts)
    assert not set(SHEETS) & set(write(results, scenario).sheetnames)


def test_a_train_that_did_not_come_is_red_and_no_number(write):
    results, scenario = make_case()
    told = judged(results, scenario, LATE)
    train = told.run["feasibility"]["trains"][0]
    train |= {"verdict": "not finished", "late_s": None, "reserve_left_s": None, "cause": "", "why": "stuck"}
    row = rows_of(write(told, scenario)["Feasibility"])[0]
    assert (row["verdict"], row["late at worst [s]"], row["reserve left [s]"]) == ("not finished", None, None)


def test_verdicts_and_reserves_are_formulas_on_the_tolerance(tmp_path):
    results, scenario = make_case()
    path = write_workbook(judged(results, scenario, LATE), scenario, tmp_path / "report.xlsx")
    live = load_workbook(path)
    first = next(row[0].row for row in live["Feasibility"].iter_rows(max_col=1) if row[0].value == "1001")
    assert live["Feasibility"].cell(first, 2).value == f'=IF(C{first}>N(limit_tolerance_s),"infeasible","feasible")'
    assert live["Feasibility"]["A2"].value.startswith('=IF(feasibility_late_trains>0,"Infeasible: "&feasibility_late_trains&')
    sections = rows_of(live["Sections"])
    assert all(str(row["reserve left [s]"]).startswith("=") for row in sections)
    names = live.defined_names
    assert {"limit_tolerance_s", "feasibility_late_trains", "delays_s", "late_trains_voltage_s"} <= set(names)
    rows = [row for row in live["Acceptance"].iter_rows(values_only=True) if "greatest lateness at a timed call" in row]
    assert len(rows) == 1


def test_delays_by_cause_are_stacked_for_late_trains(book):
    sheet = book["Delays by cause"]
    (row,) = rows_of(sheet)
    assert (row["train"], row["low voltage [s]"], row["dwell at stops [s]"], row["delay [s]"]) == ("1001", 70.0, 5.0, 75.0)
    (chart,) = sheet._charts
    assert (chart.grouping, chart.type, len(chart.series)) == ("stacked", "bar", 2)
    sums = {row[0]: row[1] for row in sheet.iter_rows(max_col=2, values_only=True)}
    assert (sums["low voltage"], sums["dwell at stops"], sums["all"]) == (70.0, 5.0, 75.0)


@pytest.mark.filterwarnings("ignore:.*xtension is not supported:UserWarning")  # LibreOffice writes one
@pytest.mark.skipif(shutil.which("soffice") is None, reason="LibreOffice is not installed")
def test_a_tolerance_that_lets_a_late_train_pass_is_told_with_the_reserve(tmp_path):
    results, scenario = make_case()
    file = write_workbook(judged(results, scenario, LATE), scenario, tmp_path / "report.xlsx")
    before = load_workbook(file, data_only=True)["Feasibility"]
    label = {row[0].value: row for row in before.iter_rows(max_row=12, max_col=5) if row[0].value}
    least = label["least reserve left [s]"][3].value
    tolerance = label["tolerance [s]"][3].value
    assert label["least reserve left, tolerance included [s]"][3].value == pytest.approx(least + tolerance)
    assert least < 0.0
    assert label["least reserve left [s]"][4].value == "negative: so much is missing"

    book = load_workbook(file)
    sheet, cell = next(iter(book.defined_names["limit_tolerance_s"].destinations))
    book[sheet][cell.replace("$", "")] = 200.0
    book.save(tmp_path / "edited.xlsx")
    (again,) = recalculated([tmp_path / "edited.xlsx"])
    after = load_workbook(again, data_only=True)["Feasibility"]
    told = {row[0].value: row for row in after.iter_rows(max_row=12, max_col=5) if row[0].value}
    assert told["least reserve left [s]"][4].value == "negative: missing, but within the tolerance"
    assert told["least reserve left, tolerance included [s]"][3].value == pytest.approx(least + 200.0)
    headline = next(text for text in told if str(text).startswith("Feasible"))
    assert headline.endswith("s are missing at the tightest place, which is within the tolerance of 200 s")

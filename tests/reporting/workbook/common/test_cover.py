import re

import pytest
from fake_results import VERDICTS, changed
from openpyxl import load_workbook
from PIL import Image
from read_workbook import texts

from tractionpower.model.report import Document, Report
from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.common.accepted import Accepted, digits_of, place_in_words
from tractionpower.reporting.workbook.common.cover_verdicts import MOST_LINES

GREEN, RED, AMBER = "C6EFCE", "FFC7CE", "FFEB9C"


@pytest.fixture(scope="module")
def cover(small_values):
    return small_values["Cover"]


def coloured(cover):
    """Return the texts of a cover with the colours of their cells."""
    return {cell.value: cell.fill.start_color.rgb[-6:] for row in cover.iter_rows() for cell in row if cell.value is not None}


def line_of(cover, text):
    """Return the cells of the row that begins with a text, without those that are empty."""
    rows = cover.iter_rows(values_only=True)
    return next([cell for cell in row if cell not in (None, "")] for row in rows if row[0] == text)


def test_the_verdict_is_told_in_words_red_where_a_limit_is_violated(cover):
    assert coloured(cover)["1 of 3 limits violated"] == RED
    assert line_of(cover, "Violated")[1] == "highest voltage"
    assert "3 of these limits are editable values" in line_of(cover, "Limits")[1]


def test_the_verdict_is_a_formula_on_the_sheet_of_acceptance(small):
    formulas = [text for text in texts(small["Cover"]) if text.startswith("=")]
    assert any(text.startswith("=IF(acceptance_violated>0") for text in formulas)
    assert any("INDEX(acceptance_names,3)" in text for text in formulas)
    for number in (1, 2, 3):
        for name in ("found", "limits", "verdicts"):
            assert f"=INDEX(acceptance_{name},{number})" in formulas


def test_each_limit_has_a_line(cover):
    for verdict, word in zip(VERDICTS, ("met", "violated", "met"), strict=True):
        name = verdict["name"][0].upper() + verdict["name"][1:]
        _, found, limit, said, *rest = line_of(cover, name)
        assert (found, limit, said) == (verdict["value"], verdict["limit_value"], word)
        assert verdict["time"] in rest[0]


def test_numbers_are_shown_with_their_unit_and_which_way_the_limit_goes(small):
    shown = {cell.value: cell.number_format for row in small["Cover"].iter_rows() for cell in row if cell.value}
    assert shown["=INDEX(acceptance_found,1)"] == '0.0" V"'
    assert shown["=INDEX(acceptance_limits,1)"] == '"≥ "0.0" V"'
    assert shown["=INDEX(acceptance_limits,2)"] == '"≤ "0.0" V"'
    assert shown["=INDEX(acceptance_limits,3)"] == '"≤ "0.0" s"'


def test_how_far_to_trust_the_run_is_told(cover):
    assert line_of(cover, "Trains")[1] == "4 trains: 3 left the line, 1 still on the line at the end."
    assert line_of(cover, "Overlaps")[1] == "2 times two trains were on the same place of a track"


def test_all_limits_met_is_green(case, tmp_path):
    results, scenario = case
    file = write_workbook(changed(results, verdicts=[VERDICTS[0], VERDICTS[2]]), scenario, tmp_path / "a.xlsx")
    cover = load_workbook(file, data_only=True)["Cover"]
    assert coloured(cover)["All 2 limits met"] == GREEN
    assert line_of(cover, "Violated")[1] == "none"


def test_a_limit_that_was_not_judged_is_no_limit_met(case, tmp_path):
    results, scenario = case
    verdicts = [VERDICTS[0], VERDICTS[2] | {"value": None, "met": None}]
    cover = load_workbook(write_workbook(changed(results, verdicts=verdicts), scenario, tmp_path / "a.xlsx"), data_only=True)[
        "Cover"
    ]
    assert coloured(cover)["1 of 2 limits met, 1 not judged"] == AMBER


def test_a_run_without_limits_says_so(case, write):
    results, scenario = case
    assert coloured(write(changed(results, verdicts=[]), scenario)["Cover"])["No limits were judged"] == AMBER


def test_the_cover_of_a_part_says_of_what_and_that_limits_are_those_of_the_whole_run(case, write):
    results, scenario = case
    part = {"selection": {"trains": ["7"], "from": "06:30:00"}, "whole_run": {"met": 2, "violated": 1, "open": 0}}
    one = changed(results, verdicts=[], trains=results.run["trains"][:1], **part)
    cover = write(one, scenario)["Cover"]
    assert cover["A1"].value == scenario.name
    assert line_of(cover, "Part of the run")[1] == "train 7, from 06:30:00"
    assert f"1 of {len(scenario.runs)} trains" in line_of(cover, "What is shown")[1]
    assert "No limits were judged" not in texts(cover)
    assert any("There 2 of 3 limits are met, 1 violated" in text for text in texts(cover))


def test_sheets_that_the_workbook_does_not_have_are_told(case, tmp_path):
    results, scenario = case
    report = Report(sheets=("Outages",), leave_out=("Trains",))
    book = load_workbook(write_workbook(results, scenario, tmp_path / "a.xlsx", report))
    assert "Trains" not in [sheet.title for sheet in book if sheet.sheet_state == "visible"]
    assert any("asks for no sheet" in text for text in texts(book["Cover"]))


def test_digits_are_the_same_for_limits_of_a_kind_and_a_limit_never_reached_has_no_place():
    spells = [Accepted(f"spell {k}", f"touch_{k}", limit, "s", "at_most", 0.0) for k, limit in enumerate((300.0, 0.9))]
    rows = [*spells, Accepted("lowest", "u_min2", 2000.0, "V", "at_least", 2800.0, "km 7")]
    assert digits_of(rows) == ["0.00", "0.00", "0.0"]
    assert [place_in_words(row) for row in rows] == ["nowhere", "nowhere", "km 7"]


def test_more_limits_than_there_is_room_for_show_the_violated_ones(case, tmp_path):
    results, scenario = case
    many = [VERDICTS[0] | {"name": f"limit {k}"} for k in range(MOST_LINES + 30)] + [VERDICTS[1]]
    file = write_workbook(changed(results, verdicts=many), scenario, tmp_path / "a.xlsx")
    cover = load_workbook(file, data_only=True)["Cover"]
    assert line_of(cover, "Highest voltage")[3] == "violated"
    assert line_of(cover, "Violated")[1] == "highest voltage"
    assert "31 more are on sheet Acceptance." in texts(cover)
    assert all(len(text) <= 8192 for text in texts(load_workbook(file)["Cover"]))


@pytest.mark.parametrize(
    ("status", "words"), [("flagged", "Flagged: 3 of 1800 steps"), ("interrupted", "Interrupted after 1800")]
)
def test_a_run_that_is_not_complete_says_so_in_red(case, write, status, words):
    results, scenario = case
    told = coloured(write(changed(results, status=status, flagged_steps=3), scenario)["Cover"])
    assert next(colour for text, colour in told.items() if str(text).startswith(words)) == RED


def test_a_ledger_that_does_not_close_says_so(case, write):
    results, scenario = case
    open_ledger = {"electric": results.run["ledgers"]["electric"] | {"closes": False, "worst_gap_w": 12.0}}
    assert "Does not close: worst gap 12 W." in texts(write(changed(results, ledgers=open_ledger), scenario)["Cover"])


@pytest.mark.parametrize("volts", [2900, None])
def test_the_simplified_coupling_is_named_with_its_voltage(case, write, volts):
    results, scenario = case
    book = write(changed(results, coupling="constant_voltage", coupling_voltage_v=volts), scenario)
    assert any(f"constant voltage of {volts or 3000} V" in text and "simplification" in text for text in texts(book["Cover"]))


def test_links_lead_to_all_other_sheets(small):
    cells = [cell for row in small["Cover"].iter_rows() for cell in row if cell.hyperlink]
    assert [cell.hyperlink.location for cell in cells] == [f"'{name}'!A1" for name in small.sheetnames[1:]]


def test_links_lead_only_to_sheets_that_the_template_keeps(case, tmp_path):
    report = Report(sheets=("Cover", "Trains", "Acceptance"))
    book = load_workbook(write_workbook(*case, tmp_path / "a.xlsx", report))
    cells = [cell for row in book["Cover"].iter_rows() for cell in row if cell.hyperlink]
    assert [cell.value for cell in cells] == ["Trains", "Acceptance"]


def test_without_the_sheet_of_acceptance_the_verdict_is_its_value(case, tmp_path):
    book = load_workbook(write_workbook(*case, tmp_path / "a.xlsx", Report(leave_out=("Acceptance",))))
    assert "1 of 3 limits violated" in texts(book["Cover"])
    assert not [text for text in texts(book["Cover"]) if text.startswith("=")]


def test_the_template_stands_on_the_cover(case, tmp_path):
    document = Document(
        title="Study of the =supply", project="Upgrade", client="Manager", number="7-A", revision="B", made_by="A. B."
    )
    report = Report(company="Office & Sons", document=document)
    book = load_workbook(write_workbook(*case, tmp_path / "a.xlsx", report))
    cover = book["Cover"]
    assert cover["A1"].value == "Study of the =supply"
    for label, text in (
        ("Issued by", "Office & Sons"),
        ("Project", "Upgrade"),
        ("Client", "Manager"),
        ("Document number", "7-A"),
    ):
        assert line_of(cover, label)[1] == text
    assert {"Made by", "A. B.", "Checked by", "Approved by", "Signature"} <= set(texts(cover))
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", line_of(cover, "Date")[1])
    assert (book.properties.title, book.properties.creator, book.properties.version) == ("Study of the =supply", "A. B.", "B")


@pytest.mark.parametrize(("size", "kind"), [((1200, 100), "PNG"), ((50, 400), "JPEG"), ((3, 3), "PNG")])
def test_a_logo_is_fitted_and_keeps_its_shape(case, tmp_path, size, kind):
    file = tmp_path / f"logo.{kind.lower()}"
    Image.new("RGB", size, "navy").save(file, kind)
    book = load_workbook(write_workbook(*case, tmp_path / "a.xlsx", Report(logo=str(file))))
    (image,) = book["Cover"]._images
    width, height = image.anchor.ext.width / 360_000.0, image.anchor.ext.height / 360_000.0
    assert width <= 5.05
    assert height <= 2.05
    assert max(width / 5.0, height / 2.0) == pytest.approx(1.0, abs=0.02)
    assert width / height == pytest.approx(size[0] / size[1], rel=0.15)


def test_the_cover_is_one_page(small):
    setup = small["Cover"].page_setup
    assert (int(setup.fitToWidth), int(setup.fitToHeight), int(setup.paperSize), setup.orientation) == (1, 1, 9, "landscape")

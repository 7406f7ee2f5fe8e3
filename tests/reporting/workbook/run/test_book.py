import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import openpyxl
import pytest
from fake_results import NASTY, make_case
from read_workbook import filled_rows, read_table, texts
from small_studies import load, make_scenario, run_in_memory

from tractionpower.reporting.workbook import write_workbook

SHEETS = [
    "Cover", "Acceptance", "Timetable", "Trains", "Train energy", "Voltages", "Substations", "Energy", "Key figures", "Charts",
    "Extract trains", "Extract worst train", "Voltage histogram", "Voltage profile", "Extract loads", "Extract substation",
    "Load duration", "Events",
    "Assumptions", "Defaults", "Inputs study", "Inputs supply", "Inputs conductors", "Inputs line", "Inputs trains",
    "Inputs vehicles", "Inputs timetable", "Inputs limits", "Definitions", "Columns", "Not covered", "Solver evidence",
]  # fmt: skip
MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"


def test_all_sheets_are_there_in_order(small):
    assert small.sheetnames == SHEETS


def test_every_sheet_is_set_up_for_paper(small):
    for sheet in small.worksheets:
        width = sum(column.width for column in sheet.column_dimensions.values())
        is_cover = sheet.title == "Cover"
        paper = 8 if width > 165.0 and not is_cover else 9  # A3, A4
        assert (sheet.page_setup.orientation, int(sheet.page_setup.paperSize)) == ("landscape", paper), sheet.title
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        assert (int(sheet.page_setup.fitToWidth), int(sheet.page_setup.fitToHeight)) == (1, int(is_cover))
        assert sheet.freeze_panes is not None
        assert "&P of &N" in sheet.oddFooter.right.text
        for table in sheet.tables.values():
            assert table.autoFilter is not None


def test_every_part_is_well_formed_and_tables_have_names_of_their_own(nasty_file):
    with zipfile.ZipFile(nasty_file) as file:
        for name in file.namelist():
            ElementTree.fromstring(file.read(name))
        tables = [ElementTree.fromstring(file.read(name)) for name in file.namelist() if name.startswith("xl/tables/")]
    names = [table.get("displayName").casefold() for table in tables]
    assert len(names) == len(set(names)) > 20
    for table in tables:
        headings = [column.get("name").casefold() for column in table.iter(f"{MAIN}tableColumn")]
        assert len(headings) == len(set(headings))
        assert max(map(len, headings)) <= 255


def test_long_tables_repeat_and_freeze_their_header(small):
    for name in ("Timetable", "Trains", "Train energy", "Voltages", "Key figures", "Events", "Definitions", "Extract trains"):
        sheet = small[name]
        header = int(sheet.freeze_panes[1:]) - 1
        assert any(table.ref.startswith(f"A{header}:") for table in sheet.tables.values())
        assert sheet.print_title_rows == f"${header}:${header}"
        assert sheet.freeze_panes == f"B{int(header) + 1}"


def test_the_header_of_a_page_shows_an_ampersand(small_file):
    with zipfile.ZipFile(small_file) as file:
        text = ElementTree.fromstring(file.read("xl/worksheets/sheet1.xml")).find(f"{MAIN}headerFooter/{MAIN}oddHeader").text
    assert "&LForty kilometres && more" in text


def test_the_document_says_what_it_is(small):
    assert small.properties.creator == "tractionpower"
    assert small.properties.title == "Forty kilometres & more"


def test_no_name_becomes_a_formula_and_none_is_lost(nasty_file):
    with zipfile.ZipFile(nasty_file) as file:
        sheets = [name for name in file.namelist() if name.startswith("xl/worksheets/sheet")]
        formulas = [cell.text for name in sheets for cell in ElementTree.fromstring(file.read(name)).iter(f"{MAIN}f")]
        assert not [name for name in file.namelist() if "externalLink" in name]
    assert formulas
    assert not [formula for formula in formulas for name in NASTY if name.strip("=+-@#") in formula and len(name) > 3]
    book = openpyxl.load_workbook(nasty_file)
    for sheet in ("Timetable", "Trains", "Voltages", "Inputs timetable", "Extract trains"):
        assert set(NASTY) <= set(texts(book[sheet])), sheet
    assert book["Cover"]["A1"].value == '=HYPERLINK("x") & \ufffd <b>'
    assert book["Cover"]["A1"].data_type == "s"


def test_a_day_of_many_trains_stays_small(write):
    book = write(*make_case(trains=120, substations=14, hours=24.0))
    assert max(sheet.max_row for sheet in book.worksheets) < 7000
    assert filled_rows(book["Trains"]) >= 120
    assert len({row["train"] for row in read_table(book["Extract trains"])}) == 40
    assert len(book["Charts"]._charts) == 8


def test_a_network_calculation_has_no_sheets_of_trains(write):
    scenario = make_scenario(load("depot"))
    results, *_ = run_in_memory(scenario)
    book = write(results, scenario)
    assert {"Timetable", "Trains", "Train energy", "Voltages", "Extract trains", "Inputs stock", "Inputs timetable"}.isdisjoint(
        book.sheetnames
    )
    assert {"Substations", "Voltage profile", "Load duration", "Energy"} <= set(book.sheetnames)
    assert any("has no trains" in text for text in texts(book["Cover"]))


def test_missing_tables_leave_their_sheets_out(case, write):
    results, scenario = case
    bare = type(results)(results.run, [], {})
    book = write(bare, scenario)
    assert {"Timetable", "Events", "Extract trains", "Load duration"}.isdisjoint(book.sheetnames)
    assert "Cover" in book.sheetnames


def test_the_earlier_file_stays_until_the_new_one_is_complete(case, tmp_path, monkeypatch):
    path = tmp_path / "report.xlsx"
    path.write_text("earlier")

    def fails(self, target):
        Path(target).write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("openpyxl.Workbook.save", fails)
    with pytest.raises(OSError, match="No space"):
        write_workbook(*case, path)
    assert path.read_text() == "earlier"
    assert [file.name for file in tmp_path.iterdir()] == ["report.xlsx"]


def test_a_file_that_is_open_elsewhere_is_left_and_the_new_one_stands_beside(case, tmp_path, monkeypatch):
    path = tmp_path / "report.xlsx"
    path.write_text("open elsewhere")
    replace = Path.replace

    def locked(self, target):
        if Path(target) == path:
            raise PermissionError(13, "in use")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", locked)
    written = write_workbook(*case, path)
    assert written == tmp_path / "report.new.xlsx"
    assert openpyxl.load_workbook(written).sheetnames == SHEETS
    assert path.read_text() == "open elsewhere"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["report.new.xlsx", "report.xlsx"]


def test_openpyxl_is_imported_when_a_workbook_is_written():
    code = "import sys, tractionpower.reporting.workbook; print('openpyxl' in sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert ran.stdout.strip() == "False"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("soffice") is None, reason="LibreOffice is not installed")
def test_libreoffice_opens_it(nasty_file, tmp_path):
    command = ["soffice", "--headless", f"-env:UserInstallation=file://{tmp_path}/profile", "--convert-to", "pdf"]
    command += ["--outdir", str(tmp_path), str(nasty_file)]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")

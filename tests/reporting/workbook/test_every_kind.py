"""Workbooks of every kind: formulas that another program agrees with, nothing to repair, names that stay texts."""

import re
import zipfile
from pathlib import Path

import openpyxl
import pytest
from fake_books import KINDS, make_kind
from office import complaints, count_formulas, formulas_agree, needs_office, read_cells, recalculated, sheet_parts
from openpyxl.chart import BarChart, Series
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.table import Table, TableColumn
from read_workbook import read_table

from tractionpower.model.report import Language, Report
from tractionpower.reporting import texts
from tractionpower.reporting.workbook import write_workbook

POLISH = (Path(texts.__file__).parent / "pl.mo").is_file()
BOOKS: list[tuple[str, Language]] = [(kind, "en") for kind in KINDS]
BOOKS += [(kind, "pl") for kind in KINDS if POLISH]
CALCULATED = [(kind, chosen) for kind, chosen in BOOKS if kind != "run"]
"""All sheets of a run are in the workbooks of a verdict on a timetable and of ratings as well."""

STRANGE = {
    "company": "=cmd() & <Sons> &P",
    "document": {"title": "+1 &A \U0001f686", "project": "@sum(1)", "made_by": "-7", "number": "'x", "revision": "=1+1"},
    "assumptions": ["=HYPERLINK(1)", "<script>alert(1)</script>"],
}


@pytest.fixture(scope="module")
def books(tmp_path_factory):
    """Return the workbooks of every kind, all of them with names that nobody should have."""
    folder = tmp_path_factory.mktemp("kinds")
    made = {kind: make_kind(kind, folder / kind, nasty=True) for kind in KINDS}
    reports = {chosen: Report.model_validate({"language": chosen, **STRANGE}) for _, chosen in BOOKS}
    return {
        (kind, chosen): write_workbook(*made[kind], folder / f"{kind}-{chosen}.xlsx", reports[chosen]) for kind, chosen in BOOKS
    }


@pytest.fixture(scope="module")
def wrong(books):
    """Return a copy of a workbook in which one formula stands beside a wrong value, and the place of that."""
    path = books["sweep", "en"]
    target = path.with_name("wrong.xlsx")
    values, formulas = read_cells(path)
    sheet, place = next((sheet, place) for sheet, own in formulas.items() for place in own if values[sheet].get(place))
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == sheet_parts(old)[sheet]:
                cell = re.compile(rb'(<c r="%s"[^>]*><f>.*?</f><v>)([^<]*)' % place.encode())
                content = cell.sub(lambda match: match[1] + b"1234567", content)
            new.writestr(name, content)
    return target, f"{sheet}!{place} ="


@pytest.fixture(scope="module")
def edited(books):
    """Return a copy of the first workbook in which a checker has moved two limits."""
    path = books["run", "en"]
    book = openpyxl.load_workbook(path)
    for name, value in (("limit_u_min2", 2800.0), ("limit_u_max2", 4000.0)):
        ((sheet, place),) = book.defined_names[name].destinations
        book[sheet][place.replace("$", "")] = value
    book.save(path.with_name("edited.xlsx"))
    return path.with_name("edited.xlsx")


@pytest.fixture(scope="module")
def again(books, wrong, edited):
    """Return the same workbooks as LibreOffice has calculated them; it starts once for all."""
    paths = [*(books[which] for which in CALCULATED), wrong[0], edited]
    return dict(zip(paths, recalculated(paths), strict=True))


@pytest.mark.parametrize("which", BOOKS, ids="-".join)
def test_excel_would_have_nothing_to_repair(books, which):
    assert complaints(books[which]) == []


@needs_office
@pytest.mark.parametrize("which", CALCULATED, ids="-".join)
def test_every_formula_comes_to_the_value_beside_it(books, again, which):
    assert formulas_agree(books[which], again[books[which]]) == []


@pytest.mark.parametrize("which", BOOKS, ids="-".join)
def test_no_name_is_in_a_formula(books, which):
    _, formulas = read_cells(books[which])
    found = [formula for own in formulas.values() for formula in own.values()]
    assert not [formula for formula in found if "cmd" in formula or "HYPERLINK(" in formula or "[" in formula]


@pytest.mark.parametrize("which", BOOKS, ids="-".join)
def test_names_stay_texts_that_nobody_takes_for_formulas(books, which):
    book = openpyxl.load_workbook(books[which])
    begins = tuple("=+-@'")
    styled = [cell for sheet in book for row in sheet.iter_rows() for cell in row
              if cell.data_type == "s" and str(cell.value).startswith(begins)]  # fmt: skip
    assert styled or which[0] in ("contingency", "compare")
    assert all(cell.quotePrefix for cell in styled)


@needs_office
def test_the_other_program_calculates_itself(books, wrong, again):
    """A wrong value beside a formula is found: without that the test above would say nothing."""
    path, place = wrong
    assert count_formulas(books["sweep", "en"]) >= 9
    (found,) = formulas_agree(path, again[path])
    assert found.startswith(place)
    assert "1234567" in found


@needs_office
def test_verdicts_cover_and_charts_follow_a_limit_that_is_edited(books, edited, again):
    before, after = (openpyxl.load_workbook(path, data_only=True) for path in (books["run", "en"], again[edited]))
    told = [{row[1]: row[8] for row in book["Acceptance"].iter_rows(min_row=9, values_only=True)} for book in (before, after)]
    assert [verdicts["lowest voltage"] for verdicts in told] == ["met", "violated"]
    assert [verdicts["highest voltage"] for verdicts in told] == ["violated", "met"]
    violated = [{row[0]: row[1] for row in book["Cover"].iter_rows(values_only=True)}["Violated"] for book in (before, after)]
    assert violated == ["highest voltage", "lowest voltage"]
    limits = [{row["U_min2 [V]"] for row in read_table(book["Voltage profile"], 2)} for book in (before, after)]
    assert limits == [{2000}, {2800}]
    shares = [sum(row["share below U_min2 [%]"] for row in read_table(book["Voltage histogram"])) for book in (before, after)]
    volts = make_kind("run", edited.parent, nasty=True)[0].table("trains")["voltage_v"]
    assert shares == pytest.approx([0.0, 100.0 * (volts < 2800.0).mean()])
    assert shares[1] > 0.0


def test_what_excel_would_repair_is_found(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["a", "b"])
    sheet.append([1, "=1/0"])
    sheet.add_table(Table(displayName="one", ref="A1:B2"))
    sheet.tables["one"].tableColumns = [TableColumn(id=1, name="a"), TableColumn(id=2, name="c")]
    sheet.merge_cells("A2:A3")
    book.defined_names["gone"] = DefinedName("gone", attr_text="'No sheet'!$A$1")
    sheet["D1"].hyperlink = Hyperlink(ref="D1", location="'No sheet'!A1")
    chart = BarChart()
    chart.append(Series("'No sheet'!$A$1:$A$2"))
    sheet.add_chart(chart)
    book.save(tmp_path / "bad.xlsx")
    found = "\n".join(complaints(tmp_path / "bad.xlsx"))
    for words in ("has no value beside", "lies on A2:A3", "the columns ['a', 'c']", "name gone stands for", "leads to", "chart1"):
        assert words in found

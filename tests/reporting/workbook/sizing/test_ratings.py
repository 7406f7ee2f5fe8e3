"""The sheets of ratings, read back: every device against its rating, and verdicts that follow an edited limit."""

import pytest
from fake_results import make_case
from fake_sizing import sized
from office import ERRORS, needs_office, recalculated
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.model.report import Report
from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.sizing.rated_cells import multiple_of, sources_of, use_of

KINDS = {
    "unit": "Units", "substation": "Substation ratings", "feeder": "Feeder ratings", "contact_line": "Contact line",
    "rails": "Return circuit ratings",
}  # fmt: skip
SHEETS = [
    "Ratings", *KINDS.values(), "Ratings by window", "Loads by window", "Peaks", "Breakers", "Current duration", "Demand",
    "Sharing", "Useful voltage", "Useful voltage by hour", "Voltage durations",
]  # fmt: skip


def devices(book):
    """Return the rows of all sheets of kinds by device."""
    return {row["device"]: row for name in KINDS.values() for row in read_table(book[name])}


def test_the_sheets_stand_behind_the_cover(book, small):
    first = book.sheetnames.index("Ratings")
    assert book.sheetnames[first : first + len(SHEETS)] == SHEETS
    assert not set(SHEETS) & set(small.sheetnames)


def test_a_row_for_each_device_with_its_ruling_window(book, study):
    rows = devices(book)
    table = study[0].table("ratings")
    assert set(rows) == set(table["device"])
    for row in table[table["ruling"]].to_dict("records"):
        shown = rows[row["device"]]
        assert shown["utilisation [%]"] == pytest.approx(row["utilisation_percent"])
        assert shown["left [A]"] == pytest.approx(row["permitted_a"] - row["load_a"], abs=1e-3)
        assert shown["permitted in it [A]"] == pytest.approx(shown["rated current [A]"] * shown["multiple"])
        assert shown["holds"] == row["met"]
        assert shown["status of the rating"] == "recalled from memory"
    unrated = read_table(book["Return circuit ratings"])
    assert {(row["holds"], row["utilisation [%]"], row["window that rules"]) for row in unrated} == {
        ("not rated", None, "whole run")
    }


def test_utilisations_and_verdicts_are_formulas_on_their_row(formulas):
    for name in ("Units", "Substation ratings", "Feeder ratings", "Contact line"):
        for row in read_table(formulas[name]):
            assert "100*" in row["utilisation [%]"]
            assert row["permitted in it [A]"].startswith("=")
            assert "-1E-9*ABS($B$2)" in row["holds"]
        assert formulas[name]["B2"].value == '=IF(ISNUMBER(limit_utilisation_percent),limit_utilisation_percent,"")'


def test_kinds_are_told_with_their_worst_device(book, study):
    table = study[0].table("ratings")
    ruling = table[table["ruling"]]
    rows = {row["sheet"]: row for row in read_table(book["Ratings"])}
    for kind, sheet in KINDS.items():
        own, shown = ruling[ruling["kind"] == kind], rows[sheet]
        if own.empty:
            assert (shown["with a rating"], shown["holds"]) == (0, "not rated")
            continue
        worst = own.loc[own["utilisation_percent"].idxmax()]
        assert (shown["with a rating"], shown["of which device"]) == (len(own), worst["device"])
        assert shown["beyond what is permitted"] == (own["met"] == "no").sum()
        assert shown["highest utilisation [%]"] == pytest.approx(worst["utilisation_percent"])


def test_the_verdict_counts_what_fails(book, study):
    table = study[0].table("ratings")
    ruling = table[table["ruling"]]
    many, worst = (ruling["met"] == "no").sum(), ruling.loc[ruling["utilisation_percent"].idxmax()]
    assert many > 0
    sentence = next(text for text in texts(book["Ratings"]) if "rated devices beyond" in text)
    assert sentence.startswith(f"{many} of {len(ruling)} rated devices beyond 100 %. Most: {worst['device']},")
    assert any("no statement about a standard" in text for text in texts(book["Ratings"]))


def test_acceptance_has_the_worst_of_each_kind(book, study):
    table = study[0].table("ratings")
    ruling = table[table["ruling"]]
    rows = {row["what is judged"]: row for row in read_table(book["Acceptance"])}
    units = ruling[ruling["kind"] == "unit"]
    shown = rows["utilisation of rectifier units"]
    assert shown["found"] == pytest.approx(units["utilisation_percent"].max())
    assert shown["verdict"] == ("violated" if (units["met"] == "no").any() else "met")


def test_windows_of_a_rating_stand_together(book, study):
    table = study[0].table("ratings")
    rated = table[table["utilisation_percent"].notna()]
    rows = read_table(book["Ratings by window"])
    assert len(rows) == len(rated)
    assert {row["window"] for row in rows} == {"10 s", "1 min", "15 min", "2 h", "whole run"}
    assert sum(row["rules"] == "rules" for row in rows) == table["ruling"].sum()
    loads = {row["device"]: row for row in read_table(book["Loads by window"])}
    for row in table.to_dict("records"):
        heading = {10.0: "10 s", 60.0: "1 min", 900.0: "15 min", 7200.0: "2 h", 0.0: "whole run"}[row["window_s"]]
        assert loads[row["device"]][f"{heading} [A]"] == pytest.approx(row["load_a"])


def test_a_device_that_is_named_like_a_formula_stays_text(write):
    results, scenario = make_case(nasty=True)
    book = write(sized(results, scenario), scenario)
    names = {str(device) for device in sized(results, scenario).table("ratings")["device"] if str(device).startswith("=")}
    cells = [cell for name in SHEETS for row in book[name].iter_rows() for cell in row if str(cell.value) in names]
    assert names
    assert len(cells) >= len(names)
    assert all(cell.data_type == "s" for cell in cells)


def test_sources_stand_once_below_the_ratings(book):
    (source,) = (text for text in texts(book["Ratings"]) if text.startswith("1: "))
    assert source.startswith("1: recalled from memory. IEC 60146-1-1 as recalled")
    assert {row["source"] for row in devices(book).values()} == {1, None}


def test_inputs_of_the_user_that_differ_in_the_device_are_one_source(study):
    rows = study[0].table("ratings").head(4).assign(
        status=["user", "user", "derived", "user"], source=["rated_a of X", "rated_a of Y", "wires of Z", "rated_a of X"]
    )  # fmt: skip
    told, numbers = sources_of(rows)
    assert told == [("user", "rated_a of X, Y"), ("derived", "wires of Z")]
    assert numbers == {("user", "rated_a of X"): 1, ("user", "rated_a of Y"): 1, ("derived", "wires of Z"): 2}


def test_a_permitted_current_that_is_no_multiple_stays_a_value():
    assert multiple_of({"rated_current_a": 1700.0, "permitted_a": 2550.0}) == 1.5
    assert multiple_of({"rated_current_a": 1700.0, "permitted_a": 2000.0}) is None  # units that came during the run
    assert multiple_of({"rated_current_a": 0.0, "permitted_a": 0.0}) is None
    assert (use_of(0.0, 0.0), use_of(3.0, 0.0), use_of(3.0, 4.0)) == (0.0, 1e6, 75.0)


def test_devices_stand_along_the_line(write):
    results, scenario = make_case(substations=11)
    book = write(sized(results, scenario), scenario)
    for sheet, first in (("Peaks", "device"), ("Breakers", "feeder")):
        feeders = [row[first] for row in read_table(book[sheet]) if row[first].endswith("1 low_km")]
        assert list(dict.fromkeys(feeders)) == [f"Substation {k} 1 low_km" for k in range(1, 12)]


@needs_office
def test_verdicts_follow_an_edited_limit(sized_file, study, tmp_path):
    """The limit on the sheet of acceptance is set to the middle of what was found: half of the verdicts turn."""
    table = study[0].table("ratings")
    use = table.loc[table["ruling"], "utilisation_percent"]
    limit = round(float(use.median()), 3)
    book = load_workbook(sized_file)
    sheet, cell = next(book.defined_names["limit_utilisation_percent"].destinations)
    book[sheet][cell] = limit
    book.save(tmp_path / "edited.xlsx")
    (copy,) = recalculated([tmp_path / "edited.xlsx"])
    edited = load_workbook(copy, data_only=True)
    rows = [row for name in KINDS.values() for row in read_table_of(edited[name])]
    rated = [row for row in rows if row["holds"] != "not rated"]
    assert sum(row["holds"] == "no" for row in rated) == (use > limit).sum()
    assert all((row["holds"] == "no") == (row["utilisation [%]"] > limit) for row in rated)
    assert any(text.startswith(f"{(use > limit).sum()} of {len(use)} rated devices beyond") for text in texts(edited["Ratings"]))


def edited(source, path, **values):
    """Save a copy of a workbook in which named cells hold other values; None empties one. Return its path."""
    book = load_workbook(source)
    for name, value in values.items():
        sheet, cell = next(book.defined_names[name].destinations)
        book[sheet][cell] = value
    book.save(path)
    return path


def shown(book, name):
    """Return what a named cell shows."""
    sheet, cell = next(book.defined_names[name].destinations)
    return book[sheet][cell].value


@needs_office
def test_a_device_is_judged_by_the_window_that_rules_after_an_edit(study, tmp_path):
    """Multiples and the limit are edited, emptied and overwritten; what follows is computed here from the table."""
    results, scenario = make_case(substations=2, trains=2)
    scenario = scenario.model_copy(update={"duty_classes": study[1].duty_classes})
    results = sized(results, scenario)
    sheets = ["Cover", "Acceptance", "Ratings", *KINDS.values(), "Ratings by window"]
    source = write_workbook(results, scenario, tmp_path / "report.xlsx", Report(sheets=sheets))
    windows = [row.window_s for row in scenario.duty_classes]
    names = [f"duty_multiple_{k}" for k in range(1, len(windows) + 1)]
    paths = [
        edited(source, tmp_path / "hard.xlsx", **{names[windows.index(7200.0)]: 0.01}),
        edited(source, tmp_path / "none.xlsx", **dict.fromkeys(names)),
        edited(source, tmp_path / "text.xlsx", limit_utilisation_percent="what", **{names[0]: "ever"}),
        edited(source, tmp_path / "open.xlsx", limit_utilisation_percent=None),
    ]
    books = [load_workbook(copy, data_only=True) for copy in recalculated(paths)]
    for book in books:
        cells = [cell.value for sheet in book for row in sheet.iter_rows() for cell in row]
        assert not [value for value in cells if isinstance(value, str) and value in ERRORS]
    table = results.table("ratings")
    rated = table[table["utilisation_percent"].notna()]
    use = rated["utilisation_percent"].where(
        rated["window_s"] != 7200.0, 100.0 * rated["load_a"] / (0.01 * rated["rated_current_a"])
    )
    worst = rated.assign(use=use).sort_values("use", ascending=False, kind="stable").drop_duplicates("device").set_index("device")
    assert (worst["use"] > 100.0).sum() > (table["ruling"] & (table["utilisation_percent"] > 100.0)).sum()
    rows = [row for name in KINDS.values() for row in read_table_of(books[0][name]) if row["holds"] != "not rated"]
    assert len(rows) == len(worst)
    for row in rows:
        own = worst.loc[row["device"]]
        assert row["utilisation [%]"] == pytest.approx(own["use"], rel=1e-6)
        assert row["holds"] == ("no" if own["use"] > 100.0 else "yes")
        assert row["window that rules"] == "2 h"
    assert shown(books[0], "ratings_banner").startswith(f"{(worst['use'] > 100.0).sum()} of {len(worst)} rated devices beyond")
    for book in books[1:]:
        holds = {row["holds"] for name in KINDS.values() for row in read_table_of(book[name])}
        assert holds == {"not judged", "not rated"}
        assert shown(book, "ratings_banner").startswith("Nothing is judged")
        found = [row for row in read_table_of(book["Acceptance"], "no.") if row["group"] == "Ratings"]
        assert found
        assert {row["verdict"] for row in found} == {"not judged"}


def read_table_of(sheet, first="device"):
    """Return the rows of the first table of a sheet that LibreOffice has written, by its heading in column A."""
    rows = list(sheet.iter_rows(values_only=True))
    top = next(k for k, row in enumerate(rows) if row[0] == first)
    ends = (k for k in range(top + 1, len(rows)) if rows[k][0] is None)
    return [dict(zip(rows[top], row, strict=True)) for row in rows[top + 1 : next(ends, len(rows))]]

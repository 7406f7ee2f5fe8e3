"""The workbook of a sweep: verdicts, ranks and differences by formulas, against the tables of the study."""

import pytest
from office import ERRORS, needs_office, recalculated
from openpyxl import load_workbook
from read_workbook import read_table, texts
from small_studies import load, make_scenario

from tractionpower.reporting.workbook import write_workbook
from tractionpower.results.results import Results
from tractionpower.studies.sweep.study import sweep

E = "supply.substations[*].no_load_voltage_v"


@pytest.fixture(scope="module")
def results():
    return sweep(_scenario(), {E: [1990.0, 3300.0, 3700.0], "supply.loads[tap].power_kw": [400.0, 1500.0]})


def _scenario():
    return make_scenario(load("tap", 4.0, power_kw=600.0))


@pytest.fixture(scope="module")
def path(results, tmp_path_factory):
    return write_workbook(results, _scenario(), tmp_path_factory.mktemp("sweep") / "report.xlsx")


@pytest.fixture(scope="module")
def book(path):
    return load_workbook(path, data_only=True)


def test_cases_with_what_they_set_verdict_and_rank(book, results):
    cases = results.table("cases")
    rows = read_table(book["Variants"])
    assert [row["case"] for row in rows] == cases["case"].tolist()
    assert [row["lowest voltage [V]"] for row in rows] == pytest.approx(cases["lowest_voltage_v"].tolist())
    assert [row["verdict"] for row in rows] == ["violated" if fails else "met" for fails in cases["fails"]]
    assert {row["verdict"] for row in rows} == {"met", "violated"}
    best = sorted(rows, key=lambda row: (row["limits violated"], -row["lowest voltage [V]"]))
    assert [row["rank"] for row in best] == sorted(row["rank"] for row in rows)
    assert best[0]["rank"] == 1


def test_differences_are_those_of_the_study_and_live(book, path, results):
    told = results.table("differences").set_index(["case", "figure"])
    for row in read_table(book["Differences"]):
        assert row["lowest voltage [V]"] == pytest.approx(told.loc[(row["case"], "lowest_voltage_v"), "difference"], abs=1e-3)
        assert row["lowest voltage [%]"] == pytest.approx(told.loc[(row["case"], "lowest_voltage_v"), "percent"], abs=1e-4)
    cell = read_table(load_workbook(path)["Differences"])[0]["lowest voltage [V]"]
    assert cell.startswith("=INDEX(case_lowest_voltage_v,MATCH(")
    assert cell.endswith("-base_lowest_voltage_v")


def test_the_best_case_and_the_limits_are_told_by_formulas(book, path, results):
    extremes = results.run["sweep"]["extremes"]["lowest_voltage_v"]
    row = next(row for row in read_table(book["Best and worst"]) if row["figure"] == "lowest voltage [V]")
    assert (row["best case"], row["worst case"]) == (extremes["best"]["case"], extremes["worst"]["case"])
    live = load_workbook(path)
    verdict = read_table(live["Verdicts"])[0]["Lowest voltage"]
    assert "limit_u_min2" in verdict
    assert verdict.startswith("=IF(")
    assert "INDEX(case_lowest_voltage_v,MATCH(" in verdict
    found = next(row for row in live["Acceptance"].iter_rows(values_only=True) if "lowest voltage" in row)
    assert "=MIN(case_lowest_voltage_v)" in found


@needs_office
def test_emptied_limits_and_texts_in_them_judge_nothing(path, tmp_path):
    """The tolerance of one limit is edited too: the verdict on a voltage just below it turns."""
    edited, cells = [], {}
    for name, value in (("empty", None), ("text", "none")):
        book = load_workbook(path)
        cells = {each: next(book.defined_names[each].destinations) for each in book.defined_names if each.startswith("limit_")}
        for sheet, cell in cells.values():
            book[sheet][cell] = value
        book.save(tmp_path / f"{name}.xlsx")
        edited.append(tmp_path / f"{name}.xlsx")
    wide = load_workbook(path)
    lowest = min(row["lowest voltage [V]"] for row in read_table(load_workbook(path, data_only=True)["Variants"]))
    for name, value in (("limit_u_min2", lowest + 5.0), ("tolerance_u_min2", 5.5)):
        sheet, cell = next(wide.defined_names[name].destinations)
        wide[sheet][cell] = value
    wide.save(tmp_path / "wide.xlsx")
    books = [load_workbook(copy, data_only=True) for copy in recalculated([*edited, tmp_path / "wide.xlsx"])]
    assert "limit_u_min2" in cells
    for book in books[:2]:
        assert {row["verdict"] for row in read_table(book["Variants"])} == {"not judged"}
        assert {row["verdict"] for row in read_table(book["Acceptance"]) if row["limit"] == "U_min2"} == {"not judged"}
        assert not [cell.value for sheet in book for row in sheet.iter_rows() for cell in row if cell.value in ERRORS]
    assert {row["Lowest voltage"] for row in read_table(books[2]["Verdicts"])} == {"met"}
    assert {row["verdict"] for row in read_table(books[2]["Acceptance"]) if row["limit"] == "U_min2"} == {"met"}


def test_a_grid_of_two_keys_has_a_line_for_each_value(book):
    charts = book["Charts"]._charts
    lines = charts[0].series
    assert len(lines) == 4  # two powers, base, limit
    assert len(charts) == len([text for text in texts(book["Charts"]) if text == "base"])


def test_a_case_that_changes_a_limit_is_held_against_its_own(tmp_path):
    scenario = _scenario()
    system = scenario.supply.system
    place = next(k for k, limit in enumerate(scenario.limits) if (limit.system, limit.name) == (system, "u_min2"))
    results = sweep(scenario, {f"limits[{place}].value": [2000.0, 3590.0]})
    rows = read_table(load_workbook(write_workbook(results, scenario, tmp_path / "x.xlsx"), data_only=True)["Variants"])
    assert [bool(fails) for fails in results.table("cases")["fails"]] == [row["verdict"] == "violated" for row in rows]
    assert rows[-1]["verdict"] == "violated"


def test_a_sweep_without_a_single_case_has_a_workbook(tmp_path, results):
    source = dict(results._source)
    source |= {name: results._source[name].slice(0, 0) for name in ("cases", "case_changes", "differences")}
    run = results.run | {"verdicts": [], "sweep": results.run["sweep"] | {"extremes": {}}}
    book = load_workbook(write_workbook(Results(run, [], source), _scenario(), tmp_path / "x.xlsx"))
    assert "No case has ended." in texts(book["Variants"])
    assert "Differences" not in book.sheetnames

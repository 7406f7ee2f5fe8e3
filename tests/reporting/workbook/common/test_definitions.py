from fake_results import changed
from read_workbook import read_table

from tractionpower.reporting.workbook.common import definitions
from tractionpower.results.columns import TABLES


def test_every_column_of_the_tables_that_are_there_is_defined(small, case):
    rows = {(row["table"], row["name in files"]): row for row in read_table(small["Columns"])}
    present = set(case[0].tables)
    assert {table for table, _ in rows} == {table.replace("_", " ") for table in present}
    for table in present:
        for column in TABLES[table]:
            row = rows[table.replace("_", " "), column.name]
            assert (row["meaning"], row["unit"]) == (column.quantity.meaning, column.quantity.unit or None)


def test_a_key_figure_is_defined_once(small, case):
    names = [row["name in key_figures.json"] for row in read_table(small["Definitions"])]
    defined = {(figure["name"], figure["definition"]) for figure in case[0].key_figures}
    assert len(names) == len(defined)
    assert set(names) == {figure["name"] for figure in case[0].key_figures}


def test_a_definition_tells_of_what_and_by_which_standard(small):
    rows = {row["name in key_figures.json"]: row for row in read_table(small["Definitions"])}
    assert rows["lowest_voltage_v"]["of"] == "the worst of the run"
    assert rows["lowest_voltage_v"]["defined by"] == "EN 50163, U_min2; secondary"
    assert rows["journey_time_s"]["of"] == "each train"
    assert rows["mean_useful_voltage_time_mean_v"]["of"] == "each train, each feeding zone"
    assert rows["source_energy_kwh"]["of"] == "the whole run"


def test_results_without_figures_have_no_sheet_for_them(case, sheets):
    results, scenario = case
    bare = type(results)(changed(results).run, [], results._source)
    assert "Definitions" not in sheets(definitions, bare, scenario).sheetnames

"""The workbook of a comparison: differences and verdicts as formulas, charts side by side."""

import pytest
from openpyxl import load_workbook
from read_workbook import read_table
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.io.library import change
from tractionpower.reporting.workbook import write_workbook
from tractionpower.studies.compare.study import compare


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compare")
    scenario = make_scenario(load("tap", 4.0, power_kw=900.0))
    weak = change(scenario, ["supply.substations[A].internal_resistance_ohm=4.5"])
    for name, one in (("base", scenario), ("weak & =1", weak)):
        simulate(one, folder / name)
    results = compare([folder / "base", folder / "weak & =1"])
    return results, write_workbook(results, scenario, folder / "compare.xlsx")


def test_differences_follow_from_the_values(compared):
    results, path = compared
    rows, live = (read_table(load_workbook(path, data_only=data_only)["Substations"]) for data_only in (True, False))
    told = results.table("compare").set_index(["figure", "place", "folder"])
    energy = next(row for row in rows if row["figure"] == "energy" and row["place"] == "substation A")
    own = told.loc[("energy_kwh", "substation A", "weak & =1")]
    assert energy["weak & =1 less base"] == pytest.approx(own["difference"], rel=1e-5)
    assert energy["weak & =1 less base [%]"] == pytest.approx(own["percent"], rel=1e-5)
    assert all(str(row["weak & =1 less base"]).startswith("=") for row in live)


def test_verdicts_side_by_side_follow_the_limits_of_the_acceptance_sheet(compared):
    results, path = compared
    rows = {row["what is judged"]: row for row in read_table(load_workbook(path, data_only=True)["Verdicts"])}
    told = results.table("compare_verdicts")
    words = {"yes": "met", "no": "violated", "": "not judged"}
    for row in told.to_dict("records"):
        assert rows[row["figure"]][f"{row['folder']}: verdict"] == words[row["met"]]
    live = load_workbook(path)
    first = read_table(live["Verdicts"])[0]
    assert first["limit value"] == "=limit_u_min2"
    assert first["base: verdict"].startswith("=IF(")
    assert "limit_u_min2" in live.defined_names
    assert len(read_table(live["Acceptance"])) == len(told)


def test_charts_of_main_figures_name_the_folders(compared):
    charts = load_workbook(compared[1])["Charts"]._charts
    assert len(charts) >= 4
    assert [series.tx.v for series in charts[0].series] == ["base", "weak & =1"]

"""The workbook of a comparison: differences and verdicts as formulas, charts side by side."""

import shutil

import pandas as pd
import pytest
from office import recalculated
from openpyxl import load_workbook
from read_workbook import read_table, texts
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.io.library import change
from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.variants.compare import along_line
from tractionpower.reporting.workbook.variants.compare_cover import inputs_in_words
from tractionpower.reporting.workbook.variants.compare_verdicts import known_limits, unit_of
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


def _cover(path):
    return {
        row[0]: row[1] for row in load_workbook(path, data_only=True)["Cover"].iter_rows(max_col=2, values_only=True) if row[0]
    }


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
    assert "limit_u_min2" in first["limit value"]
    assert first["base: verdict"].startswith("=IF(")
    assert "limit_u_min2" in live.defined_names
    assert len(read_table(live["Acceptance"])) == len(told)


@pytest.mark.filterwarnings("ignore:.*xtension is not supported:UserWarning")  # LibreOffice writes one
@pytest.mark.skipif(shutil.which("soffice") is None, reason="LibreOffice is not installed")
def test_the_verdict_on_a_folder_follows_a_limit_that_is_edited(compared, tmp_path):
    live = load_workbook(compared[1])
    sheet, cell = next(iter(live.defined_names["limit_u_min2"].destinations))
    live[sheet][cell.replace("$", "")] = 9000.0
    live.save(tmp_path / "edited.xlsx")
    (again,) = recalculated([tmp_path / "edited.xlsx"])
    told = _cover(again)
    before = load_workbook(compared[1], data_only=True)["Verdicts"]
    assert "lowest voltage" in told["Verdict, base"]
    assert "lowest voltage" in told["Verdict, weak & =1"]
    assert read_table(before)[0]["base: verdict"] == "met"


def test_the_cover_tells_inputs_in_words_and_no_path_of_a_disk(compared):
    results, path = compared
    told = _cover(path)
    assert told["inputs that differ"] == "substation A: internal resistance [Ω]: 0.12 → 4.5"
    assert str(results.run["compare"]["folders"][0]["folder"]) not in "".join(map(str, told.values()))
    (row,) = read_table(load_workbook(path)["Inputs that differ"])
    assert (row["base"], row["value in the folder"]) == (0.12, 4.5)
    assert row["path"] == "supply.substations[A].internal_resistance_ohm"


def test_many_inputs_are_counted_by_what_they_belong_to():
    rows = [(f"supply.loads[{k}].power_kw", "1", "2") for k in range(9)]
    rows.append(("supply.feeders", "126 rows", "0 rows, 126 differences"))
    told = inputs_in_words(pd.DataFrame(rows, columns=["path", "base", "value"]))
    assert told == "135 differences, on sheet Inputs that differ: loads (9), feeders (126)"


def test_substations_stand_in_their_order_along_the_line():
    places = ["substation A", "substation B", "substation A"]
    rows = pd.DataFrame({"place": places, "figure": ["x", "x", "y"]})
    scenario = make_scenario()
    a, b = scenario.supply.substations[:2]
    far = scenario.model_copy(
        update={"supply": scenario.supply.model_copy(update={"substations": (b.model_copy(update={"km": a.km - 5.0}), a)})}
    )
    assert list(along_line(rows, "substation ", far)["place"]) == ["substation B", "substation A", "substation A"]
    assert list(along_line(rows, "substation ", scenario)["figure"]) == ["x", "y", "x"]


def test_what_is_held_against_a_limit_has_its_unit(compared):
    given = known_limits(Facts(compared[0], make_scenario()))
    assert [unit_of(name, given) for name in ("touch_permanent", "stray_current", "stray_shift_open")] == ["s", "mA/m", "V"]


def test_definitions_assumptions_and_evidence_are_there(compared):
    results, path = compared
    book = load_workbook(path, data_only=True)
    assert {"Assumptions", "Definitions", "Not covered", "Solver evidence"} <= set(book.sheetnames)
    names = {row["name in key_figures.json"] for row in read_table(book["Definitions"])}
    figures = set(results.table("compare")["figure"].astype(str))
    assert names == {figure["name"] for figure in simulate(make_scenario(load("tap", 4.0, power_kw=900.0))).key_figures} & figures
    words = texts(book["Solver evidence"])
    assert all(any(text.startswith(f"{name}: ") for text in words) for name in ("base", "weak & =1"))


def test_charts_of_main_figures_name_the_folders(compared):
    charts = load_workbook(compared[1])["Charts"]._charts
    assert len(charts) >= 4
    assert [series.tx.v for series in charts[0].series] == ["base", "weak & =1"]

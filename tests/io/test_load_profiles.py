"""Profiles of loads in files of their own: read, told where they are wrong, written again."""

import re
from pathlib import Path

import pytest
from small_studies import load, make_scenario

from tractionpower.cosimulation.check import check_scenario
from tractionpower.io.scenario_files import LONG_PROFILE, load_scenario, save_scenario

DOCS = Path(__file__).parents[2] / "docs"
CSV = "time,power_kw\n05:30,400\n22:00:00,120.5\n"
POINTS = [(19800.0, 400.0), (79200.0, 120.5)]


def points(load):
    return [(row.time, row.value) for row in load.profile]


def test_a_profile_in_a_csv_file(write_study):
    loads = 'loads:\n  - {id: depot, track: "1", km: 4.0, profile: depot.csv}\n'
    loaded = load_scenario(write_study({"supply.yaml": loads}, depot_csv=CSV))
    assert points(loaded.scenario.supply.loads[0]) == POINTS
    assert loaded.provenance.locate("supply.loads[depot].profile[1].power_kw") == "depot.csv:3"
    assert loaded.provenance.locate("supply.loads[depot].km") == "supply.yaml:9"


def test_a_csv_file_of_loads_names_csv_files_relative_to_itself(write_study):
    folder = write_study({"supply.yaml": "loads: loads/all.csv\n"})
    (folder / "loads").mkdir()
    table = "id;track;km;power_kw;profile\ndepot;1;4,0;;depot.csv\nheat;2;5,5;80,5;\n"
    (folder / "loads" / "all.csv").write_text(table, encoding="utf-8")
    (folder / "loads" / "depot.csv").write_text(CSV, encoding="utf-8")
    loaded = load_scenario(folder)
    depot, heat = loaded.scenario.supply.loads
    assert points(depot) == POINTS
    assert (heat.power_kw, heat.profile) == (80.5, None)
    assert loaded.provenance.locate("supply.loads[depot].profile[0].time") == "loads/depot.csv:2"


@pytest.mark.parametrize(
    ("text", "code", "place", "words"),
    [
        ("time,power_kw\n05:30,400\n05:60,1\n", "bad_time", "depot.csv:3", "05:60"),
        ("time,power_kw\n05:30,400\n06:00,much\n", "wrong_type", "depot.csv:3", "much"),
        ("time,power_kw\n05:30,400\n06:00,\n", "power_or_current", "depot.csv:3", "either power_kw or current_a"),
        ("time,power\n05:30,400\n", "unknown_column", "depot.csv:1", "did you mean power_kw?"),
        ("time,power_kw\n", "empty_list", "depot.csv", "at least one row"),
        ("time,power_kw\n06:00,1\n05:00,1\n", "profile_times", "supply.yaml:9", "05:00:00 stands behind 06:00:00"),
        ("time,power_kw\n06:00,1\n07:00,-1\n", "profile_signs", "supply.yaml:9", "as two loads"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(only_problem, text, code, place, words):
    loads = 'loads:\n  - {id: depot, track: "1", km: 4.0, profile: depot.csv}\n'
    problem = only_problem({"supply.yaml": loads}, depot_csv=text)
    assert (problem.code, problem.place) == (code, place)
    assert words in str(problem)


def test_a_missing_profile_is_told_where_it_is_named(only_problem):
    loads = 'loads:\n  - {id: depot, track: "1", km: 4.0, profile: depot.csv}\n'
    problem = only_problem({"supply.yaml": loads})
    assert (problem.code, problem.path, problem.place) == ("missing_file", "supply.loads[depot].profile", "supply.yaml:9")


@pytest.mark.parametrize("kind", ["power_kw", "current_a"])
@pytest.mark.parametrize("rows", [1, LONG_PROFILE, LONG_PROFILE + 1, 3 * LONG_PROFILE])
def test_what_is_saved_reads_back(tmp_path, kind, rows):
    profile = [{"time": 0.1 * k, kind: 100.0 / (k + 3)} for k in range(rows)]
    scenario = make_scenario(load("a"), load("b", power_kw=None, profile=profile), load("c", current_a=5.0), load("b/ö", 7.0))
    save_scenario(scenario, tmp_path)
    assert [path.name for path in (tmp_path / "profiles").glob("*")] == (["load-2.csv"] if rows > LONG_PROFILE else [])
    again = load_scenario(tmp_path).scenario
    assert again == scenario
    assert again.input_hash == scenario.input_hash


def test_the_example_of_the_documentation(write_study):
    page = (DOCS / "loads.md").read_text(encoding="utf-8")
    (loads,) = re.findall(r"```yaml\n# supply.yaml\n(.*?)```", page, re.DOTALL)
    (table,) = re.findall(r"```csv\n# preheating.csv: .*?\n(.*?)```", page, re.DOTALL)
    winter = "time;current_a\n00:00;80,5\n06:00;120\n"
    folder = write_study({"supply.yaml": loads})
    (folder / "preheating.csv").write_text(table, encoding="utf-8")
    (folder / "winter-heating.csv").write_text(winter, encoding="utf-8")
    scenario = load_scenario(folder).scenario
    assert check_scenario(scenario) == []
    preheating = next(item for item in scenario.supply.loads if item.id == "preheating")
    assert points(preheating)[3] == (16800.0, 1440.0)
    assert max(value for _, value in points(preheating)) == 4 * 8 * 45.0

import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.errors import InputError, OutputError
from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.library import change
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.scenario_files import load_scenario, read_scenario, save_scenario
from tractionpower.io.templates import template_texts
from tractionpower.model.vehicle import Part


def test_a_sound_study_is_loaded(write_study):
    folder = write_study()
    loaded = load_scenario(folder)
    assert loaded.scenario.name == "Test"
    assert loaded.scenario.clock.end == 900.0
    assert loaded.scenario.limits == shipped_limits()
    assert (loaded.folder, loaded.problems, loaded.origin) == (folder, (), str(folder))


def test_the_study_file_itself_may_be_named(write_study):
    folder = write_study()
    (folder / "study.yaml").rename(folder / "variant.yaml")
    assert load_scenario(folder / "variant.yaml").provenance.locate("clock") == "variant.yaml:3"


def test_file_names_do_not_enter_the_hash(write_study):
    first = load_scenario(write_study()).scenario
    folder = write_study(study_yaml='format: 1\nname: Test\nline: l.yaml\nclock: {start: "00:00:00", end: 00:15:00}\n')
    (folder / "line.yaml").rename(folder / "l.yaml")
    second = load_scenario(folder).scenario
    assert first == second
    assert first.input_hash == second.input_hash


def test_rows_in_csv_and_yaml_give_the_same_scenario(write_study):
    rows = "gradients: [{from_km: 0, to_km: 1.5, permille: 2, tracks: [1, 2]}, {from_km: 2, to_km: 3, permille: 1}]\n"
    table = "from_km;to_km;permille;tracks\n0;1,5;2;1 2\n2;3;1;\n"
    first = load_scenario(write_study({"line.yaml": rows})).scenario
    assert load_scenario(write_study({"line.yaml": "gradients: g.csv\n"}, g_csv=table)).scenario == first


def test_problems_of_all_files_are_told_at_once_in_the_order_of_the_files(write_study):
    folder = write_study(
        study_yaml="format: 1\nseed: -1\nclok: {}\nlimits: l.csv\n",
        line_yaml="format: 1\ntracks: 5\nstations: []\nstations: []\n",
        supply_yaml="format: 1\nsubstations:\n\t- {}\n",
        l_csv="system,name,value,unit\ndc3000,u_max2,high,V\n",
    )
    with pytest.raises(InputError) as caught:
        load_scenario(folder)
    assert [(problem.code, problem.place) for problem in caught.value.problems] == [
        ("out_of_bounds", "study.yaml:2"),
        ("unknown_key", "study.yaml:3"),
        ("wrong_type", "line.yaml:2"),
        ("duplicate_key", "line.yaml:4"),
        ("tab", "supply.yaml:3"),
        ("wrong_type", "l.csv:2"),
    ]


def test_a_broken_study_file_does_not_hide_problems_of_its_parts(problems_of_study):
    problems = problems_of_study(study_yaml="format: [\n", line_yaml="format: 1\ntracks: 5\n")
    assert [problem.place for problem in problems] == ["study.yaml:2", "line.yaml:2"]


def test_a_missing_part_is_told_where_it_is_named(only_problem):
    problem = only_problem(study_yaml="format: 1\nline: none.yaml\nclock: {start: 00:00, end: 01:00}\n")
    assert (problem.code, problem.path, problem.place) == ("missing_file", "line", "study.yaml:2")


def test_a_folder_as_a_part(write_study):
    folder = write_study(study_yaml="format: 1\nline: sub\nclock: {start: 00:00, end: 01:00}\n")
    (folder / "sub").mkdir()
    loaded, (problem,) = read_scenario(folder)
    assert loaded is None
    assert (problem.code, problem.place) == ("not_a_file", "sub")


def test_a_duplicate_key_alone_is_an_error(only_problem):
    problem = only_problem({"line.yaml": "stations: []\nstations: []\n"})
    assert (problem.code, problem.place) == ("duplicate_key", "line.yaml:6")


STUDY = "format: 1\ntimetable: t.yaml\nclock: {start: 00:00, end: 01:00}\n"


def test_a_timetable_without_trains_is_read(problems_of_study):
    assert problems_of_study(study_yaml=STUDY, t_yaml="format: 1\ntrains: []\n") == []


def test_saving_writes_trains_and_vehicles_under_names_that_every_system_keeps(write_study, with_trains, tmp_path):
    loaded = load_scenario(write_study(with_trains)).scenario
    vehicle = loaded.vehicles[0]
    vehicles = tuple(vehicle.model_copy(update={"id": name}) for name in ("A/B", "a/b", "con"))
    train = loaded.trains[0].model_copy(update={"vehicles": tuple(Part(id=each.id) for each in vehicles)})
    scenario = loaded.model_copy(update={"trains": (train,), "vehicles": vehicles})
    save_scenario(scenario, tmp_path / "saved")
    names = sorted(file.name for file in (tmp_path / "saved/rollingstock/vehicles").iterdir())
    assert names == ["%41%2F%42.yaml", "%63on.yaml", "a%2Fb.yaml"]
    assert load_scenario(tmp_path / "saved").scenario == scenario


def test_rolling_stock_of_another_study_is_not_touched(write_study, with_trains, tmp_path):
    scenario = load_scenario(write_study(with_trains)).scenario
    save_scenario(scenario, tmp_path / "saved")
    other = tmp_path / "saved/rollingstock/vehicles/other.yaml"
    other.write_text("kept")
    save_scenario(scenario, tmp_path / "saved")
    assert other.read_text() == "kept"
    assert load_scenario(tmp_path / "saved").scenario == scenario


LIMITS = "format: 1\nlimits: l.csv\nclock: {start: 00:00, end: 01:00}\n"


def test_limits_are_laid_over_the_shipped_ones(write_study):
    folder = write_study(study_yaml=LIMITS, l_csv="system,name,value,unit\ndc3000,u_max2,3950,V\nmine,u_n,1,\n")
    limits = {(limit.system, limit.name): limit for limit in load_scenario(folder).scenario.limits}
    assert len(limits) == len(shipped_limits()) + 1
    assert (limits["dc3000", "u_max2"].value, limits["dc3000", "u_max2"].status) == (3950.0, "user")


@pytest.mark.parametrize(
    ("row", "code", "path", "found"),
    [
        ("dc3000,u_n,=A1,V", "wrong_type", "limits[dc3000 u_n].value", "'=A1' in column value"),
        (",u_n,3,V", "missing_key", "limits[1].system", "nothing in column system"),
        ("dc3000,u_max2,4000,V", "duplicate_row", "limits", "the limit dc3000 u_max2 2 times"),
    ],
)
def test_problems_of_limits(only_problem, row, code, path, found):
    problem = only_problem(study_yaml=LIMITS, l_csv=f"system,name,value,unit\ndc3000,u_max2,3950,V\n{row}\n")
    assert (problem.code, problem.path, problem.place, problem.found) == (code, path, "l.csv:3", found)


def test_only_changed_limits_are_saved(write_study, tmp_path):
    folder = write_study(study_yaml=LIMITS, l_csv="system,name,value,unit\ndc3000,u_max2,3950,V\n")
    scenario = load_scenario(folder).scenario
    save_scenario(scenario, tmp_path / "saved")
    assert (tmp_path / "saved" / "limits.csv").read_text().count("\n") == 2
    assert load_scenario(tmp_path / "saved").scenario == scenario


CONDUCTORS = "format: 1\nconductors: c.csv\nclock: {start: 00:00, end: 01:00}\n"
HEADER = "kind,name,resistance_ohm_per_km,wires\n"
SUPPLY = (
    "format: 1\ncontact_lines:\n  - {from_km: 0.0, to_km: 20.0, type: C120-2C}\n"
    "return_circuit:\n  - {from_km: 0.0, to_km: 20.0, rail: mine}\n"
)


def test_conductors_are_laid_over_the_shipped_ones_and_only_those_in_use_are_kept(write_study, tmp_path):
    rows = "rail,mine,0.012,\nwire,L120,0.16,\nwire,Cu150,0.13,\n"
    loaded = load_scenario(write_study(study_yaml=CONDUCTORS, supply_yaml=SUPPLY, c_csv=HEADER + rows))
    kept = {(row.kind, row.name): row for row in loaded.scenario.conductors}
    assert list(kept) == [("contact_line", "C120-2C"), ("rail", "mine"), ("wire", "Cu100"), ("wire", "L120")]
    assert (kept["wire", "L120"].resistance_ohm_per_km, kept["wire", "L120"].status) == (0.16, "user")
    assert len(loaded.library.conductors) == len(shipped_conductors()) + 1
    save_scenario(loaded.scenario, tmp_path / "saved")
    assert (tmp_path / "saved" / "conductors.csv").read_text().count("\n") == 3  # the rail and the wire that differs
    assert load_scenario(tmp_path / "saved").scenario == loaded.scenario


def test_conductors_that_nobody_uses_change_no_hash(write_study):
    plain = load_scenario(write_study()).scenario
    assert plain.conductors == ()
    with_rows = load_scenario(write_study(study_yaml=CONDUCTORS + "name: Test\n", c_csv=HEADER + "rail,mine,0.012,\n")).scenario
    again = with_rows.model_copy(update={"clock": plain.clock})
    assert again.input_hash == plain.input_hash


def test_changes_may_name_any_conductor_of_the_table(write_study):
    loaded = load_scenario(write_study(study_yaml=CONDUCTORS, c_csv=HEADER + "contact_line,mine,0.07,\n"))
    clear = "supply.contact_lines[0].resistance_ohm_per_km=null"
    changed = loaded.changed([clear, "supply.contact_lines[0].type=mine"])
    assert [row.resistance_ohm_per_km for row in changed.conductors] == [0.07]
    shipped = change(changed, ["supply.contact_lines[0].type=CA-220"])
    assert [row.name for row in shipped.conductors] == ["CA-220", "CuAg150", "L185"]


def test_a_changed_row_of_a_conductor_wins_over_the_table(write_study):
    loaded = load_scenario(write_study(supply_yaml=SUPPLY.replace("mine", "60E1")))  # a rail, though YAML reads 600
    assert [row.name for row in loaded.scenario.conductors][1] == "60E1"
    changed = loaded.changed(["conductors[1].resistance_ohm_per_km=0.02"])
    assert next(row for row in changed.conductors if row.name == "60E1").resistance_ohm_per_km == 0.02


@pytest.mark.parametrize(
    ("row", "code", "path", "found"),
    [
        ("rail,mine,=A1,", "wrong_type", "conductors[rail mine].resistance_ohm_per_km", "'=A1' in column resistance_ohm_per_km"),
        ("rial,mine,0.1,", "bad_choice", "conductors[rial mine].kind", "'rial' in column kind"),
        ("wire,L120,0.2,", "duplicate_row", "conductors", "the conductor wire L120 2 times"),
    ],
)
def test_problems_of_conductors(only_problem, row, code, path, found):
    problem = only_problem(study_yaml=CONDUCTORS, c_csv=f"{HEADER}wire,L120,0.1,\n{row}\n")
    assert (problem.code, problem.path, problem.place, problem.found) == (code, path, "c.csv:3", found)


@pytest.mark.parametrize("row", ["contact_line,mine,,L120", "wire,mine,,", "rail,mine,0.1,contact 1 Cu100"])
def test_a_row_that_makes_no_conductor_is_told_with_its_line(only_problem, row):
    problem = only_problem(study_yaml=CONDUCTORS, c_csv=f"{HEADER}{row}\n")
    assert (problem.path.split("[")[0], problem.place) == ("conductors", "c.csv:2")


def test_saving_where_nothing_can_be_written(write_study, tmp_path):
    scenario = load_scenario(write_study()).scenario
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot write"):
        save_scenario(scenario, tmp_path / "file")


SNIPPETS = [
    "\t",
    "\n",
    "'",
    "{",
    "]",
    ": ",
    "- ",
    "&a ",
    "*a",
    "!x ",
    "? ",
    "|\n",
    "---\n",
    "<<: ",
    "1e999",
    "\0",
    "\x85",
    "null",
    "../",
    "é",
]


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.sampled_from(sorted(set(template_texts()) - {"README.md"})),
    st.integers(0, 10_000),
    st.lists(st.sampled_from(SNIPPETS), max_size=4),
)
def test_damaged_files_give_problems_with_a_place_and_never_crash(name, at, snippets):
    texts = template_texts()
    at %= len(texts[name])
    texts[name] = texts[name][:at] + "".join(snippets) + texts[name][at + 5 :]
    with tempfile.TemporaryDirectory() as folder:
        for file, text in texts.items():
            (Path(folder) / file).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / file).write_text(text, encoding="utf-8")
        loaded, problems = read_scenario(folder)
    assert (loaded is None) == bool(problems)
    assert all(problem.place and str(problem).isprintable() for problem in problems)

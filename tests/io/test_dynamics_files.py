"""Cases of train dynamics in YAML: their vehicles and couplings, their lines, all problems at once; what ships."""

import pytest

from tractionpower.dynamics.checks import check_case
from tractionpower.errors import InputError, UsageError
from tractionpower.io.dynamics_files import KINDS, load_case, read_case, shipped_cases
from tractionpower.model.dynamics.case import DynamicsScenario

VEHICLE = (
    "format: 1\nid: {0}\nkind: wagon\nmass_t: 80\nlength_m: 15\nmax_speed_kmh: 100\nrotating_mass_factor: 1.05\n"
    "resistance: {{a_n: 1000}}\n"
)
CASE = """format: 1
name: Two wagons
vehicles:
  - {id: loco, traction: {starting_effort_kn: 200, power_kw: 2000}}
  - {id: wagon, count: 3, coupling: soft}
coupling: stiff
commands: commands.csv
run: {duration_s: 60}
"""
FILES = {
    "case.yaml": CASE,
    "commands.csv": "time_s,drive,brake,reduction_bar\n0,1,charge,\n10,15,,\n20,0,4,\n30,0,,0.5\n40,0,full_service,\n",
    "rollingstock/vehicles/loco.yaml": VEHICLE.format("loco").replace("wagon\n", "locomotive\n", 1),
    "rollingstock/vehicles/wagon.yaml": VEHICLE.format("wagon"),
    "rollingstock/couplings/soft.yaml": "format: 1\nid: soft\ndraw: {stiffness_kn_per_mm: 2}\n",
    "rollingstock/couplings/stiff.yaml": "format: 1\nid: stiff\ndraw: {stiffness_kn_per_mm: 10}\n",
}


@pytest.fixture
def write(tmp_path, stock_places):
    def make(**changed):
        texts = FILES | {name: text for name, text in changed.items() if name in FILES}
        texts["case.yaml"] = changed.get("case", texts["case.yaml"])
        for name, text in texts.items():
            (tmp_path / "case" / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / "case" / name).write_text(text, encoding="utf-8")
        return tmp_path / "case"

    return make


def test_a_case_with_all_that_it_names(write):
    folder = write()
    loaded = load_case(folder)
    scenario = loaded.scenario
    assert isinstance(scenario, DynamicsScenario)
    assert (loaded.name, loaded.file, loaded.problems) == ("case", folder / "case.yaml", ())
    assert [part.id for part in scenario.parts] == ["loco", "wagon", "wagon", "wagon"]
    assert [part.coupling for part in scenario.parts] == ["stiff", "soft", "soft", "soft"]
    assert [vehicle.id for vehicle in scenario.vehicles] == ["loco", "wagon"]
    assert [coupling.id for coupling in scenario.couplings] == ["soft", "stiff"]
    assert [command.brake for command in scenario.case.commands] == ["charge", None, 4, None, "full_service"]
    assert [command.reduction_bar for command in scenario.case.commands] == [None, None, None, 0.5, None]
    assert load_case(str(folder / "case.yaml")).scenario == scenario


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ("case.commands[2].brake", "commands.csv:4"),
        ("case.vehicles[1].coupling", "case.yaml:5"),
        ("case.run.step_s", "case.yaml:8"),
        ("case.track", "case.yaml:1"),
        ("couplings[soft].draw.stiffness_kn_per_mm", "rollingstock/couplings/soft.yaml:3"),
        ("vehicles[wagon].mass_t", "rollingstock/vehicles/wagon.yaml:4"),
    ],
)
def test_every_path_has_file_and_line(write, path, place):
    assert load_case(write()).provenance.locate(path) == place


def test_what_is_wrong_in_all_files_is_told_at_once(write):
    case = CASE.replace("id: loco,", "id: locco,").replace("coupling: stiff", "coupling: stif").replace("60", "-60")
    changed = {
        "commands.csv": "time_s,drive,brake\n0,1,chrage\n",
        "rollingstock/couplings/soft.yaml": "format: 1\nid: soft\nslack: 3\ndraw: {stiffness_kn_per_mm: 2}\n",
    }
    loaded, problems = read_case(write(case=case, **changed))
    assert loaded is None
    told = {problem.path: problem for problem in problems}
    assert told["case.vehicles[locco].id"].remedy == "did you mean loco?"
    assert told["case.coupling"].code == "unknown_coupling"
    assert told["case.coupling"].remedy == "did you mean stiff?"
    assert "rollingstock/couplings" in told["case.coupling"].allowed
    assert told["case.run.duration_s"].place == "case.yaml:8"
    assert told["case.commands[0].brake"].place == "commands.csv:2"
    assert told["couplings[soft].slack"].remedy == "did you mean slack_mm?"
    assert len(problems) == 5


def test_a_part_may_name_an_unknown_coupling(write):
    _, problems = read_case(write(case=CASE.replace("soft", "softt")))
    assert [(problem.code, problem.path, problem.place) for problem in problems] == [
        ("unknown_coupling", "case.vehicles[wagon].coupling", "case.yaml:5")
    ]


def test_an_unknown_kind(write):
    _, problems = read_case(write(case=CASE + "kind: vehicle\n"))
    assert [(problem.code, problem.path, problem.place) for problem in problems] == [("bad_choice", "case.kind", "case.yaml:9")]
    assert problems[0].allowed == ", ".join(KINDS)
    assert problems[0].remedy == "did you mean vehicles?"


def test_a_case_with_stations_is_told_by_its_own_declaration(write):
    _, problems = read_case(write(case="format: 1\nkind: stations\nname: Line\nlength_m: -1\nvehicles: []\n"))
    told = {problem.path: problem.code for problem in problems}
    assert told["case.length_m"] == "out_of_bounds"
    assert told["case.vehicles"] == "unknown_key"
    assert told["case.stations"] == "missing_key"


@pytest.mark.parametrize("text", ["", "- a\n", "a: [\n", "format: 2\nkind: new\n"])
def test_what_is_no_case(write, text):
    loaded, problems = read_case(write(case=text))
    assert loaded is None
    assert problems
    assert all(problem.place.startswith("case.yaml") for problem in problems)


def test_load_case_raises_what_is_wrong(write):
    with pytest.raises(InputError, match=r"case\.yaml:8"):
        load_case(write(case=CASE.replace("60", "x")))
    with pytest.raises(UsageError, match="no case"):
        load_case("no-such-case")


@pytest.mark.parametrize("name", shipped_cases())
def test_every_case_that_ships_is_sound(name):
    loaded = load_case(name)
    assert all(problem.severity == "warning" for problem in loaded.problems)
    if isinstance(loaded.scenario, DynamicsScenario):
        assert check_case(loaded.scenario) == []

import json

import pytest

from tractionpower.cli import main
from tractionpower.cli.messages import exit_code_of, has_errors, summary
from tractionpower.errors import InputError, Problem

SCHEMAS = ["study", "line", "supply", "timetable", "train", "vehicle", "limits", "conductors", "duty_classes"]
SCHEMAS += ["rectifier_units", "measured", "report", "case", "stations", "coupling"]


@pytest.fixture
def study(tmp_path, capsys):
    assert main(["new", str(tmp_path / "study")]) == 0
    capsys.readouterr()
    return tmp_path / "study"


def test_check_of_a_sound_study(study, capsys):
    assert main(["check", str(study)]) == 0
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("no problems\n", "")


def test_check_lists_all_problems_by_file(study, capsys):
    (study / "line.yaml").write_text("format: 1\ntracks: 5\nstatoins: []\n")
    (study / "supply.yaml").write_text("")
    assert main(["check", str(study)]) == 1
    captured = capsys.readouterr()
    assert captured.out == "3 errors\n"
    assert captured.err.index("line.yaml:2: line.tracks: found 5") < captured.err.index("line.yaml:3: line.statoins")
    assert "remedy: did you mean stations?" in captured.err
    assert "supply.yaml: supply: the file is empty" in captured.err


def test_check_as_json(study, capsys):
    (study / "line.yaml").write_text("format: 1\ntracks: 5\n")
    assert main(["check", str(study), "--json"]) == 1
    captured = capsys.readouterr()
    told = json.loads(captured.out)
    assert captured.err == ""
    assert told["problems"][0] == {
        "code": "wrong_type",
        "path": "line.tracks",
        "found": "5",
        "allowed": "a list, or the name of a CSV file",
        "remedy": "",
        "severity": "error",
        "place": "line.yaml:2",
    }


def test_names_of_users_are_neither_markup_nor_terminal_codes(study, capsys):
    (study / "line.yaml").write_text('format: 1\n"[red]a\\e[31m": 1\ntracks:\n  - {id: 1, from_km: 0, to_km: 1}\n')
    assert main(["check", str(study)]) == 1
    told = capsys.readouterr().err
    assert "'[red]a\\x1b[31m'" in told
    assert "\x1b" not in told


@pytest.mark.parametrize("name", SCHEMAS)
def test_schema_prints_json(name, capsys):
    assert main(["schema", name, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["type"] == "object"


def test_schema_without_a_name_prints_all(capsys):
    assert main(["schema"]) == 0
    assert list(json.loads(capsys.readouterr().out)) == SCHEMAS


def test_new_refuses_a_folder_in_use(study, capsys):
    before = (study / "line.yaml").read_text()
    assert main(["new", str(study)]) == 2
    assert "not empty" in capsys.readouterr().err
    assert (study / "line.yaml").read_text() == before


def test_errors_and_warnings_are_counted():
    error, warning = Problem("a", "", "x"), Problem("b", "", "y", severity="warning")
    assert summary([error, warning, warning]) == "1 error, 2 warnings"
    assert has_errors([warning, error])
    assert not has_errors([warning])


def test_an_input_error_from_any_command_is_told_and_1(capsys):
    assert exit_code_of(InputError([Problem("gap", "line.gradients", "a gap", place="line.yaml:4")])) == 1
    assert "line.yaml:4: line.gradients: a gap" in capsys.readouterr().err


def test_check_looks_at_the_scenario_as_a_whole_and_names_the_line(study, capsys):
    file = study / "supply.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace('track: "1", km: 4.0', 'track: "1", km: 400.0'), encoding="utf-8")
    line = file.read_text(encoding="utf-8").splitlines().index('  - {id: depot, track: "1", km: 400.0, power_kw: 400.0}') + 1
    assert main(["check", str(study)]) == 1
    assert f"supply.yaml:{line}: supply.loads[depot]" in capsys.readouterr().err

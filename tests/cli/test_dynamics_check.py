"""``tractionpower dynamics check``: every problem of a case at once, by place, key or option; the commands of our READMEs."""

import json
import re
import shlex
from pathlib import Path

import pytest
from arshad_files import INI, write_arshad

from tractionpower.cli import main
from tractionpower.cli.case_call import call_case, find_problems
from tractionpower.cli.look import Look
from tractionpower.io.dynamics_files import shipped_cases

CASES = Path(__file__).parents[2] / "rollingstock" / "dynamics"
CASE = """
format: 1
name: Contradictions
vehicles:
  - {id: v43}
  - {id: wagon-zobory, count: 2}
coupling: zobory-linear
brake: {brake_ratio: 0.5}
track:
  gradients: [{from_m: 300, to_m: 100, permille: 5}]
commands:
  - {time_s: 9, drive: 4}
  - {time_s: 3, brake: 99}
run: {duration_s: 12, step_s: 0.2, record_every_s: 0.1}
"""


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(text, name="case"):
    Path(name).mkdir()
    (Path(name) / "case.yaml").write_text(text, encoding="utf-8")
    return name


def errors_of(told):
    """Return place and path of each error that was told."""
    return set(re.findall(r"^  error: (\S+?:\d+|--\S+): (\S+):", told, re.MULTILINE))


def test_every_problem_is_told_at_once_and_nothing_is_computed(tmp_path, capsys):
    assert main(["dynamics", "check", write(CASE)]) == 1
    told = capsys.readouterr()
    assert errors_of(told.err) == {
        ("case.yaml:10", "case.track.gradients[0].to_m"),
        ("case.yaml:13", "case.commands[1].time_s"),
        ("case.yaml:13", "case.commands[1].brake"),
        ("case.yaml:14", "case.run.step_s"),
    }
    assert told.err.count("case.run.step_s: found 0.2 s") == 2  # longer than the rows, and than what is stable
    assert "with method symplectic" in told.err
    assert told.out.startswith("5 errors")
    assert [path.name for path in tmp_path.iterdir()] == ["case"]


def test_as_json_each_problem_has_its_parts(capsys):
    assert main(["dynamics", "check", write(CASE), "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert (told["format"], told["case"]) == (1, "case")
    problems = {problem["path"]: problem for problem in told["problems"]}
    problem = problems["case.track.gradients[0].to_m"]
    assert (problem["code"], problem["severity"], problem["place"]) == ("reversed", "error", "case.yaml:10")
    assert set(problem) == {"code", "path", "found", "allowed", "remedy", "severity", "place"}


@pytest.mark.parametrize("name", shipped_cases())
def test_cases_that_ship_have_no_errors(name, capsys):
    assert main(["dynamics", "check", name]) == 0
    assert re.fullmatch(r"no problems|1 warning", capsys.readouterr().out.strip())


def test_a_case_that_is_not_there(capsys):
    assert main(["dynamics", "check", "arshda"]) == 2
    assert "did you mean arshad?" in capsys.readouterr().err


def test_an_empty_case_gets_one_to_start_from_that_runs(capsys):
    assert main(["dynamics", "check", write("")]) == 1
    told = capsys.readouterr().err
    assert "tractionpower new" not in told
    assert "docs/dynamics.md" in told
    assert told.count("the file is empty") == 1
    (least,) = re.findall(r"\{name: .*\}", told)
    assert main(["dynamics", "check", write(least, "least")]) == 0
    assert capsys.readouterr().out.strip() == "no problems"


# --- configurations of Arshad et al.


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_configuration_is_told_by_its_own_keys_all_at_once(command, tmp_path, capsys):
    text = INI.replace("Static fric coff = 0.4", "Static fric coff = 0.8\nStatik = 3")
    assert text != INI
    (tmp_path / "ini").mkdir()
    write_arshad(tmp_path / "ini", {"Simulation.ini": text})
    assert main(["dynamics", command, "ini"]) == 1
    told = capsys.readouterr().err
    assert "the key 'statik'" in told
    assert "Static fric coff: 0.8 is not below tan(35 deg)" in told
    assert "remedy: correct the friction or Wedge angle" in told
    assert "static_friction" not in told and "angle_deg" not in told and "wagon-connection" not in told


# --- what our own pages tell to type


@pytest.mark.parametrize("name", shipped_cases())
def test_the_commands_of_the_readmes_of_cases_are_sound(name):
    text = (CASES / name / "README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^ {4}tractionpower dynamics (\w+) (.*)$", text, re.MULTILINE)
    assert commands
    for command, rest in commands:
        assert command in {"run", "drive", "check"}
        case, *options = shlex.split(rest)
        assert set(options[::2]) <= {"--set", "--out"}
        changes = [value for option, value in zip(options[::2], options[1::2], strict=True) if option == "--set"]
        assert case == name
        call = call_case(case, changes, None, Look())
        assert [problem for problem in find_problems(call.loaded) if problem.severity == "error"] == []


def test_the_examples_of_the_help_are_sound(capsys):
    assert main(["dynamics", "run", "--help"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    examples = re.findall(r"[\w.\[\]]+=\d+", told)
    assert len(examples) == 2
    assert find_problems(call_case("zobory-hill", examples, None, Look()).loaded) == []

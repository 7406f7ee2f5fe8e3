"""What is wrong with controls is told: place, what stands there, what may stand there."""

import pytest
from small_controls import GEAR, locomotive, scenario, vehicle

from tractionpower.dynamics.control_checks import check_controls

AIR = "case.air_brake"


def told(given):
    return {problem.path: problem for problem in check_controls(given)}


def test_a_sound_case():
    sound = scenario(
        {"time_s": 0.0, "drive": 15, "brake": "charge"},
        {"time_s": 5.0, "drive": 0, "brake": 15},
        {"time_s": 9.0, "reduction_bar": 5.0, "independent_bar": 3.0},
        {"time_s": 12.0, "brake": "emergency", "electric": 8},
        electric_brake={"effort_kn": 100.0, "power_kw": 900.0},
    )
    assert check_controls(sound) == []


@pytest.mark.parametrize(
    ("air", "path", "code", "words"),
    [
        ({"full_service_reduction_bar": 6.0, "gain": 0.6}, "full_service_reduction_bar", "reduction", ["6 bar", "5 bar"]),
        ({"first_reduction_bar": 1.6}, "first_reduction_bar", "first_reduction", ["1.6 bar", "1.5 bar"]),
        ({"levels": 3, "reductions_bar": (0.5, 1.5)}, "reductions_bar", "levels", ["2 reductions"]),
        ({"levels": 3, "reductions_bar": (0.5, 0.5, 1.5)}, "reductions_bar[1]", "unsorted", ["0.5 bar at level 2"]),
        ({"levels": 2, "reductions_bar": (-0.5, 1.5)}, "reductions_bar[0]", "unsorted", ["-0.5"]),
        ({"levels": 2, "reductions_bar": (0.5, 7.5)}, "reductions_bar[1]", "reduction", ["7.5 bar", "5 bar"]),
        ({"levels": 2, "reductions_bar": (0.5, 1.5), "first_reduction_bar": 0.5}, "first_reduction_bar", "contradiction", []),
    ],
)
def test_a_pipe_that_cannot_be(air, path, code, words):
    problems = [problem for problem in check_controls(scenario(air_brake=air)) if problem.severity == "error"]
    assert [(problem.path, problem.code) for problem in problems] == [(f"{AIR}.{path}", code)]
    assert all(word in problems[0].found for word in words)
    assert problems[0].remedy


@pytest.mark.parametrize(
    ("air", "path", "words"),
    [
        ({"gain": 1.0}, "gain", ["1.5 bar", "3.8 bar", "never reached"]),
        ({"gain": 4.0}, "gain", ["6 bar", "no more"]),
        ({"cylinder_emergency_bar": 3.0}, "cylinder_emergency_bar", ["3 bar", "3.8 bar"]),
        ({"levels": 2, "reductions_bar": (0.5, 1.0)}, "reductions_bar[1]", ["1 bar", "1.5 bar"]),
    ],
)
def test_a_doubtful_pipe(air, path, words):
    (problem,) = check_controls(scenario(air_brake=air))
    assert (problem.path, problem.severity) == (f"{AIR}.{path}", "warning")
    assert all(word in problem.found for word in words)


def test_all_wrong_commands_are_told_at_once():
    found = told(
        scenario(
            {"time_s": 0.0, "drive": 16},
            {"time_s": 1.0, "brake": 16},
            {"time_s": 2.0, "reduction_bar": 5.01},
            {"time_s": 3.0, "electric": 9.0},
            electric_brake={"effort_kn": 100.0, "power_kw": 900.0},
        )
    )
    paths = ["commands[0].drive", "commands[1].brake", "commands[2].reduction_bar", "commands[3].electric"]
    assert [path.removeprefix("case.") for path in found] == paths
    assert [problem.allowed for problem in found.values()] == ["0 to 15", "0 to 15", "up to 5", "0 to 8"]


def test_power_in_emergency_is_told_once():
    commands = [{"time_s": 0.0, "drive": 6}, {"time_s": 4.0, "brake": "emergency"}, {"time_s": 5.0, "drive": 3}]
    (problem,) = check_controls(scenario(*commands, {"time_s": 6.0, "brake": "unchanged"}))
    assert (problem.path, problem.severity) == ("case.commands[1]", "warning")
    assert "level 6" in problem.found
    assert check_controls(scenario(*commands[:1], {"time_s": 4.0, "drive": 0, "brake": "emergency"})) == []


def test_commands_that_nothing_obeys():
    wagons = scenario(
        {"time_s": 0.0, "drive": 0, "brake": "release"},
        {"time_s": 1.0, "drive": 3, "brake": 3, "electric": 1.0, "independent_bar": 1.0},
        {"time_s": 2.0, "drive": 4},
        vehicles=[{"id": "wagon", "count": 3}],
        brake=GEAR | {"in_use": False},
    )
    found = told(wagons)
    names = ["drive", "brake", "electric", "independent_bar"]
    assert list(found) == [f"case.commands[1].{name}" for name in names]
    assert {problem.severity for problem in found.values()} == {"warning"}
    own = vehicle("loco", "locomotive", drive=locomotive().drive, brake={"electric_effort_kn": 90.0, "electric_power_kw": 900.0})
    assert check_controls(scenario({"time_s": 1.0, "electric": 1.0}, loco=own)) == []

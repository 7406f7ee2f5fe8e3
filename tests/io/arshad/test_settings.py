"""The configuration: keys as printed, in any spelling and section, and everything that is wrong with it at once."""

import pytest
from arshad_files import INI

from tractionpower.io.arshad.keys import KEYS, PRINTED
from tractionpower.io.arshad.settings import Settings, read_settings, spelling_of
from tractionpower.io.documents import Reader
from tractionpower.io.text_files import Source

PRINTED_KEYS = (  # Table 3, then section 7.2
    "Memory Allocation", "Simulation Time", "Step Size", "Distance Limit", "Gross Braking Ratio", "Mu", "Brake Ragging",
    "Wind Resistance Drag Coefficient", "Rolling Friction Coefficient", "Train Consist Path", "Track Profile Path",
    "Dynamic Parameters Path", "State vector size", "Simulation time", "Step size", "Coupler hard limit",
    "First stage loading", "Second stage loading", "Locked stiffness", "Relaxing stiffness", "Slack region width",
    "Kinetic fric coff", "Static fric coff", "Wedge angle", "Cut of cars",
)  # fmt: skip


@pytest.fixture
def read(tmp_path):
    def tell(text):
        file = tmp_path / "Simulation.ini"
        file.write_text(text, encoding="utf-8")
        reader = Reader(tmp_path)
        return read_settings(reader, Source(file, file.name, "")), reader.problems

    return tell


def settings_of(read, text) -> Settings:
    settings, problems = read(text)
    assert problems == []
    return settings


def test_section_7_2_as_printed(read):
    settings = settings_of(read, INI)
    expected = {
        "rows": 20000.0, "duration": 150.0, "step": 0.005, "hard_limit": 0.4, "first_stage": 6.0, "second_stage": 17.0,
        "locked": 600.0, "relaxing": 0.6, "slack": 0.1, "kinetic": 0.2, "static": 0.4, "wedge": 35.0, "cars": 5.0,
    }  # fmt: skip
    assert {name: settings.number(name) for name in expected} == pytest.approx(expected)
    assert settings.lines == {name: k + 1 for k, name in enumerate(expected)}


def test_every_printed_key_is_known():
    known = {spelling.lower() for key in PRINTED for spelling in key.spellings}
    assert {name.lower() for name in PRINTED_KEYS} == {name for name in known if name in map(str.lower, PRINTED_KEYS)}
    assert all(key.printed for key in PRINTED)


def test_spellings_sections_and_comments_do_not_matter(read):
    text = INI.replace("Kinetic fric coff", "KINETIC  friction Coefficient")
    text = f"; by hand\n[Simulation]\n{text}\n[Brakes]\nBrake Ragging = 80 %   # of the rigging\nMu=0.25\nMethod = RK4\n"
    settings = settings_of(read, text)
    assert settings.number("kinetic") == 0.2
    assert settings.number("rigging") == pytest.approx(0.8)
    assert settings.number("mu") == 0.25
    assert settings.text("method") == "rk4"
    assert settings.mark("mu").place == "Simulation.ini:19"


def test_what_is_left_out_is_assumed_and_said(read):
    settings = settings_of(read, "Simulation time = 10\nStep size = 0.005\n")
    assert settings.number("first_stage") == 10.0  # eq. 8
    assert settings.number("second_stage") == 25.0  # eq. 9
    assert settings.text("track") == "TrackProfile.csv"
    assert settings.optional("rows") is None
    told = "; ".join(settings.assumed())
    for part in ("First stage loading 10 kN/mm (Arshad et al., eq. 8)", "Friction blending speed 0.1 m/s (assumed"):
        assert part in told
    assert "Simulation time" not in told
    assert not settings.is_given("mu")


def test_everything_wrong_is_told_at_once(read):
    text = INI.replace("0.005sec", "0.005 hours").replace("Wedge angle = 35.0 degree", "Wedge angel = 35.0 degree")
    text += "Mu = 2\nCut of cars = 6\nMethod = heun\nDistance limit = 5000\nBrake Rigging = 0\n"
    settings, problems = read(text)
    assert settings.number("wedge") == 35.0  # the default, so that reading can go on
    told = {problem.place: (problem.code, problem.found, problem.allowed, problem.remedy) for problem in problems}
    assert told["Simulation.ini:3"][0:2] == ("bad_value", "the unit in '0.005 hours'")
    assert told["Simulation.ini:12"] == (
        "unknown_key",
        "the key 'wedge angel'",
        told["Simulation.ini:12"][2],
        "did you mean Wedge angle?",
    )
    assert told["Simulation.ini:14"][1:3] == ("'2'", "at least 0, at most 1")
    assert told["Simulation.ini:15"][:2] == ("duplicate_key", "the key Cut of cars a second time, first in line 13")
    assert told["Simulation.ini:16"][2] == "symplectic, rk4, euler, variable"
    assert "without a unit" in told["Simulation.ini:17"][1]
    assert "ft" in told["Simulation.ini:17"][2]
    assert told["Simulation.ini:18"][2] == "above 0, at most 1"
    assert len(problems) == 7


@pytest.mark.parametrize(
    ("text", "code"),
    [("", "empty_file"), ("# nothing\n[a]\n", "empty_file"), ("Step size 0.005\n= 3\n", "syntax_error")],
)
def test_what_is_no_configuration(read, text, code):
    settings, problems = read(text)
    assert settings is None
    assert {problem.code for problem in problems} == {code}
    assert len(problems) == (2 if code == "syntax_error" else 1)


def test_what_must_be_there(read):
    _, problems = read("Mu = 0.3\n")
    assert [problem.found for problem in problems] == ["no key Simulation time", "no key Step size"]


def test_names_and_spellings_are_unique():
    spellings = [spelling.lower() for key in KEYS for spelling in key.spellings]
    assert len(set(spellings)) == len(spellings)
    assert len({key.name for key in KEYS}) == len(KEYS)
    assert spelling_of("rows") == "State vector size"

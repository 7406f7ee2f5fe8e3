"""The track profile of Table 6: feet, per cent and degrees, overlaps of kinds, gaps of a foot, longer gaps."""

import math

import pytest
from arshad_files import TABLE_6

from tractionpower.io.arshad.track import radius_of, read_track, track_data
from tractionpower.io.documents import Reader
from tractionpower.io.text_files import Source

FT = 0.3048
HEAD = "Start Point (feet),End Point (feet),Track Element,Value\n"


@pytest.fixture
def read(tmp_path):
    def tell(text):
        file = tmp_path / "TrackProfile.csv"
        file.write_text(text, encoding="utf-8")
        reader = Reader(tmp_path)
        return read_track(reader, Source(file, file.name, "")), reader.problems

    return tell


def slope_at(data, place_m):
    return sum(row["permille"] for row in data["gradients"] if row["from_m"] <= place_m < row["to_m"])


def test_table_6(read):
    profile, problems = read(TABLE_6)
    assert problems == []
    assert profile.feet
    data, mark = track_data(profile, 0.0, 50.0, 0.4)
    # The foot between 3000 and 3001 and the one before 1 are closed; from 3999 to 4600 it is level.
    expected = {-10.0: 10.0, 0.5: 10.0, 3000.5: 10.0, 3998.0: 10.0, 4000.0: 0.0, 4599.0: 0.0, 4650.0: 40.0, 4701.0: 0.0}
    assert {place: slope_at(data, place * FT) for place in expected} == pytest.approx(expected)
    assert [row["radius_m"] for row in data["curves"]] == pytest.approx([1746.4, 873.2], abs=0.05)
    assert [row["from_m"] for row in data["curves"]] == pytest.approx([457.2, 1219.2])
    assert [row["to_m"] for row in data["curves"]] == pytest.approx([762.0, 1371.6])
    assert data["rounding_radius_m"] == 0.0
    assert mark.find(("gradients", 2)).place == "TrackProfile.csv:6"
    assert mark.find(("curves", 1)).place == "TrackProfile.csv:5"


def test_places_count_from_the_front_at_the_start(read):
    profile, _ = read(TABLE_6)
    data, _ = track_data(profile, 100.0, 100.0, 0.4)
    assert data["curves"][0]["from_m"] == pytest.approx(457.2 - 100.0)
    assert slope_at(data, -99.0) == 10.0  # the tail stands on the first grade


def test_a_profile_that_begins_later_is_level_before(read):
    profile, _ = read(f"{HEAD}500,900,Grade,-1.5 %\n")
    data, _ = track_data(profile, 0.0, 50.0, 0.4)
    assert slope_at(data, 499 * FT) == 0.0
    assert slope_at(data, 501 * FT) == -15.0


@pytest.mark.parametrize(("degrees", "radius_m"), [(1.0, 1746.4), (5.0, 349.4), (16.0, 109.5)])
def test_the_degree_of_a_curve_is_by_a_chord_of_100_feet(degrees, radius_m):
    assert radius_of(degrees) == pytest.approx(radius_m, abs=0.05)
    assert 2.0 * math.asin(50.0 * FT / radius_of(degrees)) == pytest.approx(math.radians(degrees))


def test_one_degree_has_the_curve_resistance_of_the_configuration(read):
    profile, _ = read(TABLE_6)
    data, _ = track_data(profile, 0.0, 50.0, 0.4)
    a = data["curve_resistance"]["a_n_m_per_kn"]
    assert a == pytest.approx(698.5, abs=0.1)
    assert a / data["curves"][0]["radius_m"] == pytest.approx(0.4)
    assert a / data["curves"][1]["radius_m"] == pytest.approx(0.8, rel=1e-3)


def test_metres_and_spellings(read):
    profile, problems = read("Start (m),End (m),Element,Value\n0,100,Gradient,5 permille\n20,80,Curvature,-3\n")
    assert problems == []
    assert not profile.feet
    data, _ = track_data(profile, 0.0, 10.0, 0.4)
    assert slope_at(data, 50.0) == 5.0
    assert data["curves"][0]["turns"] == "left"


def test_a_tangent_written_as_a_curve_of_no_degrees(read):
    profile, problems = read(f"{HEAD}0,100,Curve,0 Deg\n100,200,Curve,1 Deg\n")
    assert problems == []
    data, mark = track_data(profile, 0.0, 10.0, 0.4)
    assert len(data["curves"]) == 1
    assert mark.find(("curves", 0)).place == "TrackProfile.csv:3"


def test_rows_of_one_kind_may_repeat_but_not_contradict(read):
    profile, problems = read(f"{HEAD}0,100,Grade,1 %\n50,150,Grade,1 %\n60,70,Grade,1%\n150,160,Grade,2 %\n")
    assert problems == []
    assert [row.from_m / FT for row in profile.grades] == pytest.approx([0.0, 100.0, 150.0])
    assert [row.to_m / FT for row in profile.grades] == pytest.approx([100.0, 150.0, 160.0])
    profile, problems = read(f"{HEAD}0,100,Grade,1 %\n50,150,Grade,2 %\n50,150,Curve,2 Deg\n")
    assert profile is None
    assert [(problem.code, problem.place) for problem in problems] == [("overlap", "TrackProfile.csv:3")]
    assert "overlaps line 2 with another value" in problems[0].found


def test_everything_wrong_is_told_at_once(read):
    rows = (
        "100,50,Grade,1 %\n0,10,Grad,1 %\n10,20,Curve,1 %\n20,30,Grade,1 Deg\n30,40,Grade,steep\n40,50,Grade,90 %\n50,,Grade,1%\n"
    )
    profile, problems = read(HEAD + rows)
    assert profile is None
    assert [(problem.place.rpartition(":")[2], problem.code) for problem in problems] == [
        ("2", "reversed"), ("3", "unknown_word"), ("4", "bad_value"), ("5", "bad_value"), ("6", "bad_value"),
        ("7", "out_of_bounds"), ("8", "missing_value"),
    ]  # fmt: skip
    assert problems[1].remedy == "did you mean Grade?"
    assert problems[2].allowed == "degrees, such as 2 Deg"


def test_the_header_must_say_feet_or_metres(read):
    _, problems = read("Start Point,End Point (feet),Track Element,Value\n0,1,Grade,1 %\n")
    assert [problem.code for problem in problems] == ["bad_unit"]
    assert problems[0].found == "the column 'Start Point' with no unit"
    assert "feet" in problems[0].allowed

"""Commands by time as in Tables 4 and 7, and words and numbers that no driver says."""

import pytest
from arshad_files import TABLE_4, TABLE_7

from tractionpower.io.arshad.commands import read_commands
from tractionpower.io.documents import Reader
from tractionpower.io.text_files import Source

PSI = 0.06894757293168
HEAD = "Time,Notch,Brake Pipe Pressure,Dynamic Brake\n"


@pytest.fixture
def read(tmp_path):
    def tell(text, notches=8):
        file = tmp_path / "DynamicParameter.csv"
        file.write_text(text, encoding="utf-8")
        reader = Reader(tmp_path)
        commands, mark = read_commands(reader, Source(file, file.name, ""), notches)
        return commands, mark, reader.problems

    return tell


def test_table_7(read):
    commands, mark, problems = read(TABLE_7)
    assert problems == []
    assert [command["time_s"] for command in commands] == [0.0, 30.0, 60.0, 80.0, 100.0]
    assert [command["drive"] for command in commands] == [1, 2, 3, 3, 0]
    assert [command.get("brake") for command in commands] == ["charge", "charge", "charge", None, None]
    assert [command.get("reduction_bar") for command in commands[3:]] == pytest.approx([7 * PSI, 15 * PSI])
    assert {command["electric"] for command in commands} == {0.0}
    assert mark.find((4,)).place == "DynamicParameter.csv:6"


def test_table_4_with_its_words_and_a_dynamic_brake_in_per_cent(read):
    commands, _, problems = read(TABLE_4)
    assert problems == []
    words = [command.get("brake", command.get("reduction_bar")) for command in commands]
    assert words.pop(0) == pytest.approx(10 * PSI)
    assert words == ["charge", "unchanged", "full_service", "charge", "emergency"]
    assert [command["electric"] for command in commands] == pytest.approx([1.2, 2.0, 1.6, 1.44, 2.0, 0.8])


def test_units_and_spellings_of_headers(read):
    text = (
        "Time (min),Throttle Notch,Brake Pipe Pressure (kPa),Dynamic Brake Notch,Independent Brake (psi)\n1,31,50,4,30\n2,,,,\n"
    )
    commands, _, problems = read(text, notches=31)
    assert problems == []
    expected = {"time_s": 60.0, "drive": 31, "reduction_bar": 0.5, "electric": 4.0, "independent_bar": 30 * PSI}
    assert commands[0] == pytest.approx(expected)
    assert commands[1] == {"time_s": 120.0}  # an empty cell changes nothing


@pytest.mark.parametrize("text", ["Release", "release", "RELEASE"])
def test_a_release(read, text):
    commands, _, _ = read(f"{HEAD}0,1,{text},0\n")
    assert commands[0]["brake"] == "release"


def test_everything_wrong_is_told_at_once(read):
    rows = "0,9,Charge,0\n1,1,Emergancy,0\n2,1,-7,0\n3,1.5,7,101\n-4,1,Uc,0\n,1,Uc,-1\n"
    commands, _, problems = read(HEAD + rows)
    assert len(commands) == 6
    told = [(problem.place.rpartition(":")[2], problem.code) for problem in problems]
    assert told == [
        ("2", "out_of_bounds"), ("3", "unknown_word"), ("4", "out_of_bounds"), ("5", "bad_value"), ("5", "out_of_bounds"),
        ("6", "out_of_bounds"), ("7", "missing_value"), ("7", "out_of_bounds"),
    ]  # fmt: skip
    by_line = dict(zip(told, problems, strict=True))
    assert by_line["2", "out_of_bounds"].allowed == "0 to 8"
    assert "Notches" in by_line["2", "out_of_bounds"].remedy
    word = by_line["3", "unknown_word"]
    assert word.found == "'Emergancy' in column 'Brake Pipe Pressure'"
    assert "Full Service" in word.allowed
    assert word.remedy == "did you mean Emergency?"
    assert by_line["5", "out_of_bounds"].allowed == "0 to 100 %"


def test_a_notch_of_the_dynamic_brake_is_none_of_per_cent(read):
    _, _, problems = read(TABLE_7.replace("30,2,Charge,0", "30,2,Charge,15"))
    assert [(problem.allowed, problem.remedy) for problem in problems] == [
        ("0 to 8", "for per cent head the column Dynamic Brake (%)")
    ]
    _, _, problems = read("Time,Notch,Brake Pipe Pressure,Dynamic Brake (%),Dynamic Brake Notch\n0,1,Charge,0,0\n")
    assert [problem.code for problem in problems] == ["contradiction"]


@pytest.mark.parametrize(
    ("text", "code", "found"),
    [
        ("Time,Noch,Brake Pipe Pressure\n0,1,Charge\n", "unknown_column", "the column 'Noch'"),
        ("Time,Brake Pipe Pressure\n0,Charge\n", "missing_column", "no column Notch"),
        ("Time,Notch,Throttle Noch,Brake Pipe Pressure\n0,1,1,Charge\n", "duplicate_column", "the column Notch twice"),
        ("Time (h),Notch,Brake Pipe Pressure\n0,1,Charge\n", "bad_unit", "the column 'Time (h)' with the unit 'h'"),
        ("Time,Notch,Brake Pipe Pressure\n", "empty_file", "no row below the header"),
        ("Time,Notch,Brake Pipe Pressure\n0,1\n", "ragged_row", "2 cells in the row"),
    ],
)
def test_bad_headers_and_rows(read, text, code, found):
    _, _, problems = read(text)
    assert (problems[0].code, problems[0].found) == (code, found)

from pathlib import Path

import pytest

from tractionpower.errors import InputError
from tractionpower.io.csv_files import csv_text, read_csv
from tractionpower.io.shapes import shape_of
from tractionpower.io.text_files import Source
from tractionpower.model.line import Connection, Gradient, Station
from tractionpower.model.timetable import Call, TrainRun

HEADER = "from_km,to_km,permille,tracks\n"


def source(tmp_path: Path, text: str | bytes) -> Source:
    file = tmp_path / "gradients.csv"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return Source(file, "gradients.csv", "line.gradients", "line.yaml:7")


def failures(given: Source):
    with pytest.raises(InputError) as caught:
        read_csv(given, shape_of(Gradient))
    return caught.value.problems


@pytest.mark.parametrize(
    "text",
    [
        HEADER + "0,1.5,-3,1 2\n1.5,2,4,\n",
        "\ufeff" + HEADER + " 0 , 1.5 ,-3, 1 2\r\n\r\n,,,\r\n1.5,2,4,\r\n",
        "from_km;to_km;permille;tracks\n0;1,5;-3;1 2\n1,5;2;4;\n",
        'from_km,to_km,permille,tracks\n"0",1.5,-3,"1 2"\n1.5,2,4e0,""\n',
    ],
)
def test_commas_semicolons_blanks_and_marks(tmp_path, text):
    table = read_csv(source(tmp_path, text), shape_of(Gradient))
    assert table.rows == [
        {"from_km": 0.0, "to_km": 1.5, "permille": -3.0, "tracks": "1 2"},
        {"from_km": 1.5, "to_km": 2.0, "permille": 4.0},
    ]
    assert Gradient.model_validate(table.rows[0]).tracks == ("1", "2")


def test_lines_count_blank_and_quoted_lines(tmp_path):
    given = source(tmp_path, 'id,name,km\n\nA,"two\nlines",1\nB,b,2\n')
    table = read_csv(given, shape_of(Station))
    assert [table.mark.find((name,)).place for name in "AB"] == ["gradients.csv:3", "gradients.csv:5"]


def test_dotted_headers_make_nested_rows(tmp_path):
    table = read_csv(source(tmp_path, "from.track,from.km,to.track,to.km\n1,2,3,4\n"), shape_of(Connection))
    assert table.rows == [{"from": {"track": "1", "km": 2.0}, "to": {"track": "3", "km": 4.0}}]


def test_true_and_false(tmp_path):
    table = read_csv(source(tmp_path, "station,stops\nA,true\nB,FALSE\nC,no\n"), shape_of(Call))
    assert [row["stops"] for row in table.rows] == [True, False, "no"]


def test_a_list_of_rows_in_a_cell_is_the_name_of_a_file(tmp_path):
    table = read_csv(source(tmp_path, "id,route,calls\n1,r.csv,c.csv\n"), shape_of(TrainRun))
    assert table.rows == [{"id": "1", "route": "r.csv", "calls": "c.csv"}]


def test_identifiers_stay_text_and_no_formula_is_read(tmp_path):
    table = read_csv(source(tmp_path, "id,name,km\n007,=1+1,=A1\n"), shape_of(Station))
    assert table.rows == [{"id": "007", "name": "=1+1", "km": "=A1"}]


@pytest.mark.parametrize(
    ("text", "code", "place", "found"),
    [
        ("", "empty_file", "gradients.csv", "empty"),
        ("\n\n", "empty_file", "gradients.csv", "empty"),
        (b"from_km,to_km\n\xff,1\n", "not_utf8", "gradients.csv:2", "0xff"),
        ("from_km,to_km,permille,km\n", "unknown_column", "gradients.csv:1", "'km'"),
        ("from_km,to_km,permile,permille\n", "unknown_column", "gradients.csv:1", "'permile'"),
        ("from_km,to_km,permille,from_km\n", "duplicate_column", "gradients.csv:1", "'from_km'"),
        ("from_km,to_km\n", "missing_column", "gradients.csv:1", "permille"),
        (HEADER + '0,1,2,"open\n', "csv_syntax", "gradients.csv:2", "unexpected end"),
    ],
)
def test_tables_that_cannot_be_read(tmp_path, text, code, place, found):
    (problem,) = failures(source(tmp_path, text))
    assert (problem.code, problem.place, problem.path) == (code, place, "line.gradients")
    assert found in problem.found


def test_an_unknown_header_names_the_nearest(tmp_path):
    (problem,) = failures(source(tmp_path, "from_km,to_km,permille,trakcs\n"))
    assert problem.remedy == "did you mean tracks?"


def test_ragged_rows_are_told_with_their_line(tmp_path):
    table = read_csv(source(tmp_path, HEADER + "0,1,2,\n1,2\n2,3,4,,5\n"), shape_of(Gradient))
    assert [(problem.code, problem.place, problem.found) for problem in table.problems] == [
        ("ragged_row", "gradients.csv:3", "2 cells in the row"),
        ("ragged_row", "gradients.csv:4", "5 cells in the row"),
    ]


def test_a_file_of_200_mb_is_refused_with_its_size(tmp_path):
    given = source(tmp_path, "")
    with given.file.open("wb") as stream:
        stream.truncate(200_000_000)  # sparse: takes no room
    (problem,) = failures(given)
    assert (problem.code, problem.found, problem.allowed) == ("file_too_large", "the file has 200.0 MB", "at most 50 MB")


def test_written_rows_are_read_again(tmp_path):
    text = csv_text(["id", "name", "km"], [["A", 'a "b", c\nd', 1.5], ["B", None, 2]])
    table = read_csv(source(tmp_path, text), shape_of(Station))
    assert table.rows == [{"id": "A", "name": 'a "b", c\nd', "km": 1.5}, {"id": "B", "km": 2.0}]

"""Stops off the shape, without a place, and the table that puts them where they are."""

import pytest
from small_feeds import KM, codes, plain, read, stop, tables

OFF = [stop("A", 0), stop("B", 1, 0.02), stop("C", 2), stop("D", 3)]


def kms(found):
    return {row["id"]: row["km"] for row in plain(found, "line.yaml")["stations"]}


def table(folder, text):
    folder.mkdir(exist_ok=True)
    file = folder / "stops.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_stop_off_the_shape(tmp_path):
    found = read(tmp_path, stops=OFF)
    (problem,) = found.notes.problems
    assert problem.code == "stop_off_shape"
    assert "stop B (Stop B) lies 2225 m from shape" in problem.found  # 0.02 degrees of 111.229 km
    assert "table of stops" in problem.remedy
    assert found.texts == {}
    mended = read(tmp_path, {"repair": True}, stops=OFF)
    assert kms(mended)["B"] == pytest.approx(KM, abs=2e-3)
    assert any("nearest place" in row for row in mended.notes.repaired)
    assert read(tmp_path, {"stop_tolerance_m": 2500.0}, stops=OFF).texts


def test_the_table_puts_it_right(tmp_path):
    file = table(tmp_path, "stop_id,km\nB,1.25\n")
    found = read(tmp_path, {"stops": file}, stops=OFF)
    assert codes(found) == []
    assert kms(found) == {"A": 0.0, "B": 1.25, "C": pytest.approx(2 * KM, abs=1e-3), "D": pytest.approx(3 * KM, abs=1e-3)}


def test_a_table_of_all_stops_sets_the_kilometres(tmp_path):
    file = table(tmp_path, "stop_id;km;track\nA;10,5;1\nB;12;1\nC;13,5;\nD;15;\n")
    found = read(tmp_path, {"stops": file})
    assert kms(found) == {"A": 10.5, "B": 12.0, "C": 13.5, "D": 15.0}
    tracks = plain(found, "line.yaml")["tracks"]
    assert {(row["from_km"], row["to_km"]) for row in tracks} == {(10.5, 15.0)}


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("stop,km\nB,1\n", "missing_column"),
        ("stop_id,km\nQ,1\n", "unknown_stop"),
        ("stop_id,km\nB,one\n", "bad_place"),
        ("stop_id,km,track\nB,1,9\n", "bad_place"),
        ("stop_id,km\nB,1\nB,2\n", "doubled_stop"),
        ("", "unreadable_file"),
    ],
)
def test_bad_tables(tmp_path, text, code):
    assert codes(read(tmp_path, {"stops": table(tmp_path, text)})) == [code]


def test_no_table(tmp_path):
    assert codes(read(tmp_path, {"stops": tmp_path / "none.csv"})) == ["unreadable_file"]


def test_a_table_that_mixes_up_the_order(tmp_path):
    found = read(tmp_path, {"stops": table(tmp_path, "stop_id,km\nB,3.5\n")})
    assert codes(found) == ["order_of_stops"]


@pytest.mark.parametrize("lost", [{"stop_lat": "", "stop_lon": ""}, {"stop_lat": "0", "stop_lon": "0"}, {"stop_lat": "x"}])
def test_a_stop_without_a_place(tmp_path, lost):
    stops = [row | (lost if row["stop_id"] == "B" else {}) for row in tables()["stops"]]
    assert codes(read(tmp_path, stops=stops)) == ["stop_without_place"]
    mended = read(tmp_path, {"repair": True}, stops=stops)
    assert kms(mended)["B"] == pytest.approx(KM, abs=2e-3)
    placed = read(tmp_path, {"stops": table(tmp_path, "stop_id,km\nB,1.3\n")}, stops=stops)
    assert kms(placed)["B"] == 1.3
    assert placed.notes.repaired == []


@pytest.mark.parametrize("options", [{"repair": True}, {"stop_tolerance_m": 20_000.0}])
def test_a_stop_off_the_shape_leaves_its_neighbours_where_they_are(tmp_path, options):
    # C lies far to the north, above D: the shape's nearest place to it is not between B and D
    stops = [stop("A", 0), stop("B", 1), stop("C", 4, 0.05), stop("D", 3)]
    found = read(tmp_path, stops=stops)
    (problem,) = found.notes.problems
    assert (problem.code, problem.place) == ("stop_off_shape", "stops.txt:4")
    assert "stop C (Stop C) lies" in problem.found
    assert "between B and D" in problem.found
    mended = read(tmp_path, options, stops=stops)
    sound = kms(read(tmp_path / "sound"))
    assert kms(mended) == {**sound, "C": pytest.approx(2 * KM, abs=2e-3)}  # halfway
    (told,) = [row for row in mended.notes.repaired + mended.notes.assumed if "stop C (Stop C)" in row]
    assert "halfway" in told


def test_several_stops_off_the_shape_lie_evenly_between_those_on_it(tmp_path):
    stops = [stop("A", 0), stop("B", 5, 0.05), stop("C", 5, 0.06), stop("D", 3)]
    found = read(tmp_path, stops=stops)
    assert [problem.place for problem in found.notes.problems] == ["stops.txt:3", "stops.txt:4"]
    assert kms(read(tmp_path, {"repair": True}, stops=stops)) == pytest.approx(kms(read(tmp_path / "sound")), abs=2e-3)


def test_a_tolerance_beyond_the_usual_tells_each_stop(tmp_path):
    found = read(tmp_path, {"stop_tolerance_m": 2500.0}, stops=OFF)
    (told,) = [row for row in found.notes.assumed if "stop B" in row]
    assert "lies 2225 m" in told
    assert "within the tolerance of 2500 m" in told


def test_the_row_of_the_table_that_mixes_up_the_order_is_named(tmp_path):
    file = table(tmp_path, "stop_id,km\nA,0\nB,3.5\nD,4.302\n")
    (problem,) = read(tmp_path, {"stops": file}, stops=OFF).notes.problems
    assert problem.place == "stops.csv:3"
    assert "stop B at km 3.5" in problem.found
    assert "A (km 0) and C (km 2.868)" in problem.found


def test_a_stop_off_the_shape_where_no_other_is_beyond_it(tmp_path):
    # the first stop of all trains: no neighbour before it, so its place is the nearest one
    stops = [stop("A", 0, 0.05), stop("B", 1), stop("C", 2), stop("D", 3)]
    (problem,) = read(tmp_path, stops=stops).notes.problems
    assert problem.place == "stops.txt:2"
    assert "beside B" in problem.found
    assert kms(read(tmp_path, {"repair": True}, stops=stops)) == pytest.approx(kms(read(tmp_path / "sound")), abs=2e-3)

"""What is wrong with the files of a feed is told, each thing once, without a traceback."""

import zipfile

import pytest
from small_feeds import codes, read, tables, text_of, trains, write_feed

from tractionpower.io.imports.gtfs.reading import read_gtfs


def zipped(folder, prefix=""):
    source = write_feed(folder / "feed")
    file = folder / "feed.zip"
    with zipfile.ZipFile(file, "w") as archive:
        for path in source.iterdir():
            archive.write(path, prefix + path.name)
    return file


@pytest.mark.parametrize("prefix", ["", "inner/"])
def test_a_zip_is_the_same_as_its_folder(tmp_path, prefix):
    found = read_gtfs(zipped(tmp_path, prefix))
    assert found.texts
    assert found.texts == read_gtfs(tmp_path / "feed").texts


def test_no_zip(tmp_path):
    (tmp_path / "feed.zip").write_text("no zip", encoding="utf-8")
    assert codes(read_gtfs(tmp_path / "feed.zip")) == ["bad_zip"]


def test_missing_files_are_told_together(tmp_path):
    found = read(tmp_path, stops=None, stop_times=None, trips=None)
    assert codes(found) == ["missing_file"] * 3
    assert [problem.found for problem in found.notes.problems] == [
        f"the feed has no {name}.txt" for name in ("trips", "stops", "stop_times")
    ]
    assert found.texts == {}


def test_missing_columns_are_told_together(tmp_path):
    given = tables()
    stops = [{key: cell for key, cell in row.items() if key not in ("stop_lat", "stop_lon")} for row in given["stops"]]
    trips = [{key: cell for key, cell in row.items() if key != "service_id"} for row in given["trips"]]
    found = read(tmp_path, stops=stops, trips=trips)
    assert [(problem.code, problem.place, problem.found) for problem in found.notes.problems] == [
        ("missing_column", "trips.txt", "no column service_id"),
        ("missing_column", "stops.txt", "no column stop_lat, stop_lon"),
    ]


def test_semicolons_are_told(tmp_path):
    found = read(tmp_path, trips=text_of(tables()["trips"]).replace(",", ";"))
    (problem,) = found.notes.problems
    assert problem.code == "missing_column"
    assert "commas" in problem.remedy


@pytest.mark.parametrize(("text", "code"), [("", "empty_file"), ('route_id,"service', "csv_syntax"), ("a\0b", "missing_column")])
def test_files_that_are_no_tables(tmp_path, text, code):
    assert codes(read(tmp_path, trips=text)) == [code]


def test_optional_columns_and_odd_headers(tmp_path):
    plain = read(tmp_path / "a")
    odd = text_of(tables()["stop_times"]).replace("trip_id,", " Trip_ID , ").replace("T1,", " T1 ,")
    assert read(tmp_path / "b", stop_times=odd).texts == plain.texts
    blank = text_of(tables()["stop_times"]).replace("\n", "\r\n\r\n")
    assert read(tmp_path / "c", stop_times=blank).texts == plain.texts


def test_only_one_column_of_times(tmp_path):
    rows = [{key: cell for key, cell in row.items() if key != "departure_time"} for row in tables()["stop_times"]]
    called = trains(read(tmp_path, stop_times=rows))["T1"]["calls"]
    assert [call.get("departure") for call in called] == ["06:00:00", "06:02:00", "06:04:00", None]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_byte_order_marks(tmp_path, encoding):
    stops = text_of(tables()["stops"]).replace("Stop B", "Śródmieście")
    found = read(tmp_path, stops=stops.encode(encoding))
    assert "Śródmieście" in found.texts["line.yaml"]


def test_not_utf8(tmp_path):
    stops = text_of(tables()["stops"]).replace("Stop B", "Münster").encode("cp1252")
    found = read(tmp_path, stops=stops)
    assert [(problem.code, problem.place) for problem in found.notes.problems] == [("not_utf8", "stops.txt")]
    mended = read_gtfs(tmp_path / "feed", repair=True)
    assert "Münster" in mended.texts["line.yaml"]
    assert any("Windows-1252" in row for row in mended.notes.repaired)

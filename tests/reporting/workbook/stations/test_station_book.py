"""The workbook of a case of stations: times of trains that are those of the events, sums, words in both languages."""

import pytest
from fake_books import make_kind
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.model.report import SHEETS, Report
from tractionpower.reporting.reports import write_reports
from tractionpower.reporting.texts import language, recorded
from tractionpower.reporting.workbook import write_workbook


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return make_kind("stations", tmp_path_factory.mktemp("stations"))


@pytest.fixture(scope="module")
def books(made, tmp_path_factory):
    folder = tmp_path_factory.mktemp("books")
    paths = {one: write_workbook(*made, folder / f"{one}.xlsx", Report(language=one)) for one in ("en", "pl")}
    return {one: load_workbook(path, data_only=True) for one, path in paths.items()}


def test_all_sheets_are_known_by_name(books):
    assert set(books["en"].sheetnames) <= set(SHEETS)
    assert {"Cover", "Trains", "Key figures", "Events", "Inputs case", "Inputs trains", "Inputs track", "Definitions"} <= set(
        books["en"].sheetnames
    )


def test_running_and_waiting_times_are_those_of_the_events(books, made):
    events = made[0].table("station_events").astype({"train": str, "kind": str})
    rows = {row["train"]: row for row in read_table(books["en"]["Trains"])}
    assert list(rows) == list(dict.fromkeys(events.sort_values("time_s", kind="stable")["train"]))
    for name, own in events.groupby("train"):
        at = own.set_index("kind")["time_s"]
        assert rows[name]["running time [s]"] == pytest.approx(at["left"] - at["entered"])
        assert rows[name]["waited [s]"] == pytest.approx(own["waited_s"].sum(), abs=1e-4)
        assert rows[name]["time in stations [s]"] == pytest.approx(at["departure"] - at["arrival"])
        assert rows[name]["mean speed [km/h]"] == pytest.approx(3.6 * 8000.0 / (at["left"] - at["entered"]))
    figures = {figure["name"]: figure["value"] for figure in made[0].key_figures}
    assert figures["waiting_time_s"] > 0.0
    assert sum(row["waited [s]"] for row in rows.values()) == pytest.approx(figures["waiting_time_s"], abs=1e-3)
    mean = sum(row["running time [s]"] for row in rows.values()) / len(rows)
    assert mean == pytest.approx(figures["mean_running_time_s"])
    assert f"mean {mean:.1f} s" in " ".join(texts(books["en"]["Cover"]))


def test_every_event_has_its_row(books, made):
    rows = read_table(books["en"]["Events"])
    assert len(rows) == made[0].row_count("station_events")
    assert {row["event"] for row in rows} >= {"entered the line", "arrival", "departure", "left the line"}


def test_polish_words_of_a_curve_are_those_of_a_direction(books):
    with language("pl"):
        words = texts(books["pl"][recorded("Inputs track")])
    assert "w lewo" in words
    assert "zjazd" not in words


def test_everything_recorded_has_polish_words(made):
    with language("pl"):
        for figure in made[0].key_figures:
            assert recorded(figure["definition"]) != figure["definition"], figure["name"]


def test_reports_of_a_case_of_stations_are_figures_and_a_workbook(made, tmp_path):
    paths = write_reports(*made, tmp_path, only=frozenset({"workbook"}))
    assert [path.name for path in paths] == ["report.xlsx"]
    assert paths[0].is_file()

"""What figures read of a run: tables that are there, key figures, trains on their routes."""

import pandas as pd
import pytest
from fake_runs import small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.results.results import Results


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def test_a_table_is_read_once_and_missing_or_empty_ones_are_none(data, monkeypatch):
    read = []
    table = Results.table
    monkeypatch.setattr(Results, "table", lambda self, name: read.append(name) or table(self, name))
    assert data.table("trains") is data.table("trains")
    assert data.table("feeders") is None
    assert read == ["trains"]
    empty = {"trains": small_run().results._source["trains"].slice(0, 0)}
    assert RunData(Results({}, [], empty), data.scenario).table("trains") is None


def test_rows_of_each_train_come_by_name_in_the_order_of_time(data):
    rows = dict(data.rows_of("trains", "train"))
    assert list(rows) == ["1", "2", "3/IC", "4"]
    assert sum(len(own) for own in rows.values()) == len(data.table("trains"))
    assert all(own["time_s"].is_monotonic_increasing for own in rows.values())
    assert list(data.rows_of("feeders", "substation")) == []


def test_the_title_says_when_not_every_step_has_a_row(data):
    assert data.title == "Four trains"
    seldom = data.scenario.model_copy(update={"output": data.scenario.output.model_copy(update={"every_s": 10.0})})
    assert RunData(data.results, seldom).title == "Four trains (rows every 10 s)"
    nameless = data.scenario.model_copy(update={"name": ""})
    assert RunData(Results({"study": "four"}, [], {}), nameless).title == "four"


def test_key_figures_by_name_and_place(data):
    assert (
        data.figure("highest_current_a", "substation A")
        == data.table("substations").query("substation == 'A'")["current_a"].max()
    )
    assert data.figure("highest_current_a", "substation Z") is None


def test_what_counts_begins_after_the_warm_up(data):
    assert (data.counts_from_s, data.counted_hours) == (0.0, pytest.approx(1200.0 / 3600.0))
    clock = data.scenario.clock.model_copy(update={"warm_up": 300.0})
    late = RunData(data.results, data.scenario.model_copy(update={"clock": clock}))
    assert (late.counts_from_s, late.counted_hours) == (300.0, pytest.approx(900.0 / 3600.0))


def test_trains_of_the_timetable_are_on_their_routes(data):
    assert data.planned["3/IC"].path.place(2000.0) == ("2", pytest.approx(8.0))
    assert data.ways["2"]["status"] == "left"


def test_the_step_in_which_a_train_leaves_is_left_out(data):
    ways = [dict(way) for way in data.ways.values()]
    rows = dict(data.rows_of("trains", "train"))["1"]
    (leaving,) = (way for way in ways if way["train"] == "1")
    leaving["finished_s"] = rows["time_s"].iloc[-1] + 0.4
    cut = RunData(Results(data.results.run | {"trains": ways}, [], data.results._source), data.scenario)
    assert len(cut.whole_rows("1")) == len(rows) - 1
    leaving["finished_s"] = rows["time_s"].iloc[-1] + 1.0
    whole = RunData(Results(data.results.run | {"trains": ways}, [], data.results._source), data.scenario)
    assert len(whole.whole_rows("1")) == len(rows)
    assert cut.whole_rows("99") is None


def test_rows_of_each_train_are_in_the_order_of_time_however_the_table_is(data):
    rows = data.results.table("trains").sample(frac=1.0, random_state=1)
    mixed = RunData(data.results, data.scenario, {"trains": rows})
    found = dict(mixed.rows_of("trains", "train"))
    assert list(found) == sorted(rows["train"].astype(str).unique())
    assert sum(map(len, found.values())) == len(rows)
    for name, own in found.items():
        pd.testing.assert_frame_equal(own, rows[rows["train"] == name].sort_values("time_s", kind="stable"))
    assert mixed.whole_rows("no such train") is None

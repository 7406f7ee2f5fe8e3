"""The train graph of a run from its tables."""

import numpy as np
import pandas as pd
import pytest
from fake_runs import big_run, small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.trains.run_graph import busiest, places_of, planned_times, run_graphs, thinned
from tractionpower.reporting.figures.trains.train_graph import TrainLine
from tractionpower.results.results import Results


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def lines_of(figure, label):
    return [line for line in figure.axes[0].lines if line.get_label() == label]


def test_every_train_runs_to_its_end_in_its_direction(data):
    graphs = run_graphs(data)
    assert list(graphs) == ["train_graph"]
    rising = lines_of(graphs["train_graph"], "computed, rising kilometres")
    falling = lines_of(graphs["train_graph"], "computed, falling kilometres")
    ends = {(line.get_ydata()[0], line.get_ydata()[-1]) for line in (*rising, *falling)}
    assert ends == {(10.0, 20.0), (0.0, 20.0), (10.0, 0.0), (20.0, 0.0)}
    last = max(line.get_xdata()[-1] for line in rising)
    assert last == data.ways["2"]["finished_s"]
    texts = graphs["train_graph"].axes[0].texts
    names = [text.get_text() for text in texts if text.get_gid() != "substation"]
    assert names == ["1", "2", "3/IC", "4"]


def test_names_do_not_overlap(data, no_overlap):
    figure = run_graphs(data)["train_graph"]
    no_overlap(figure, figure.axes[0].texts)


def test_planned_times_and_places_are_those_of_the_timetable(data):
    assert sorted(planned_times(data)) == [(0.0, 0.0), (330.0, 10.0), (360.0, 10.0), (700.0, 20.0)]
    places = places_of(data)
    assert places.stations == [(0.0, "Alfa", True), (10.0, "Ćma", True), (20.0, "Beta", True)]
    assert places.devices == [(0.0, "A", True), (10.0, "C", False), (20.0, "B", True)]


def test_a_stuck_train_is_marked_and_one_still_on_its_way_is_not(data):
    ways = [dict(way, status="stuck" if way["train"] == "1" else "on_line") for way in data.ways.values()]
    results = Results(data.results.run | {"trains": ways}, [], data.results._source)
    figure = run_graphs(RunData(results, data.scenario))["train_graph"]
    assert len(lines_of(figure, "not at the end of its route")) == 1


def test_a_day_has_a_fine_graph_of_two_hours():
    run = big_run()
    graphs = run_graphs(RunData(run.results, run.scenario))
    assert list(graphs) == ["train_graph", "train_graph_fine"]
    whole, fine = (graphs[name].axes[0] for name in graphs)
    named, fine_named = ([text for text in axes.texts if text.get_gid() != "substation"] for axes in (whole, fine))
    assert len(named) == 0
    assert len(fine_named) > 15
    begin, end = fine.get_xlim()
    assert 7200.0 <= end - begin < 7500.0
    assert sum(len(line.get_xdata()) for line in whole.lines) < 120 * 4000
    rows = run.results.table("trains")["time_s"]
    counts = [((rows >= t) & (rows < t + 7200.0)).sum() for t in np.arange(0.0, 79201.0, 900.0)]
    assert busiest(rows)[0] == 900.0 * int(np.argmax(counts))


def test_of_a_short_run_all_is_the_busiest_part():
    assert busiest(pd.Series([7300.0, 7400.0])) == (7200.0, 14400.0)


def test_a_thinned_line_keeps_its_ends_and_its_breaks():
    km = np.linspace(0.0, 10.0, 1001)
    km[333] = np.nan
    line = thinned(TrainLine("1", np.arange(1001.0), km), 10.0)
    assert 100 < len(line.km) < 110
    assert (line.km[0], line.km[-1], np.isnan(line.km).sum()) == (0.0, 10.0, 1)

"""Train graph of delays, lost seconds along the line, delays by cause."""

import numpy as np
import pandas as pd
import pytest
from fake_feasibility import judged
from fake_runs import big_run, small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.delays.delay_graph import delay_graphs, late_stretches, worst_hours
from tractionpower.reporting.figures.delays.delay_styles import CAUSES, ORIGINS, main_origin
from tractionpower.reporting.figures.delays.lost_figures import delays_by_cause, lost_time
from tractionpower.reporting.figures.of_run import write_figures
from tractionpower.reporting.figures.trains.train_graph import TrainLine

LATE = {"2": {"voltage": 20.0, "current_limit": 5.0}}


def data_of(run, late):
    return RunData(judged(run.results, run.scenario, late), run.scenario)


@pytest.fixture
def data():
    return data_of(small_run(), LATE)


def test_no_two_causes_look_alike_in_black_and_white():
    lines = [str(style.dashes) for name, style in CAUSES.items() if name in ORIGINS]
    areas = [style.hatch for name, style in CAUSES.items() if name in ORIGINS]
    assert len(set(lines)) == len(set(areas)) == len(ORIGINS)
    assert len({style.words for style in CAUSES.values()}) == len(CAUSES)


def test_the_late_train_is_drawn_in_its_cause_and_says_how_late_it_is(data):
    (figure,) = delay_graphs(data).values()
    axes = figure.axes[0]
    late = [line for line in axes.lines if line.get_label() == "late by low voltage"]
    assert [line.get_color() for line in late] == [CAUSES["voltage"].colour]
    assert late[0].get_xdata()[-1] == pytest.approx(725.0)  # 25 s after its planned arrival at 700 s
    assert late[0].get_ydata()[-1] == pytest.approx(20.0, abs=0.05)
    assert "+25 s" in [text.get_text() for text in axes.texts]
    assert len([line for line in axes.lines if line.get_label() == "on time"]) == 4


def test_texts_do_not_overlap(data, no_overlap):
    (figure,) = delay_graphs(data).values()
    no_overlap(figure, figure.axes[0].texts)


def test_a_timetable_that_holds_has_no_graph_of_delays():
    assert delay_graphs(data_of(small_run(), {})) == {}
    run = small_run()
    assert delay_graphs(RunData(run.results, run.scenario)) == {}


def test_a_day_has_a_finer_graph_of_the_worst_hours():
    run = big_run()
    names = sorted({str(name) for name in run.results.table("calls")["train"]})
    graphs = delay_graphs(data_of(run, {name: {"voltage": 5.0 + k} for k, name in enumerate(names[:30])}))
    assert list(graphs) == ["delay_graph", "delay_graph_fine"]
    texts = graphs["delay_graph"].axes[0].texts
    labels = [text.get_text() for text in texts if text.get_gid() != "substation"]
    assert f"{names[29]} +34 s" in labels
    assert len(labels) <= 8


def test_stretches_begin_at_the_call_before_and_tell_what_is_carried_on():
    line = TrainLine("7", np.arange(0.0, 301.0), np.arange(0.0, 301.0) / 10.0)
    rows = pd.DataFrame(
        {
            "actual_s": [100.0, 200.0, np.nan], "delay_s": [0.5, 30.0, np.nan], "knock_on_s": [0.0, 20.0, np.nan],
            **{f"origin_{name}_s": [0.0, 0.0, np.nan] for name in ORIGINS},
        }
    )  # fmt: skip
    rows.loc[1, "origin_dwell_s"], rows.loc[1, "origin_voltage_s"] = 10.0, 20.0
    (stretch,) = late_stretches(line, rows, 1.0)
    assert (stretch.time_s[0], stretch.time_s[-1], stretch.km[0], stretch.km[-1]) == (100.0, 200.0, 10.0, 20.0)
    assert (stretch.cause, stretch.carried) == ("voltage", True)
    assert main_origin(rows.loc[0]) == ""


def test_the_worst_hours_are_those_with_most_seconds_of_delay():
    late = pd.DataFrame({"actual_s": [20000.0, 50000.0, 51000.0], "delay_s": [30.0, 20.0, 20.0]})
    begin, end = worst_hours(late, 0.0, 86400.0)
    assert end - begin == 7200.0
    assert begin <= 50000.0
    assert end >= 51000.0


def test_lost_seconds_stand_at_their_kilometres_and_add_up(data):
    figure = lost_time(data)
    axes = figure.axes[0]
    heights = {}
    for bar in (bar for bars in axes.containers for bar in bars):
        km = round(bar.get_x() + bar.get_width() / 2, 3)
        heights[km] = heights.get(km, 0.0) + bar.get_height()
    rows = data.table("lost_time").groupby("km")["lost_s"].sum()
    assert heights == pytest.approx(dict(rows.items()))
    texts = " ".join(text.get_text() for text in axes.texts)
    assert "area of A: " in texts
    kinds = {run.train for run in data.scenario.runs}
    assert {text.get_text() for text in figure.legends[0].get_texts()} <= kinds


def test_delays_by_cause_add_up_to_the_delay(data):
    axes = delays_by_cause(data).axes[0]
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["2"]
    widths = {bars.get_label(): bars[0].get_width() for bars in axes.containers}
    assert widths == pytest.approx({"low voltage": 20.0, "train current limit": 5.0})
    assert [text.get_text() for text in axes.texts] == ["25 s at Beta"]
    assert delays_by_cause(data_of(small_run(), {})) is None


def test_they_are_among_the_figures_and_go_with_the_verdict(tmp_path):
    run = small_run()
    write_figures(judged(run.results, run.scenario, LATE), run.scenario, tmp_path)
    mine = {"delay_graph.png", "delays_by_cause.png", "lost_time.png"}
    assert mine <= {path.name for path in tmp_path.iterdir()}
    write_figures(run.results, run.scenario, tmp_path)
    assert mine.isdisjoint({path.name for path in tmp_path.iterdir()})

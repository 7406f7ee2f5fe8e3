"""Voltages along the line and at pantographs."""

import numpy as np
import pytest
from fake_runs import big_run, figure, small_run
from small_studies import load, make_scenario, run_in_memory

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.supply.voltage_figures import useful_voltages, voltage_along_line, voltage_histogram
from tractionpower.results.results import Results


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def line_named(axes, label):
    return next(line for line in axes.lines if line.get_label() == label)


def test_each_track_has_fixed_places_and_pantographs(data):
    profile = data.table("profile")
    panels = voltage_along_line(data).axes
    assert [axes.get_ylabel() for axes in panels] == ["track 1\nvoltage [V]", "track 2\nvoltage [V]"]
    for axes, track in zip(panels, "12", strict=True):
        rows = profile[(profile["track"] == track) & (profile["where"] == "pantograph")]
        lowest, highest = (line_named(axes, f"pantographs, {which}") for which in ("lowest", "highest"))
        assert np.nanmin(lowest.get_ydata()) == pytest.approx(rows["lowest_voltage_v"].min())
        assert np.nanmax(highest.get_ydata()) == pytest.approx(rows["highest_voltage_v"].max())
        fixed = line_named(axes, "fixed cross-sections, mean")
        assert fixed.get_xdata().tolist() == [0.0, 10.0, 20.0]
    assert panels[-1].child_axes[0].get_xlabel() == "kilometre of the line [km]"


def test_the_lowest_voltage_is_marked_on_its_track_with_train_and_time(data):
    worst = data.table("trains").loc[lambda rows: rows["voltage_v"].idxmin()]
    panels = voltage_along_line(data).axes
    texts = [[text.get_text() for text in axes.texts if text.get_text().startswith("lowest")] for axes in panels]
    (text,) = texts[int(worst["track"]) - 1]
    assert texts[2 - int(worst["track"])] == []
    assert text.startswith(f"lowest {worst['voltage_v']:.0f} V")
    assert f"train {worst['train']}, track {worst['track']}, km {worst['position_km']:.1f}" in text


def test_of_equal_voltages_the_one_that_the_text_names_is_marked(data):
    """The lowest voltage is the same at two places of two tracks; the key figure names the later one."""
    profile = data.table("profile").copy()
    fixed = profile["where"] != "pantograph"
    lowest = profile["lowest_voltage_v"].min() - 100.0
    profile.loc[fixed & profile["km"].isin([10.0, 20.0]), "lowest_voltage_v"] = lowest
    told = figure("lowest_voltage_v", lowest, "track 2, km 20", 60.0)
    twice = RunData(Results(data.results.run, [told], data.results._source), data.scenario)
    twice._read["profile"] = profile
    panels = voltage_along_line(twice).axes
    marks = [[(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines if line.get_marker() == "v"] for axes in panels]
    assert marks[0] == []
    assert marks[1] == [(20.0, pytest.approx(lowest))]
    (text,) = [text.get_text() for text in panels[1].texts if text.get_text().startswith("lowest")]
    assert "track 2, km 20, 00:01:00" in text


def test_lines_are_broken_where_no_train_was(data):
    profile = data.table("profile")
    data._read["profile"] = profile[~((profile["where"] == "pantograph") & (profile["km"].between(3.0, 4.0)))]
    axes = voltage_along_line(data).axes[0]
    lowest = line_named(axes, "pantographs, lowest")
    (gap,) = np.flatnonzero(np.isnan(lowest.get_xdata()))
    assert lowest.get_xdata()[[gap - 1, gap + 1]].tolist() == [2.75, 4.25]


def test_a_study_with_loads_only_has_one_panel_for_all_tracks():
    scenario = make_scenario(load("one", 13.0), load("two", 4.0, "2", **{"from": 5.0}), name="Loads")
    results, _, _ = run_in_memory(scenario)
    drawn = voltage_along_line(RunData(results, scenario))
    (axes,) = drawn.axes
    profile = results.table("profile")
    assert {line.get_label() for line in axes.lines} >= {"track 1, mean", "track 2, mean", "loads"}
    one = line_named(axes, "track 1, mean")
    np.testing.assert_allclose(one.get_ydata(), profile[profile["track"] == "1"].sort_values("km")["mean_voltage_v"])
    assert "load one" in next(text.get_text() for text in axes.texts if text.get_text().startswith("lowest"))
    assert drawn.get_suptitle() == "Loads: voltage along the line"


def test_names_do_not_overlap_on_a_line_with_many_devices(no_overlap):
    run = big_run()
    drawn = voltage_along_line(RunData(run.results, run.scenario))
    no_overlap(drawn, drawn.axes[0].texts)
    no_overlap(drawn, drawn.axes[1].texts)
    drawn.canvas.draw()
    legend = drawn.legends[0].get_window_extent()
    assert drawn.bbox.x0 <= legend.x0 < legend.x1 <= drawn.bbox.x1


def test_the_histogram_shares_out_the_whole_time(data):
    trains = data.table("trains")
    drawn = voltage_histogram(data)
    (axes,) = drawn.axes
    heights = [bar.get_height() for bar in axes.patches]
    assert sum(heights) == pytest.approx(100.0)
    feeding = 100.0 * (trains["current_a"] < 0.0).mean()
    half = len(heights) // 2
    assert sum(heights[half:]) == pytest.approx(feeding)
    labels = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert f"lowest voltage: {trains['voltage_v'].min():.0f} V" in labels
    assert axes.get_xlabel() == "voltage at the pantograph [V]"


def test_the_histogram_counts_from_the_end_of_the_warm_up(data):
    clock = data.scenario.clock.model_copy(update={"warm_up": 600.0})
    late = RunData(data.results, data.scenario.model_copy(update={"clock": clock}))
    rows = data.table("trains").query("time_s >= 600")
    labels = [text.get_text() for text in voltage_histogram(late).legends[0].get_texts()]
    assert f"lowest voltage: {rows['voltage_v'].min():.0f} V" in labels


@pytest.mark.parametrize(
    ("places", "shown"),
    [
        ({"": 3100.0, "zone A–B": 2900.0, "train 1": 2800.0}, "mean useful voltage of all trains"),
        ({"zone A–B": 2900.0, "zone B–C": 2850.0, "train 1": 2800.0}, "lowest mean useful voltage, zone B–C"),
        ({"train 2": 2700.0, "train 1": 2800.0}, "lowest mean useful voltage, train 2"),
    ],
)
def test_the_mean_useful_voltage_is_that_of_the_run_of_a_zone_or_of_a_train(data, places, shown):
    figures = [figure("mean_useful_voltage_time_mean_v", value, place) for place, value in places.items()]
    found = useful_voltages(RunData(Results({}, figures, {}), data.scenario))
    expected = places[""] if "" in places else min(value for place, value in places.items() if place in shown)
    assert found == [(f"{shown}, mean over time", expected)]


def test_without_their_tables_there_are_no_figures(data):
    bare = RunData(small_run().without("trains", "profile"), data.scenario)
    assert (voltage_along_line(bare), voltage_histogram(bare)) == (None, None)

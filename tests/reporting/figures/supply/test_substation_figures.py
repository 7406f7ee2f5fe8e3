"""Currents, loads and load duration of substations."""

import numpy as np
import pyarrow as pa
import pytest
from fake_runs import big_run, small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.supply.power_figures import substation_currents
from tractionpower.reporting.figures.supply.substation_figures import (
    duration_curve,
    load_duration,
    substation_loads,
)
from tractionpower.results.results import Results


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def test_a_day_of_many_substations_is_drawn_with_few_points_and_no_peak_is_lost():
    run = big_run()
    data = RunData(run.results, run.scenario)
    figure = substation_currents(data)
    highest = run.results.table("substations").groupby("substation", observed=True)["current_a"].max()
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert len(panels) == 14
    for axes in panels:
        name = axes.get_title(loc="left").split(":")[0].removeprefix("▲ ")
        (band,) = axes.collections
        corners = band.get_paths()[0].vertices
        assert corners[:, 1].max() == pytest.approx(highest[name], rel=1e-6)
        assert len(corners) < 6000
        assert f"highest {highest[name]:.0f} A at " in axes.get_title(loc="left")
    assert [axes.get_title(loc="left").split(":")[0] for axes in panels[::2]] == [f"▲ Substation {k}" for k in range(1, 8)]
    assert len({axes.get_ylim() for axes in panels}) == 1


def test_a_panel_too_many_shows_nothing_but_its_clock():
    run = big_run()
    first = run.scenario.supply.substations[0].id
    some = run.results.table("substations").query(f"substation != '{first}' and time_s < 4000")
    data = RunData(Results({}, [], {"substations": pa.Table.from_pandas(some, preserve_index=False)}), run.scenario)
    panels = substation_currents(data).axes
    assert len(panels) == 14
    (spare,) = (axes for axes in panels if not axes.lines)
    assert not spare.get_frame_on()
    assert spare.get_xlabel() == "time of day [h:min]"


def test_few_steps_are_drawn_as_they_are_with_the_mean_of_a_quarter_of_an_hour(data):
    panels = substation_currents(data).axes
    rows = data.table("substations").query("substation == 'A'")
    steps, mean = panels[0].lines[1:]
    np.testing.assert_allclose(steps.get_ydata(), rows["current_a"])
    assert mean.get_ydata()[900 + 20] == pytest.approx(rows["current_a"].iloc[21:921].mean(), rel=1e-5)
    assert np.isnan(mean.get_ydata()[:899]).all()
    assert panels[-1].get_xlabel().startswith("time of day")


def test_titles_of_panels_do_not_overlap(no_overlap):
    run = big_run()
    figure = substation_currents(RunData(run.results, run.scenario))
    no_overlap(figure, [axes._left_title for axes in figure.axes if axes.get_visible()])


def test_bars_are_the_key_figures(data):
    figure = substation_loads(data)
    left, right = figure.axes
    assert [text.get_text() for text in left.get_yticklabels()] == ["A", "B"]
    bars = [[bar.get_width() for bar in bars] for bars in left.containers]
    power = data.table("substations").groupby("substation", observed=True)["power_kw"]
    assert bars[0] == pytest.approx((power.max() / 1000.0).tolist())
    assert bars[2] == pytest.approx((power.mean() / 1000.0).tolist())
    assert bars[1] == pytest.approx([data.figure("highest_mean_power_15_min_kw", f"substation {s}") / 1000.0 for s in "AB"])
    assert right.containers[0][0].get_width() == pytest.approx(data.figure("highest_current_a", "substation A") / 1000.0)
    assert (left.get_xlabel(), right.get_xlabel()) == ("power at the busbars [MW]", "current [kA]")


def test_a_window_longer_than_the_run_has_no_bars(data):
    figures = [figure for figure in data.results.key_figures if "15_min" not in figure["name"]]
    short = RunData(Results(data.results.run, figures, data.results._source), data.scenario)
    assert [len(axes.containers) for axes in substation_loads(short).axes] == [2, 2]
    none = RunData(Results(data.results.run, [], data.results._source), data.scenario)
    assert substation_loads(none) is None


def test_values_of_bars_do_not_overlap(no_overlap):
    run = big_run()
    figure = substation_loads(RunData(run.results, run.scenario))
    for axes in figure.axes:
        no_overlap(figure, axes.texts)


def test_load_duration_falls_from_the_highest_power_and_its_area_is_the_energy(data):
    (axes,) = load_duration(data).axes
    rows = data.table("substations")
    for line in axes.lines:
        name = line.get_label().split(":")[0]
        power = rows[rows["substation"] == name]["power_kw"] / 1000.0
        share, value = line.get_xdata(), line.get_ydata()
        assert (value[0], share[0], share[-1]) == (pytest.approx(power.max()), 0.0, 100.0)
        assert np.all(np.diff(value) <= 0.0)
        assert np.trapezoid(value, share) / 100.0 == pytest.approx(power.mean(), rel=5e-3)
    assert "0 h 20 min" in axes.get_xlabel()


def test_a_long_curve_has_few_points_and_keeps_both_ends():
    falling = np.sort(np.random.default_rng(1).exponential(size=86400))[::-1]
    share, value = duration_curve(falling)
    assert len(share) <= 1501
    assert (value[0], value[-1], share[-1]) == (falling[0], falling[-1], 100.0)
    half = float(np.interp(50.0, share, value))
    assert half == pytest.approx(np.median(falling), rel=1e-2)


def test_every_one_of_many_substations_looks_different():
    run = big_run()
    (axes,) = load_duration(RunData(run.results, run.scenario)).axes
    assert len({(line.get_color(), str(line.get_linestyle())) for line in axes.lines}) >= 12
    assert len({(line.get_color(), str(line._dash_pattern)) for line in axes.lines}) == 14


def test_without_the_table_there_are_no_figures(data):
    bare = RunData(small_run().without("substations"), data.scenario)
    assert (substation_currents(bare), load_duration(bare)) == (None, None)

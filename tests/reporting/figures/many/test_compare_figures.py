"""Figures of a comparison, made from hand-made tables."""

import itertools

import numpy as np
import pytest
from small_studies import load, make_scenario

from tractionpower.reporting.figures.many.compare_figures import compare_figures
from tractionpower.results.results import Results
from tractionpower.studies.runner.outcomes import rows_table

SCENARIO = make_scenario(load("tap"), name="taps")
FOLDERS = ("base", "new")


def results_of(profile, figures):
    rows = [dict(zip(("folder", "track", "km", "where", "lowest_voltage_v"), one, strict=True)) for one in profile]
    told = [dict(zip(("figure", "place", "folder", "value"), one, strict=True)) for one in figures]
    tables = {name: rows_table(name, found) for name, found in (("compare_profile", rows), ("compare", told)) if found}
    run = {"kind": "compare", "name": "taps", "compare": {"folders": [{"name": name} for name in FOLDERS]}}
    return Results(run, [], tables, SCENARIO)


def test_lowest_voltages_are_laid_over_each_other_by_track():
    places = itertools.product(enumerate(FOLDERS), "12", (10.0, 0.0))
    profile = [(name, track, km, "fixed", 3000.0 - 10 * k - km) for (k, name), track, km in places]
    figure = compare_figures(results_of(profile, []), SCENARIO)["compare_voltage"]
    assert [axes.get_ylabel().split("\n")[0] for axes in figure.axes] == ["track 1", "track 2"]
    drawn = {line.get_label(): line for line in figure.axes[1].get_lines() if line.get_label() in FOLDERS}
    assert list(drawn["new"].get_xdata()) == [0.0, 10.0]
    assert list(drawn["new"].get_ydata()) == pytest.approx([2990.0, 2980.0])


def test_pantographs_count_where_trains_ran_and_gaps_break_the_line():
    profile = [("base", "1", km, "pantograph", 2900.0) for km in (0.0, 0.5, 5.0, 5.5)]
    profile += [("base", "1", 2.0, "fixed", 3500.0), ("new", "1", 2.0, "fixed", 3500.0)]
    (axes,) = compare_figures(results_of(profile, []), SCENARIO)["compare_voltage"].axes
    drawn = {line.get_label(): line for line in axes.get_lines()}
    assert np.isnan(drawn["base"].get_xdata()).sum() == 1
    assert 3500.0 not in drawn["base"].get_ydata()
    assert list(drawn["new"].get_ydata()) == [3500.0]


def test_loads_of_substations_stand_side_by_side_along_the_line():
    figures = [
        (name, f"substation {one}", folder, value * scale)
        for name, scale in (("rms_current_a", 1.0), ("highest_power_kw", 3.0), ("highest_current_a", 2.0))
        for one, folder, value in (("B", "base", 100.0), ("A", "base", 200.0), ("A", "new", 150.0))
    ]
    figures.append(("rms_current_a", "feeder A 1 low_km", "base", 999.0))
    figure = compare_figures(results_of([], figures), SCENARIO)["compare_substations"]
    power, rms, _ = figure.axes
    assert [label.get_text() for label in figure.axes[-1].get_xticklabels()] == ["A", "B"]
    assert [[bar.get_height() for bar in bars] for bars in rms.containers] == [[200.0, 100.0], [150.0, 0.0]]
    assert power.get_ylabel().startswith("highest power")


def test_a_quarter_of_an_hour_replaces_the_power_of_a_step_and_few_are_drawn_of_many():
    names = ("highest_clock_15_min_power_kw", "highest_power_kw")
    figures = [(name, f"substation S{k:03d}", "base", float(k)) for name in names for k in range(50)]
    figure = compare_figures(results_of([], figures), SCENARIO)["compare_substations"]
    (axes,) = figure.axes
    assert axes.get_ylabel().startswith("highest quarter")
    assert axes.get_xticklabels()[0].get_text() == "S020"
    assert "20 with smaller loads are not drawn" in figure.get_suptitle()


def test_nothing_is_drawn_of_nothing():
    assert compare_figures(results_of([], []), SCENARIO) == {}
    elsewhere = [("base", "9", 1.0, "fixed", 3000.0)]  # a track that the base does not know
    assert compare_figures(results_of(elsewhere, []), SCENARIO) == {}

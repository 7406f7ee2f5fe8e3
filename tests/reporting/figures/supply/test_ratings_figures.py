"""Figures of ratings and useful voltages: they show the tables, and stay readable with many devices."""

from itertools import pairwise

import numpy as np
import pytest
from fake_results import make_case
from fake_sizing import sized

from tractionpower.reporting.facts.device_words import supply_points_along_line, zones_along_line
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.style import GREEN, ORANGE, VERMILION
from tractionpower.reporting.figures.supply import ratings_figures
from tractionpower.reporting.figures.supply.useful_figures import colour_classes, text_colour, useful_voltage_zones
from tractionpower.results.results import Results
from tractionpower.studies.ratings.words import window_words


def data_of(**case):
    results, scenario = make_case(**case)
    return RunData(sized(results, scenario), scenario)


@pytest.fixture(scope="module")
def data():
    return data_of()


def test_utilisation_shows_every_rated_device_in_its_ruling_window(data):
    rows = data.table("ratings")
    rows = rows[rows["ruling"]].set_index("device")
    shown = {}
    for axes in ratings_figures.utilisation(data).axes:
        names = [label.get_text() for label in axes.get_yticklabels()]
        shown |= {
            name: (bar.get_width(), text.get_text()) for name, bar, text in zip(names, axes.patches, axes.texts, strict=True)
        }
    assert set(shown) == set(rows.index)
    for name, (width, text) in shown.items():
        percent, window = rows.loc[name, ["utilisation_percent", "window_s"]]
        assert width == pytest.approx(percent)
        assert text == f"{percent:.0f} %, {window_words(window)}"


def test_with_many_devices_the_worst_of_each_kind_are_shown(no_overlap):
    figure = ratings_figures.utilisation(data_of(substations=14))
    bars = sum(len(axes.patches) for axes in figure.axes)
    assert bars <= ratings_figures.MOST_BARS
    assert max(figure.get_size_inches()) <= 11.8
    for axes in figure.axes:
        no_overlap(figure, axes.get_yticklabels())
    assert "the 14 with the highest utilisation of 56" in " ".join(axes.get_title(loc="left") for axes in figure.axes)


def test_colours_tell_the_margin():
    assert [ratings_figures.margin_colour(value, 100.0) for value in (80.0, 80.1, 100.0, 100.1)] == [
        GREEN,
        ORANGE,
        ORANGE,
        VERMILION,
    ]
    assert ratings_figures.margin_colour(75.0, 90.0) == ORANGE


def test_sharing_adds_up_to_the_whole(data):
    shares = ratings_figures.sharing(data).axes[0]
    assert len(shares.patches) == 4
    ends = {bar.get_y(): bar.get_x() + bar.get_width() for bar in shares.patches}
    np.testing.assert_allclose(list(ends.values()), 100.0)


def test_demand_beyond_the_contract_stands_out(data):
    figure = ratings_figures.demand(data)
    rows = data.table("demand")
    drawn = sum(len(axes.patches) for axes in figure.axes)
    red = sum(
        bar.get_facecolor()[:3] == pytest.approx((0.835, 0.369, 0.0), abs=0.01) for axes in figure.axes for bar in axes.patches
    )
    assert (drawn, red) == (len(rows), (rows["met"] == "no").sum())
    contracts = {name: own.max() for name, own in rows.groupby(rows["supply_point"].astype(str))["contract_power_kw"]}
    for axes in figure.axes:
        named = contracts[axes.get_title(loc="left").partition(":")[0]]
        lines = {line.get_ydata()[0] * 1000.0 for line in axes.lines}
        assert lines == (set() if np.isnan(named) else {named})
        assert all(line.get_zorder() > bar.get_zorder() for line in axes.lines for bar in axes.patches)
    assert "contract" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_load_duration_shows_the_highest(data):
    figure = ratings_figures.device_load_duration(data)
    rows = data.table("load_duration")
    for axes, kinds in zip(figure.axes, (["substation"], ["feeder"], ["contact_line"]), strict=True):
        own = rows[rows["kind"].isin(kinds)]
        assert len(axes.lines) == min(ratings_figures.MOST_CURVES, own["device"].nunique())
        assert max(line.get_ydata().max() for line in axes.lines) == pytest.approx(own["current_a"].max())


def test_zones_by_the_hour_stand_in_their_cells():
    results, scenario = make_case(substations=5, hours=3.0)
    data = RunData(sized(results, scenario), scenario)
    figure = useful_voltage_zones(data)
    rows = data.table("useful_voltage")
    rows = rows[(rows["kind"] == "zone")]
    for axes, name in zip(figure.axes, ("current_weighted_v", "time_mean_v"), strict=False):
        assert sorted(text.get_text() for text in axes.texts) == sorted(f"{value:.0f}" for value in rows[name].dropna())
    marked = sum(text.get_bbox_patch() is not None for text in figure.axes[0].texts)
    assert marked == (rows["current_weighted_v"] < 2700.0).sum()


def test_classes_of_colours_are_round_and_hold_all():
    bounds = colour_classes(np.array([2487.0, 3011.0, np.nan]))
    assert bounds[0] <= 2487.0
    assert bounds[-1] >= 3011.0
    assert len(bounds) <= 13
    assert len(colour_classes(np.array([3000.0]))) >= 3


def test_texts_can_be_read_on_their_colour():
    assert (text_colour((1.0, 1.0, 1.0)), text_colour((0.0, 0.1, 0.3))) == ("black", "white")


def test_without_tables_there_are_no_figures(data):
    empty = RunData(Results({}, [], {}), data.scenario)
    drawn = (
        ratings_figures.utilisation,
        ratings_figures.device_load_duration,
        ratings_figures.sharing,
        ratings_figures.demand,
        useful_voltage_zones,
    )
    assert [draw(empty) for draw in drawn] == [None] * 5


def test_zones_and_supply_points_stand_along_the_line():
    scenario = make_case(substations=11)[1]  # Substation 10 comes before Substation 2 by name
    names = [f"Substation {k}" for k in range(1, 12)]
    assert supply_points_along_line(scenario, [*reversed(names), "unknown"]) == [*names, "unknown"]
    zones = {f"{a}–{b}": [b, a] for a, b in pairwise(names)}
    assert zones_along_line(scenario, dict(sorted(zones.items()))) == list(zones)

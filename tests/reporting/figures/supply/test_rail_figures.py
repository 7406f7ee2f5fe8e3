"""Rail potentials along the line and over time."""

import numpy as np
import pandas as pd
import pytest
from fake_rails import rail_run
from fake_runs import big_run, small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.supply.rail_figures import rail_potential_along_line, rail_potential_over_time, worst_places


@pytest.fixture(scope="module")
def made():
    return rail_run()


@pytest.fixture
def data(made):
    return RunData(made.results, made.scenario)


def line_named(axes, label):
    return next(line for line in axes.lines if line.get_label() == label)


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_each_return_conductor_has_a_panel(data):
    profile = data.table("rail_profile")
    panels = rail_potential_along_line(data).axes
    assert [axes.get_ylabel() for axes in panels] == ["track 1\nrail potential [V]", "track 2\nrail potential [V]"]
    for axes, track in zip(panels, "12", strict=True):
        rows = profile[profile["track"] == track].sort_values("km")
        for label, column in (("highest", "highest"), ("mean over the run", "mean"), ("lowest", "lowest")):
            line = line_named(axes, label)
            np.testing.assert_array_equal(line.get_xdata(), rows["km"])
            np.testing.assert_array_equal(line.get_ydata(), rows[f"{column}_potential_v"].astype(float))


def test_limits_are_drawn_where_the_potential_comes_near_them(data):
    drawn = texts(rail_potential_along_line(data).axes[0])
    assert {"120 V, permanent", "150 V, 300 s", "\N{MINUS SIGN}120 V, permanent", "\N{MINUS SIGN}150 V, 300 s"} <= set(drawn)


def test_limits_far_off_are_told_in_the_title():
    calm = rail_run(0.05)
    figure = rail_potential_along_line(RunData(calm.results, calm.scenario))
    assert "permanent touch voltage, ±120 V, lies outside" in figure.get_suptitle()
    assert not [text for text in texts(figure.axes[0]) if "permanent" in text]
    low, high = figure.axes[0].get_ylim()
    assert -60.0 < low < high < 60.0


def test_the_extremes_under_trains_are_marked_on_their_track(data):
    panels = rail_potential_along_line(data).axes
    for name in ("highest_rail_potential_v", "lowest_rail_potential_v"):
        told = next(each for each in data.results.key_figures if each["name"] == name)
        track = told["place"].split("track ")[1][0]
        words = f"{told['value']:.1f} V, {told['place'].split(', track')[0]}, {told['time']}".replace("-", "\N{MINUS SIGN}")
        assert [words in texts(axes) for axes in panels] == [track == "1", track == "2"]


def test_substations_and_stations_are_named(data):
    panels = rail_potential_along_line(data).axes
    assert {"A", "B", "C"} <= set(texts(panels[0]))
    (names,) = panels[-1].child_axes
    assert [label.get_text() for label in names.get_xticklabels()] == ["Alfa", "Ćma", "Beta"]
    assert names.get_xlabel() == "kilometre of the line [km]"


def test_names_do_not_overlap_on_a_long_line(no_overlap):
    run = rail_run(1.0, big_run(), 2.0)
    drawn = rail_potential_along_line(RunData(run.results, run.scenario))
    no_overlap(drawn, drawn.axes[0].texts)
    no_overlap(drawn, drawn.axes[1].child_axes[0].get_xticklabels())
    over_time = rail_potential_over_time(RunData(run.results, run.scenario))
    no_overlap(over_time, over_time.axes[1].texts)


def test_maps_show_all_rows_of_the_table(data):
    rails = data.table("rails")
    worst, first, second, bar = rail_potential_over_time(data).axes
    for axes, track in ((first, "1"), (second, "2")):
        (mesh,) = axes.collections
        own = rails[rails["track"] == track].pivot_table(index="km", columns="time_s", values="potential_v")
        np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(own.shape), own.to_numpy())
        assert axes.get_ylabel().startswith(f"track {track}")
    assert bar.get_xlabel() == "rail potential against remote earth [V]"
    assert len([line for line in worst.lines if ", km " in str(line.get_label())]) == 3


def test_the_worst_places_lie_apart(data):
    rails = data.table("rails")
    places = worst_places(rails)
    top = rails.loc[rails["potential_v"].idxmax()]
    low = rails.loc[rails["potential_v"].idxmin()]
    assert places[0] == (top["track"], top["km"])
    assert any(track == low["track"] and abs(km - low["km"]) < 5.0 for track, km in places)
    assert all(a[0] != b[0] or abs(a[1] - b[1]) >= 5.0 for n, a in enumerate(places) for b in places[:n])


def test_bonded_rails_are_no_second_place():
    one = pd.DataFrame({"track": "1", "km": [0.0, 1.0, 9.0] * 2, "potential_v": [50.0, 45.0, 20.0, -9.0, -8.0, -30.0]})
    assert worst_places(pd.concat([one, one.assign(track="2")])) == [("1", 0.0), ("1", 9.0)]
    apart = one.assign(track="2", potential_v=one["potential_v"] * 0.5)
    assert worst_places(pd.concat([one, apart])) == [("1", 0.0), ("1", 9.0), ("2", 0.0)]


def test_without_rails_there_is_no_figure():
    run = small_run()
    data = RunData(run.results, run.scenario)
    assert rail_potential_along_line(data) is None
    assert rail_potential_over_time(data) is None

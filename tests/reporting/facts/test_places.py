"""Lines with branches: each figure shows a line over its own kilometres, with what stands there."""

import numpy as np
import pytest
from fake_branch import LOWEST_V, branch_run
from fake_runs import small_run

from tractionpower.reporting.facts.places import LinePlaces, told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.route_axis import course_of, devices_along
from tractionpower.reporting.figures.supply.rail_figures import rail_potential_along_line, rail_potential_over_time, worst_places
from tractionpower.reporting.figures.supply.voltage_figures import voltage_along_line, voltage_histogram
from tractionpower.reporting.figures.trains.run_graph import run_graphs
from tractionpower.reporting.figures.trains.train_figures import ride_of, train_figure, train_figures
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def data():
    run = branch_run()
    return RunData(run.results, run.scenario)


def texts(axes):
    return [text.get_text() for text in axes.texts]


def trains_of(axes):
    return [line for line in axes.lines if str(line.get_label()).startswith("computed")]


def test_devices_stand_where_they_meet_the_tracks_of_a_line(data):
    assert data.places.lines == (("1", "2"), ("3",))
    assert data.places.devices(["3"]) == [(14.0, "Rozjazd", True)]
    main = [("Zachod", 1.0, True), ("Pole", 6.5, False), ("Rozjazd", 12.0, True), ("Las", 18.5, False), ("Wschod", 25.0, True)]
    assert data.places.devices(["1", "2"]) == [(km, name, kind) for name, km, kind in main]
    assert data.places.stations(["3"]) == [(0.3, "Gory"), (7.2, "Lesna")]
    assert [data.places.number_of(tracks) for tracks in ("1", "2 1", "3", "other")] == [0, 0, 1, -1]


def test_a_line_without_branches_is_one_line():
    assert LinePlaces(small_run().scenario).lines == (("1", "2"),)
    assert [told(["1", "2"]), told(["3"])] == ["tracks 1, 2", "track 3"]


def test_the_train_graph_has_a_panel_for_each_line(data, no_overlap):
    figure = run_graphs(data)["train_graph"]
    main, branch = figure.axes
    assert [axes.get_ylabel().split("\n")[0] for axes in (main, branch)] == ["tracks 1, 2", "track 3"]
    substations = {substation.id for substation in data.scenario.supply.substations}
    assert sorted({*texts(main)} - substations) == ["IC 11", "IC 12", "R 101", "R 102", "T 21", "T 23"]
    assert sorted({*texts(branch)} - substations) == ["R 101", "R 102", "T 23"]
    assert {*texts(main)} & substations
    names = [[text.get_text() for text in axes.child_axes[0].get_yticklabels()] for axes in (main, branch)]
    assert names == [["Zachod", "Rozjazd", "Wschod"], ["Gory", "Lesna"]]
    for axes in (main, branch):
        no_overlap(figure, axes.texts)


def test_a_train_is_drawn_by_its_legs_up_to_the_junction(data):
    main, branch = run_graphs(data)["train_graph"].axes
    ends = {(line.get_label(), *np.round(line.get_ydata()[[0, -1]], 6)) for line in trains_of(main)}
    assert {("computed, rising kilometres", 0.5, 12.4), ("computed, falling kilometres", 12.2, 0.5)} <= ends
    there = {(line.get_label(), *np.round(line.get_ydata()[[0, -1]], 6)) for line in trains_of(branch)}
    assert there == {("computed, falling kilometres", 14.6, 0.3), ("computed, rising kilometres", 0.3, 14.4)}
    leaves = next(line.get_xdata()[-1] for line in trains_of(main) if round(line.get_ydata()[-1], 6) == 12.4)
    comes = [line.get_xdata()[0] for line in trains_of(branch)]
    assert any(abs(when - leaves) < 1e-9 for when in comes)
    over = [line for line in branch.lines if line.get_label() == "from or to another line"]
    assert len(over) == 3


def test_planned_times_stand_in_the_panel_of_their_track(data):
    main, branch = run_graphs(data)["train_graph"].axes
    planned = [next(line for line in axes.lines if "planned" in str(line.get_label())) for axes in (main, branch)]
    assert set(np.round(planned[1].get_ydata(), 6)) == {0.3, 7.2}
    assert set(np.round(planned[0].get_ydata(), 6)) == {0.5, 11.7}


@pytest.mark.parametrize("draw", [voltage_along_line, rail_potential_along_line])
def test_profiles_mark_the_devices_of_their_own_line(data, draw, no_overlap):
    figure = draw(data)
    first, second, branch = figure.axes
    names = [[text for text in texts(axes) if text in ("Zachod", "Pole", "Rozjazd", "Las", "Wschod")] for axes in figure.axes]
    assert names == [["Zachod", "Pole", "Rozjazd", "Las", "Wschod"], [], ["Rozjazd"]]
    uprights = {line.get_xdata()[0] for line in branch.lines if len(line.get_xdata()) == 2 and len(set(line.get_xdata())) == 1}
    assert uprights == {14.0}
    assert first.get_xlim() == second.get_xlim()
    assert branch.get_xlim()[1] < 15.0
    assert first.get_xlim()[1] > 26.0
    assert [axes.get_xlabel() != "" or bool(axes.child_axes) for axes in (first, second, branch)] == [False, True, True]


def test_without_trains_each_line_has_a_panel_for_its_tracks(data):
    profile = data.table("profile")
    fixed = RunData(data.results, data.scenario, {"profile": profile[profile["where"] == "cross_section"]})
    main, branch = voltage_along_line(fixed).axes
    assert [axes.get_ylabel().split("\n")[0] for axes in (main, branch)] == ["tracks 1, 2", "track 3"]
    assert any(text.startswith(f"lowest {LOWEST_V:.0f} V, track 3") for text in texts(branch))
    assert not any("lowest" in text for text in texts(main))


def test_maps_and_worst_places_go_by_line(data):
    figure = rail_potential_over_time(data)
    maps = {axes.get_ylabel().split("\n")[0]: axes for axes in figure.axes if "kilometre" in axes.get_ylabel()}
    assert texts(maps["track 3"]) == ["▲ Rozjazd"]
    rails = data.table("rails")
    same = rails[rails["km"] < 1.0]  # km 0 of both lines, some 12 km from each other
    assert {track for track, _ in worst_places(same, data.places.number_of)} == {"1", "3"}
    assert {track for track, _ in worst_places(same.assign(potential_v=5.0), data.places.number_of)} == {"1", "3"}


def test_a_route_over_both_lines_tells_where_its_kilometres_jump(data, no_overlap):
    path = data.planned["R 101"].path
    course = course_of(path)
    assert course.joints_m == pytest.approx((11900.0,))
    assert course.label.endswith("track 1 km 0.5 to 12.4, then track 3 km 14.6 to 0.3")
    found = devices_along(path, data.places.site)
    assert [(round(place), name) for place, name, _ in found] == [
        (500, "Zachod"), (6000, "Pole"), (11500, "Rozjazd"), (12500, "Rozjazd"),
    ]  # fmt: skip
    ((_, figure),) = train_figures(data, ["R 101"])
    assert "V, track 3, km 0.3" in figure.get_suptitle()
    joints = [line for line in figure.axes[0].lines if line.get_label() == "change to other kilometres"]
    assert [line.get_xdata()[0] for line in joints] == pytest.approx([11.9])
    assert course_of(data.planned["IC 11"].path).joints_m == ()


def test_a_dead_line_is_told_and_shaded(data):
    rows = data.whole_rows("R 101")
    dead = rows.assign(voltage_v=rows["voltage_v"].where(~rows["position_km"].between(5.0, 6.0), 0.0), limited_by="voltage")
    figure = train_figure(ride_of(data, "R 101", dead), data)
    volts = next(axes for axes in figure.axes if "voltage" in axes.get_ylabel())
    shades = [patch for patch in volts.patches if patch.get_label() == "line dead, no voltage"]
    assert len(shades) == 2  # at km 5 to 6 of either line
    assert -500.0 < volts.get_ylim()[0] < 0.0
    told_of = figure.get_suptitle()
    seconds = int((dead["voltage_v"] == 0.0).sum())
    assert told_of.endswith(f"; line dead for {seconds} s")
    assert "lowest voltage 28" in told_of  # that of the line in service
    trains = data.table("trains")
    dark = trains.assign(voltage_v=trains["voltage_v"].where(trains["train"] != "R 101", 0.0))
    histogram = voltage_histogram(RunData(data.results, data.scenario, {"trains": dark}))
    share = 100.0 * (trains["train"] == "R 101").mean()
    assert histogram.get_suptitle().endswith(f" ({share:.2f} % of the time, without voltage, left out)")
    assert histogram.axes[0].get_xlim()[0] > 2000.0


def test_of_equally_low_places_the_one_of_the_key_figures_is_marked(data):
    profile = data.table("profile").copy()
    profile.loc[(profile["track"] == "3") & (profile["km"] < 5.0), "lowest_voltage_v"] = 2000.0
    told_of = [dict(figure, value=2000.0, place="track 3, km 4.2") for figure in data.results.key_figures]
    low = RunData(Results(data.results.run, told_of, data.results._source), data.scenario, {"profile": profile})
    branch = voltage_along_line(low).axes[-1]
    assert any(text.startswith("lowest 2000 V, track 3, km 4.2") for text in texts(branch))
    (mark,) = (line for line in branch.lines if line.get_marker() == "v")
    assert abs(mark.get_xdata()[0] - 4.2) < 0.3

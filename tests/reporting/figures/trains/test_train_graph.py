"""The train graph: place over time, planned times, names."""

import numpy as np
import pytest
from fake_journeys import make_journey

from tractionpower.reporting.figures.trains.journeys import panels_of, write_journey_figures
from tractionpower.reporting.figures.trains.train_graph import (
    MOST_CIRCLES,
    MOST_NAMES,
    GraphPanel,
    GraphPlaces,
    TrainLine,
    broken_where_it_jumps,
    train_graph,
)
from tractionpower.studies.journeys import JourneyOutcome


def graph_of(journeys, line, title=""):
    return train_graph(panels_of(journeys, line, [[track.id for track in line.tracks]]), title)


@pytest.fixture
def graph(line, journeys):
    figure = graph_of(journeys, line, "a study")
    figure.canvas.draw()
    return figure


def drawn(axes, label):
    return [each for each in axes.lines if each.get_label() == label]


def test_every_train_is_a_line_of_place_over_time(graph, journeys):
    (axes,) = graph.axes
    (falling,) = drawn(axes, "computed, falling kilometres")
    rising = drawn(axes, "computed, rising kilometres")
    assert len(rising) == 2
    assert falling.get_xdata()[0] == 6 * 3600.0 + 200.0
    assert falling.get_xdata()[-1] == journeys[1].finished_s
    assert falling.get_ydata()[[0, -1]] == pytest.approx([12.0, 0.5])
    assert falling.get_linestyle() != rising[0].get_linestyle()
    assert len(drawn(axes, "not at the end of its route")) == 1


def test_planned_times_stand_at_their_stations(graph):
    (axes,) = graph.axes
    (planned,) = drawn(axes, "planned (timetable)")
    points = set(zip(planned.get_xdata(), np.round(planned.get_ydata(), 6), strict=True))
    assert {(6 * 3600.0, 0.5), (6 * 3600.0 + 300.0, 6.0), (6 * 3600.0 + 330.0, 6.0), (6 * 3600.0 + 660.0, 12.0)} <= points
    assert len(points) == 12


def test_times_are_those_of_a_clock_and_stations_are_named(graph, no_overlap):
    (axes,) = graph.axes
    assert [text.get_text() for text in axes.get_xticklabels()][:2] == ["06:00", "06:02"]
    (right,) = axes.child_axes
    names = [text.get_text() for text in right.get_yticklabels()]
    assert names in (["Alfa", "Bravo", "Delta"], ["Alfa", "Bravo", "Ćma Wielka", "Delta"])
    no_overlap(graph, right.get_yticklabels())
    assert axes.get_xlabel() == "time of day [h:min]"
    assert axes.get_ylabel().endswith("[km]")


def test_names_of_trains_do_not_overlap(line, no_overlap):
    journeys = [make_journey(line, f"train {k}", backwards=bool(k % 2), start_s=6 * 3600.0 + 45.0 * k) for k in range(20)]
    figure = graph_of(journeys, line)
    (axes,) = figure.axes
    assert len(axes.texts) >= 15
    no_overlap(figure, axes.texts)


def test_figures_of_the_trains_shown_and_none_of_an_earlier_run(tmp_path, line, journeys):
    scenario = type("Study", (), {"line": line, "name": "a study", "supply": None, "input_hash": "0123456789abcdef"})
    outcome = JourneyOutcome(tuple(journeys), 3000.0)
    paths = write_journey_figures(outcome, scenario, tmp_path, ["1", "IC 22/1"])
    names = {path.name for path in paths}
    assert names == {path.name for path in tmp_path.iterdir()}
    assert {"train_graph.png", "train-1.png"} <= names
    assert len(names) == 3
    (tmp_path / "mine.png").write_bytes(b"")
    write_journey_figures(outcome, scenario, tmp_path, ["33"])
    assert {path.name for path in tmp_path.iterdir()} == {"train_graph.png", "train-33.png", "mine.png"}


def test_of_many_trains_lines_are_thin_names_stay_away_and_circles_are_dots():
    many = [TrainLine(f"{k}", 60.0 * k + np.linspace(0.0, 900.0, 91), np.linspace(0.0, 20.0, 91)) for k in range(MOST_NAMES + 1)]
    circles = [(60.0 * k, 0.0) for k in range(MOST_CIRCLES + 1)]
    (axes,) = train_graph([GraphPanel("", many, circles)], "").axes
    (dots,) = drawn(axes, "planned (timetable)")
    assert (len(axes.texts), len(dots.get_xdata())) == (0, len(circles))
    (fewer,) = train_graph([GraphPanel("", many[:-1], circles[:-1])], "").axes
    assert (len(fewer.texts) > 10, len(drawn(fewer, "planned (timetable)"))) == (True, 1)
    assert dots.get_markersize() < drawn(fewer, "planned (timetable)")[0].get_markersize()
    assert axes.lines[0].get_linewidth() < fewer.lines[0].get_linewidth()


def test_substations_and_cabins_stand_on_the_left_axis():
    line = TrainLine("1", np.array([0.0, 600.0]), np.array([0.0, 20.0]))
    places = GraphPlaces(devices=[(0.0, "A", True), (10.0, "C", False), (20.0, "B", True)])
    (axes,) = train_graph([GraphPanel("", [line], [], places)], "").axes
    (substations,), (cabins,) = drawn(axes, "substation"), drawn(axes, "section cabin")
    assert (list(substations.get_ydata()), list(cabins.get_ydata())) == ([0.0, 20.0], [10.0])
    assert set(substations.get_xdata()) == {0.0}
    assert substations.get_marker() != cabins.get_marker()
    assert [(text.get_text(), text.xy[1]) for text in axes.texts if text.get_gid() == "substation"] == [("A", 0.0), ("B", 20.0)]


def test_a_line_is_broken_where_the_train_changes_to_a_track_with_other_kilometres():
    place, track = np.array([0.0, 100.0, 200.0, 300.0]), np.array([0, 0, 1, 1])
    km = broken_where_it_jumps(np.array([1.0, 1.1, 50.0, 50.1]), place, track)
    assert np.isnan(km).tolist() == [False, False, True, False]
    same = broken_where_it_jumps(np.array([1.0, 1.1, 1.2, 1.3]), place, track)
    assert not np.isnan(same).any()


def test_a_window_of_time_cuts_lines_and_keeps_the_mark_of_a_stuck_train_at_its_end():
    stuck = TrainLine("1", np.arange(0.0, 100.0, 10.0), np.linspace(0.0, 9.0, 10), arrives=False)
    early, late = stuck.between(20.0, 50.0), stuck.between(50.0, 500.0)
    assert (early.time_s.tolist(), early.arrives) == ([20.0, 30.0, 40.0, 50.0], True)
    assert (late.km[-1], late.arrives) == (9.0, False)
    assert stuck.between(200.0, 300.0) is None

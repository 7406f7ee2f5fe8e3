"""The train graph: place over time, planned times, names."""

import numpy as np
import pytest
from fake_journeys import make_journey

from tractionpower.reporting.journeys import stations_of_all, write_journey_figures
from tractionpower.reporting.train_graph import train_graph
from tractionpower.studies.journeys import JourneyOutcome


@pytest.fixture
def graph(line, journeys):
    figure = train_graph(journeys, stations_of_all(journeys, line), "a study")
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
    figure = train_graph(journeys, stations_of_all(journeys, line), "")
    (axes,) = figure.axes
    assert len(axes.texts) >= 15
    no_overlap(figure, axes.texts)


def test_figures_of_the_trains_shown_and_none_of_an_earlier_run(tmp_path, line, journeys):
    scenario = type("Study", (), {"line": line, "name": "a study"})
    outcome = JourneyOutcome(tuple(journeys), 3000.0)
    paths = write_journey_figures(outcome, scenario, tmp_path, ["1", "IC 22/1"])
    names = {path.name for path in paths}
    assert names == {path.name for path in tmp_path.iterdir()}
    assert {"train_graph.png", "train-1.png"} <= names
    assert len(names) == 3
    (tmp_path / "mine.png").write_bytes(b"")
    write_journey_figures(outcome, scenario, tmp_path, ["33"])
    assert {path.name for path in tmp_path.iterdir()} == {"train_graph.png", "train-33.png", "mine.png"}

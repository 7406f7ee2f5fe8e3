"""The figure of a journey: what is drawn, where, and that names do not overlap."""

from dataclasses import replace

import numpy as np
import pytest
from fake_journeys import make_journey, make_line

from tractionpower.reporting.figures.base.route_axis import course_of
from tractionpower.reporting.figures.trains.journey_figures import journey_figure, whole_rows
from tractionpower.studies.journeys import stations_on


def draw(journey, line):
    figure = journey_figure(journey, stations_on(journey, line), "train")
    figure.canvas.draw()
    return figure, {axes.get_ylabel().replace("\n", " "): axes for axes in figure.axes}


def line_named(axes, label):
    return next(each for each in axes.lines if each.get_label() == label)


def names_above(figure):
    (top,) = figure.axes[0].child_axes
    return top.get_xticklabels()


@pytest.mark.parametrize("backwards", [False, True])
def test_panels_have_units_and_the_train_runs_from_left_to_right(line, backwards):
    journey = make_journey(line, "1", backwards=backwards)
    _, panels = draw(journey, line)
    assert list(panels) == [
        "speed [km/h]",
        "height [m]",
        "gradient [‰]",
        "effort at the wheel [kN]",
        "current at the pantograph [A]",
    ]
    speed = line_named(panels["speed [km/h]"], "speed")
    ends = [12.0, 0.5] if backwards else [0.5, 12.0]
    assert speed.get_xdata()[[0, -1]] == pytest.approx(ends)
    left, right = panels["speed [km/h]"].get_xlim()
    assert (left > right) == backwards
    assert speed.get_ydata().max() == pytest.approx(3.6 * journey.rows["v_mps"].max())
    assert f"track {2 if backwards else 1}" in panels["current at the pantograph [A]"].get_xlabel()


def test_efforts_and_currents_are_means_over_the_place_of_their_step(line, journeys):
    _, panels = draw(journeys[0], line)
    effort = line_named(panels["effort at the wheel [kN]"], "tractive effort")
    assert effort.get_drawstyle() == "steps-post"
    np.testing.assert_allclose(effort.get_ydata()[:-1], journeys[0].rows["traction_n"] / 1000.0)
    current = line_named(panels["current at the pantograph [A]"], "current")
    np.testing.assert_allclose(current.get_ydata()[:-1], journeys[0].rows["current_a"])
    limit = line_named(panels["current at the pantograph [A]"], "train current limit of the line")
    assert limit.get_ydata()[0] == 1500.0
    assert np.isnan(limit.get_ydata()[-1])


def test_the_step_in_which_a_train_leaves_is_left_out_of_efforts_and_current(line, journeys):
    left = replace(journeys[0], finished_s=journeys[0].finished_s - 0.6)
    assert (whole_rows(journeys[0]), whole_rows(left)) == (len(left.rows), len(left.rows) - 1)
    _, panels = draw(left, line)
    for panel, label in (
        ("effort at the wheel [kN]", "tractive effort"),
        ("effort at the wheel [kN]", "resistance"),
        ("current at the pantograph [A]", "current"),
    ):
        drawn = line_named(panels[panel], label)
        assert drawn.get_xdata()[-1] == pytest.approx(0.5 + left.rows["s_m"][-1] / 1000.0)
        assert len(drawn.get_xdata()) == len(left.rows)
    assert line_named(panels["speed [km/h]"], "speed").get_xdata()[-1] == pytest.approx(12.0)


def test_limit_and_ceiling_are_those_of_the_journey(line, journeys):
    _, panels = draw(journeys[0], line)
    limit = line_named(panels["speed [km/h]"], "permitted speed of the line")
    np.testing.assert_allclose(limit.get_xdata(), [0.5, 5.0, 7.0, 12.0])
    np.testing.assert_allclose(limit.get_ydata(), [120.0, 80.0, 120.0, 120.0])
    area = panels["speed [km/h]"].collections[0].get_paths()[0].vertices
    brake = area[(area[:, 0] > 12.0 - 0.5) & (area[:, 0] < 11.99) & (area[:, 1] > 0.0)]
    assert len(brake) > 3
    np.testing.assert_allclose((brake[:, 1] / 3.6) ** 2, 1000.0 * (12.0 - brake[:, 0]), rtol=1e-6)  # v2 = 2 a s, a = 0.5 m/s2


def test_names_of_stations_do_not_overlap(line, journeys, no_overlap):
    figure, _ = draw(journeys[0], line)
    names = names_above(figure)
    assert [text.get_text() for text in names] == ["Alfa", "Bravo", "Ćma Wielka", "Delta"]
    no_overlap(figure, [*names, figure._suptitle])


def test_of_many_stations_the_stops_are_named_and_nothing_overlaps(no_overlap):
    many = [{"id": f"s{k}", "name": f"Halt at kilometre {k}", "km": 0.6 + 0.05 * k} for k in range(200)]
    stations = [*many, *({"id": s, "name": f"Central {s}", "km": km} for s, km in (("A", 0.5), ("B", 6.0), ("D", 12.0)))]
    line = make_line(stations=stations)
    figure, _ = draw(make_journey(line, "1"), line)
    names = names_above(figure)
    shown = [text.get_text() for text in names]
    assert {"Central A", "Central B", "Central D"} <= set(shown)
    assert 10 < len(shown) < 60
    no_overlap(figure, names)


def test_few_short_names_stand_level(line, no_overlap):
    line = make_line(stations=[{"id": "A", "name": "A", "km": 0.5}, {"id": "D", "name": "D", "km": 12.0}])
    figure, _ = draw(make_journey(line, "1"), line)
    assert [text.get_rotation() for text in names_above(figure)] == [0.0, 0.0]
    no_overlap(figure, names_above(figure))


def test_a_stuck_train_is_marked_where_it_stays(line, journeys):
    _, panels = draw(journeys[2], line)
    mark = line_named(panels["speed [km/h]"], "here it stays")
    assert mark.get_xdata()[0] == pytest.approx(0.5 + journeys[2].rows["s_m"][-1] / 1000.0)


def test_a_level_line_has_no_strip_of_heights():
    line = make_line(gradients=[])
    _, panels = draw(make_journey(line, "1"), line)
    assert len(panels) == 3


def test_a_line_without_speed_limits_somewhere_is_drawn():
    line = make_line(speed_limits=[{"from_km": 0.0, "to_km": 5.0, "kmh": 120.0}])
    _, panels = draw(make_journey(line, "1"), line)
    assert all(np.isfinite(panel.get_ylim()).all() for panel in panels.values())


def test_where_the_kilometrage_jumps_the_axis_is_the_distance():
    line = make_line(gradients=[], speed_limits=[], chainage_breaks=[{"at_km": 8.0, "continues_as_km": 9.0}])
    journey = make_journey(line, "1")
    assert journey.path.length_m == pytest.approx(10_500.0)
    course = course_of(journey.path)
    assert (course.begin, course.sign) == (0.0, 1)
    assert "distance" in course.label

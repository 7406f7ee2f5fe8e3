"""Clock, limits of the voltage, names of devices."""

import matplotlib as mpl
import pytest
from small_studies import make_scenario

from tractionpower.reporting.figures.base.axes import (
    clock_label,
    draw_limits,
    limits_between,
    mark_devices,
    set_clock,
    voltage_range,
)
from tractionpower.reporting.figures.base.style import STYLE, new_figure


@pytest.fixture
def axes():
    with mpl.rc_context(STYLE):
        yield new_figure(8.0, 4.0).add_subplot()


def test_limits_are_those_of_the_table_that_are_in_sight(axes):
    scenario = make_scenario()
    assert limits_between(scenario, 2500.0, 4000.0) == [("U_n", 3000.0), ("U_max1", 3600.0), ("U_max2", 3900.0)]
    axes.set_ylim(2500.0, 3700.0)
    draw_limits(axes, scenario)
    assert sorted(line.get_ydata()[0] for line in axes.lines) == [3000.0, 3600.0]
    assert [text.get_text() for text in axes.texts] == ["U_n\n3000 V", "U_max1\n3600 V"]
    assert axes.get_ylim() == (2500.0, 3700.0)


def test_equal_limits_share_a_line():
    scenario = make_scenario()
    double = [limit.model_copy(update={"value": 3900.0}) if limit.name == "u_max1" else limit for limit in scenario.limits]
    assert ("U_max1, U_max2", 3900.0) in limits_between(scenario.model_copy(update={"limits": tuple(double)}), 3100.0, 4000.0)


def test_a_range_of_voltages_has_room_even_for_a_single_one():
    assert voltage_range(3000.0, 3000.0) == pytest.approx((2880.0, 3120.0))
    low, high = voltage_range(2000.0, 4000.0)
    assert low < 2000.0
    assert high > 4000.0


def test_all_devices_have_a_line_and_substations_keep_their_names_first(axes, no_overlap):
    axes.set_xlim(0.0, 100.0)
    devices = [(10.0 * k, f"Substation {k}" if k % 2 == 0 else f"Cabin {k}", k % 2 == 0) for k in range(11)]
    mark_devices(axes, devices, 7.0)
    assert sorted({float(line.get_xdata()[0]) for line in axes.lines}) == [place for place, _, _ in devices]
    signs = [text for text in axes.texts if text.get_text() in "▲■"]
    names = [text for text in axes.texts if text not in signs]
    assert [text.get_text() for text in signs] == ["▲", "■"] * 5 + ["▲"]
    assert len(names) >= 4
    assert all(text.get_text().startswith("Substation") for text in names)
    no_overlap(axes.figure, axes.texts)


def test_devices_on_top_of_each_other_share_a_sign(axes, no_overlap):
    axes.set_xlim(0.0, 100.0)
    mark_devices(axes, [(50.0, "A", True), (50.1, "C", False), (90.0, "B", True)], 7.0)
    assert [text.get_text() for text in axes.texts] == ["▲", "A", "▲", "B"]
    no_overlap(axes.figure, axes.texts)


@pytest.mark.parametrize(("end", "label"), [(7200.0, "time of day [h:min]"), (45.0, "time of day [h:min:s]")])
def test_a_clock_says_whether_it_has_seconds(axes, end, label):
    set_clock(axes, 0.0, end)
    assert clock_label(axes) == label


def test_names_of_near_limits_do_not_overlap(no_overlap):
    figure = new_figure(6.0, 2.5)
    axes = figure.add_subplot()
    axes.set_ylim(-200.0, 4500.0)
    draw_limits(axes, make_scenario())
    assert len(axes.texts) == 4
    no_overlap(figure, axes.texts)


def test_a_range_with_a_dead_line_begins_little_below_zero():
    low, high = voltage_range(0.0, 3600.0)
    assert -300.0 < low < 0.0
    assert high > 3600.0

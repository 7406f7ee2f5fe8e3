"""Names of substations, cabins and stations along the kilometres of a line."""

import matplotlib as mpl
import pytest

from tractionpower.reporting.figures.base.style import PAGE, STYLE, new_figure
from tractionpower.reporting.figures.supply.km_axis import levels, name_devices, name_stations


@pytest.fixture
def axes():
    with mpl.rc_context(STYLE):
        axes = new_figure(PAGE, 3.0).add_subplot()
        axes.set_xlim(0.0, 100.0)
        return axes


def names(axes):
    return [text for text in axes.texts if text.get_text() not in "▲■"]


def test_names_that_do_not_fit_in_one_row_stand_in_two(axes, no_overlap):
    name_devices(axes, [(8.0 * k, f"Substation {k}", True) for k in range(1, 12)], PAGE - 1.0)
    assert [text.get_text() for text in names(axes)] == [f"Substation {k}" for k in range(1, 12)]
    no_overlap(axes.figure, names(axes))


def test_cabins_are_named_only_if_there_is_room_for_all():
    assert levels([0.0, 1.0, 2.0], [0.9, 0.9, 0.9], [True, False, True]) == {0: 0, 1: 0, 2: 0}
    crowded = levels([0.0, 0.1, 0.2, 2.0], [0.9] * 4, [True, False, False, True])
    assert crowded == {0: 0, 3: 0}


def test_names_of_hundreds_of_letters_are_cut(axes, no_overlap):
    name_devices(axes, [(30.0, "X" * 300, True), (70.0, "=cmd()$", True)], PAGE - 1.0)
    no_overlap(axes.figure, names(axes))
    assert "=cmd()$" in [text.get_text() for text in names(axes)]


def test_many_stations_stand_upright_and_apart(axes, no_overlap):
    name_stations(axes, [(3.0 * k, f"Station {k}") for k in range(30)], PAGE - 1.0)
    (below,) = axes.child_axes
    axes.figure.canvas.draw()
    labels = below.get_xticklabels()
    assert len(labels) > 20
    assert all(label.get_rotation() == 90.0 for label in labels)
    no_overlap(axes.figure, [*labels, below.xaxis.label])


def test_few_stations_stand_level(axes, no_overlap):
    name_stations(axes, [(10.0, "Alfa"), (90.0, "Beta"), (300.0, "elsewhere")], PAGE - 1.0)
    (below,) = axes.child_axes
    axes.figure.canvas.draw()
    assert [label.get_text() for label in below.get_xticklabels()] == ["Alfa", "Beta"]
    assert [label.get_rotation() for label in below.get_xticklabels()] == [0.0, 0.0]
    no_overlap(axes.figure, [*below.get_xticklabels(), below.xaxis.label])

"""Pieces of track and what lies along them."""

import numpy as np
import pytest

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.polyline import Polyline
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.errors import UsageError

L_SHAPED = Polyline("l", ((0.0, 0.0), (30.0, 0.0), (30.0, 40.0)))


def resistance_at(core, route, places):
    """Return the resistance of the track [N/kN] at places on a route."""
    rows = core._data.along(route)
    index = np.searchsorted(rows["from_m"], places, side="right") - 1
    return [1e3 * rows["track_n_per_n"][k] if k >= 0 else 0.0 for k in index]


def test_lengths_and_points():
    assert L_SHAPED.length_m == 70.0
    assert [L_SHAPED.point(at) for at in (-5.0, 15.0, 50.0, 99.0)] == [(0.0, 0.0), (15.0, 0.0), (30.0, 20.0), (30.0, 40.0)]
    assert L_SHAPED.reversed.point(20.0) == (30.0, 20.0)
    drawn = Polyline("schematic", ((0.0, 0.0), (10.0, 0.0)), 2000.0)
    assert (drawn.length_m, drawn.point(1000.0)) == (2000.0, (5.0, 0.0))


def test_what_has_no_length_is_refused():
    for points, length in ((((0.0, 0.0),), 5.0), (((1.0, 1.0), (1.0, 1.0)), 0.0), (((0.0, 0.0), (1.0, 0.0)), -3.0)):
        with pytest.raises(UsageError, match="length"):
            Polyline("x", points, length)


def test_data_of_pieces_lie_along_a_route():
    core = TrainDynamics()
    first, second = Polyline.straight("first", 1000.0), Polyline.straight("second", 500.0)
    core.add_arc([first, second], 300.0)
    core.add_inclination(first, 10.0, between_m=(200.0, 400.0))
    core.add_tunnel(second, 2, between_m=(100.0, 500.0))
    arc = 650.0 / 245.0
    found = resistance_at(core, (first, second), [-1.0, 0.0, 199.0, 200.0, 399.0, 400.0, 1050.0, 1100.0, 1499.0, 1500.0])
    assert found == pytest.approx([0.0, arc, arc, arc + 10.0, arc + 10.0, arc, arc, arc + 1.0, arc + 1.0, 0.0], abs=1e-12)


def test_the_other_way_round_gradients_fall_and_arcs_stay():
    core = TrainDynamics()
    piece = Polyline.straight("p", 1000.0)
    core.add_inclination(piece, 10.0, between_m=(0.0, 300.0))
    core.add_inclination(piece.reversed, 4.0, between_m=(0.0, 100.0))  # = falls by 4 permille from 900 m to 1000 m
    core.add_arc(piece.reversed, 250.0, between_m=(600.0, 700.0))  # = 300 m to 400 m
    arc = 500.0 / 220.0
    assert resistance_at(core, (piece,), [100.0, 350.0, 950.0]) == pytest.approx([10.0, arc, -4.0])
    assert resistance_at(core, (piece.reversed,), [50.0, 650.0, 900.0]) == pytest.approx([4.0, arc, -10.0])


def test_roeckl_and_other_laws():
    piece = Polyline.straight("p", 10.0)
    for law, radius, n_per_kn in ((None, 300.0, 650 / 245), (None, 299.0, 500 / 269), ((700.0, 0.0), 500.0, 1.4)):
        core = TrainDynamics(arc_law=law)
        core.add_arc(piece, radius)
        assert resistance_at(core, (piece,), [5.0]) == pytest.approx([n_per_kn])


def test_where_a_train_is():
    a, b = Polyline.straight("a", 100.0), Polyline.straight("b", 50.0)
    assert DynTrain("x", route=(a, b), place_m=120.0).location == (b, 20.0)
    assert DynTrain("x", route=(a, b), place_m=170.0).location == (b, 70.0)
    assert DynTrain("x", place_m=5.0).location == (None, 5.0)
    train = DynTrain("x", route=(a,), place_m=120.0)
    train.extend_route(b)
    assert (train.location, train.route_m) == ((b, 20.0), 150.0)


@pytest.mark.parametrize("given", ["x", 3, None, [Polyline.straight("a", 100.0), "b"]])
def test_what_is_no_polyline_is_refused_before_anything_is_added(given):
    core = TrainDynamics()
    for add in (lambda: core.add_arc(given, 300.0), lambda: core.add_inclination(given, 5.0), lambda: core.add_tunnel(given)):
        with pytest.raises(UsageError, match="allowed: a Polyline"):
            add()
    assert resistance_at(core, (Polyline.straight("a", 100.0),), [50.0]) == pytest.approx([0.0])


def test_of_several_polylines_none_is_added_where_one_is_too_short():
    long, short = Polyline.straight("a", 100.0), Polyline.straight("b", 10.0)
    core = TrainDynamics()
    with pytest.raises(UsageError, match="is not on 'b'"):
        core.add_arc([long, short], 300.0, between_m=(0.0, 50.0))
    assert resistance_at(core, (long,), [25.0]) == pytest.approx([0.0])

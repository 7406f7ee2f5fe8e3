"""Where a train at constant acceleration meets its ceiling: against a scan of its way in fine steps."""

import numpy as np
import pytest
from small_trains import Stepper, call, make_trains

from tractionpower.kernels.ceiling import meet_ceiling, time_of
from tractionpower.kernels.jit import njit

LIMITS = [(-1.0, 1.0, 72.0), (1.0, 1.2, 108.0), (1.2, 4.0, 54.0)]


@njit
def meet(tables, train, mover, acceleration, way):
    rows = (train.first_piece + mover.piece, train.first_piece + train.pieces - 1)
    return meet_ceiling(tables, train, mover, rows, acceleration, way)


@njit
def seconds(distance, v, speed):
    return time_of(distance, v, speed)


def ceiling(pieces, s):
    piece = pieces[np.searchsorted(pieces["from_m"], s, side="right") - 1]
    return piece["w"] + piece["dw"] * (s - piece["from_m"])


@pytest.mark.parametrize("seed", range(30))
def test_the_way_ends_where_a_scan_meets_the_ceiling(seed):
    rng = np.random.default_rng(seed)
    stepper = Stepper(make_trains(3.0, limits=LIMITS, stations={"Z": 2.0}, calls=[call("Z")], length_m=50.0))
    tables, train, mover = stepper.tables, stepper.tables.trains[0], stepper.state.movers[0]
    pieces = tables.pieces
    mover["s_m"] = rng.uniform(0.0, 1900.0)
    mover["v_mps"] = rng.uniform(0.2, 0.98) * np.sqrt(ceiling(pieces, mover["s_m"]))
    s, v, a = float(mover["s_m"]), float(mover["v_mps"]), float(rng.uniform(-0.4, 1.0))
    mover["piece"] = np.searchsorted(pieces["from_m"], s, side="right") - 1
    time = rng.uniform(0.5, 40.0)
    time = min(time, -v / a) if a < 0.0 else time
    distance, spent, speed = meet(tables, train, mover, a, (v * time + 0.5 * a * time**2, time, v + a * time))
    t = np.linspace(0.0, time, 200001)
    place = s + v * t + 0.5 * a * t**2
    above = (v + a * t) ** 2 > ceiling(pieces, np.minimum(place, 1999.9999)) + 1e-9
    end = t[np.argmax(above)] if above.any() else time
    assert spent == pytest.approx(end, abs=2.0 * time / 200000.0 + 1e-6)
    assert distance == pytest.approx(v * spent + 0.5 * a * spent**2, abs=1e-6)
    assert speed == pytest.approx(v + a * spent, abs=1e-6)


def test_the_time_of_a_way_between_two_speeds():
    assert seconds(30.0, 10.0, 20.0) == 2.0
    assert seconds(0.0, 0.0, 0.0) == 0.0

"""Theoretical journeys: calls, status, chosen runs."""

import numpy as np
import pytest
from small_trains import call, make_run, make_trains, passing, run

from tractionpower.movement.journey import theoretical_journeys


def test_calls_with_planned_and_computed_times():
    stations = {"A": 0.0, "B": 2.0, "P": 3.0, "C": 5.0}
    calls = [call("A", departure=60.0), call("B", arrival=200.0, departure=400.0), passing("P", arrival=450.0), call("C")]
    found = run(5.0, stations=stations, calls=calls, time=0.0)
    assert [(one.station, one.kind, one.at_m) for one in found.calls] == [
        ("A", "stop", 0.0), ("B", "stop", 2000.0), ("P", "pass", 3000.0), ("C", "stop", 5000.0),
    ]  # fmt: skip
    assert [(one.planned_arrival_s, one.planned_departure_s) for one in found.calls] == [
        (None, 60.0), (200.0, 400.0), (450.0, None), (None, None),
    ]  # fmt: skip
    a, b, p, c = found.calls
    assert (a.arrival_s, a.departure_s, b.departure_s) == (0.0, 60.0, 400.0)
    assert 60.0 < b.arrival_s < 400.0 < p.arrival_s == p.departure_s < c.arrival_s == found.finished_s


def test_a_train_that_does_not_arrive():
    found = run(5.0, stations={"C": 5.0}, calls=[call("C")], slopes=[(-1.0, 6.0, 0.0)], voltage_v=1500.0)
    assert found.status == "stuck"
    assert np.isnan(found.calls[0].arrival_s)


def test_rows_cover_the_time_on_the_line():
    found = run(5.0, step_s=0.7, time=100.0, end="stop")
    np.testing.assert_allclose(found.rows["time_s"], 100.0 + 0.7 * np.arange(len(found.rows)), rtol=1e-12)
    assert found.seconds.sum() == pytest.approx(found.end_s - 100.0)
    assert found.end_s - 0.7 <= found.finished_s <= found.end_s
    assert (found.end_m, found.end_mps) == (5000.0, pytest.approx(0.0, abs=2e-3))


def test_step_and_voltage_by_default():
    found = run(3.0, clock={"step_s": 0.5})
    assert np.diff(found.rows["time_s"]) == pytest.approx(0.5)
    assert (found.rows["voltage_v"] == 3000.0).all()


@pytest.mark.parametrize("form", ["time", "speed"])
def test_ledgers_close(form):
    line = {"slopes": [(-1.0, 2.0, 8.0), (2.0, 9.0, -12.0)], "stations": {"A": 4.0, "Z": 8.0}, "limits": [(-1.0, 9.0, 110.0)]}
    found = run(8.0, form=form, calls=[call("A", min_dwell_s=10.0), call("Z")], rotating_mass_factor=1.1, **line,
                resistance={"a_n": 2000.0, "c_n_per_kmh2": 0.7}, auxiliaries={"power_kw": 80.0})  # fmt: skip
    for ledger in found.ledgers().values():
        assert ledger.closes
    assert found.ledgers()["mechanical"].energy_j["potential"] == pytest.approx(-200e3 * 9.80665 * 56.0 + 0.0, rel=0.02)


def test_chosen_runs_and_their_order():
    runs = [make_run(name, 3.0, time=60.0 * k) for k, name in enumerate(["c", "a", "b"])]
    scenario = make_trains(3.0, runs=runs)
    assert [found.run.id for found in theoretical_journeys(scenario)] == ["a", "b", "c"]
    (one,) = theoretical_journeys(scenario, runs=["c"])
    assert (one.run.id, one.start_s) == ("c", 0.0)


def test_every_run_may_have_a_voltage_of_its_own():
    scenario = make_trains(5.0, runs=[make_run("x", 5.0), make_run("y", 5.0), make_run("z", 5.0)])
    voltages = {"x": 2500.0, "y": [(0.0, 3000.0), (2000.0, 2000.0)]}
    x, y, z = theoretical_journeys(scenario, voltage_v=voltages)
    assert (x.rows["voltage_v"] == 2500.0).all()
    assert (z.rows["voltage_v"] == 3000.0).all()
    np.testing.assert_allclose(y.rows["voltage_v"], np.interp(y.rows["s_m"], [0.0, 2000.0], [3000.0, 2000.0]))

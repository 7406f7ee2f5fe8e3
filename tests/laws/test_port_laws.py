"""What a train takes over the voltage, once it has chosen what it wishes: continuous, bounded, nothing out of nothing."""

import numpy as np
import pytest
from random_trains import random_study
from small_trains import BRAKE, SERIES_MOTORS, TABLE, Stepper, make_trains, run

from tractionpower.kernels.demand import demand_current
from tractionpower.kernels.jit import njit
from tractionpower.kernels.pantograph import feed_back_share
from tractionpower.kernels.train_step import wish

VOLTAGES = np.linspace(200.0, 4200.0, 8001)


@njit
def take(tables, state, t, h, voltages, currents):
    wish(tables, state, 0, t, h)
    train, trial, tally = tables.trains[0], state.trials[0], state.wishes[0]
    if tally.moving_s <= 0.0:
        return 0.0
    for n in range(voltages.shape[0]):
        currents[n], _ = demand_current(tables, train, trial, state.demands[0], voltages[n])
    return state.demands[0].need_w


@pytest.mark.parametrize("first", [0, 8, 16, 24])
def test_the_current_is_continuous_in_the_voltage(first):
    for seed in range(first, first + 8):
        stepper = Stepper(random_study(seed))
        voltage = 2300.0 + 150.0 * (seed % 8)
        for _ in range(200):
            currents = np.zeros(len(VOLTAGES))
            if take(stepper.tables, stepper.state, stepper.time_s, 1.0, VOLTAGES, currents) > 0.0:
                # Half a volt moves the steepest knee and natural curve by some amperes; a notch that changed, by a hundred.
                slopes = np.abs(np.diff(currents)) / 0.5
                k = int(slopes.argmax())
                assert slopes[k] < 40.0, (seed, stepper.time_s, VOLTAGES[k], currents[k : k + 2])
                assert np.all(np.isfinite(currents))
            stepper.step(voltage)
            if stepper.gone:
                break


@njit
def share_of(tables, u):
    return feed_back_share(tables.trains[0], u)


def test_a_dead_line_takes_nothing_back():
    stepper = Stepper(make_trains(20.0, brake=BRAKE, speed_kmh=144.0, auxiliaries={"power_kw": 50.0}))
    assert [share_of(stepper.tables, u) for u in (2000.0, 3600.0, 3750.0, 3900.0)] == [1.0, 1.0, 0.5, 0.0]
    stop = {"stations": {"Z": 3.0}, "calls": [{"station": "Z"}], "speed_kmh": 90.0}
    for voltage in (0.0, -50.0):
        rows = run(3.0, brake=BRAKE, voltage_v=voltage, limits=[(-1.0, 4.0, 90.0)], drive=None if voltage else TABLE, **stop).rows
        assert not rows["recovered_w"].any()
        assert not rows["power_w"].any()


def test_a_table_takes_no_power_from_a_collapsed_line():
    for voltage, most in ((1000.0, 0.25), (500.0, 0.0625), (50.0, 0.000625)):
        row = Stepper(make_trains(20.0, drive=TABLE, speed_kmh=72.0)).step(voltage)
        whole = Stepper(make_trains(20.0, drive=TABLE, speed_kmh=72.0)).step(2000.0)
        assert row["power_w"] == pytest.approx(most * whole["power_w"], rel=0.02)


def test_a_further_grouping_makes_no_train_slower_or_thirstier():
    limited = SERIES_MOTORS | {"max_current_a": 360.0}
    single = limited | {"groupings": SERIES_MOTORS["groupings"][:1]}
    both, one = (run(3.0, drive=drive, limits=[(-1.0, 4.0, 50.0)]) for drive in (limited, single))
    assert both.finished_s <= one.finished_s + 0.5
    energies = [float(found.seconds @ found.rows["power_w"]) for found in (both, one)]
    assert energies[0] <= 1.05 * energies[1]


@pytest.mark.parametrize("form", ["time", "speed"])
def test_the_relay_opens_in_both_forms(form):
    drive = SERIES_MOTORS | {"relay": {"off_v": 2000.0, "on_v": 2300.0, "delay_s": 1.0}}
    found = run(5.0, drive=drive, voltage_v=1900.0, form=form, resistance={"a_n": 2e3})
    assert found.status == "stuck"
    dip = run(
        5.0,
        drive=drive,
        form=form,
        voltage_v=[(0.0, 3000.0), (1000.0, 3000.0), (1001.0, 1900.0), (2700.0, 1900.0), (2701.0, 3000.0)],
    )
    assert dip.finished_s == pytest.approx(
        run(
            5.0,
            drive=drive,
            step_s=0.1,
            voltage_v=[(0.0, 3000.0), (1000.0, 3000.0), (1001.0, 1900.0), (2700.0, 1900.0), (2701.0, 3000.0)],
        ).finished_s,
        rel=0.01,
    )


@pytest.mark.parametrize("h", [1.0, 5.0])
def test_no_time_is_lost_on_a_line_with_a_slope_every_metre(h):
    slopes = [(k / 1000.0, (k + 1) / 1000.0, float(k % 7 - 3)) for k in range(-1000, 4000)]
    stop = {"stations": {"Z": 3.0}, "calls": [{"station": "Z"}]}
    stepper = Stepper(make_trains(3.0, slopes=slopes, limits=[(-1.0, 4.0, 120.0)], **stop))
    while not stepper.gone:
        stepper.step(3000.0, h)
        if not stepper.gone:
            assert stepper.state.done[0]["on_line_s"] == pytest.approx(h, abs=1e-9)
    assert stepper.mover["finished_s"] == pytest.approx(
        run(3.0, limits=[(-1.0, 4.0, 120.0)], step_s=0.1, **stop).finished_s, rel=0.02
    )


def test_an_effort_that_rises_with_the_speed_moves_a_train_at_any_step():
    table = {
        "kind": "table",
        "effort": [{"speed_kmh": v, "effort_kn": f} for v, f in ((0.0, 50.0), (5.0, 200.0), (160.0, 20.0))],
        "current": [{"speed_kmh": v, "current_a": i} for v, i in ((0.0, 50.0), (5.0, 200.0), (160.0, 400.0))],
    }
    for h in (0.5, 2.0, 4.0, 5.0):
        assert run(2.0, drive=table, resistance={"a_n": 2e3}, step_s=h).status == "complete"

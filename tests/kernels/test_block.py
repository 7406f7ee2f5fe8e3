"""The clock of the block: what a step has to cut is asked for again in the next one."""

import numpy as np
import pytest
from coupled import advanced, couple, run
from small_studies import load, make_scenario, run_in_memory

from tractionpower.kernels.network import NOT_SERVABLE


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_a_load_that_cannot_be_served_while_trains_run(kind):
    huge = {"id": "x", "track": "1", "km": 10.0, "power_kw": 26000.0, "limits": "none", "from": 40.0, "to": 60.0}
    scenario = couple(run("E", kind), run("F", kind, track="2", low=20.0, high=0.0), loads=[huge], end_s=120.0)
    results, _, _ = run_in_memory(scenario)
    rows = results.table("trains")
    assert results.run["status"] == "flagged"
    events = results.table("events").query("kind == 'not_servable'")
    assert results.run["flagged_steps"] == 20
    assert set(events["subject"]) == {"x"}
    assert events["time_s"].min() == 40.0
    assert all(ledger["closes"] for ledger in results.run["ledgers"].values())
    np.testing.assert_allclose(rows["power_kw"], rows["voltage_v"] * rows["current_a"] / 1e3, rtol=1e-5, atol=1e-3)
    taken = rows["auxiliary_power_kw"] + rows["starting_resistor_kw"] + rows["drive_loss_kw"] + rows["wheel_power_kw"]
    np.testing.assert_allclose(rows["power_kw"], taken, rtol=1e-4, atol=0.05)
    calm = rows[(rows["time_s"] < 40.0) | (rows["time_s"] >= 60.0)]
    assert (calm["auxiliary_power_kw"] > 60.0).all()  # served in full before and after
    cut_short = rows[(rows["time_s"] >= 40.0) & (rows["time_s"] < 60.0)]
    assert cut_short["auxiliary_power_kw"].min() < 60.0


def test_the_demand_is_cut_anew_in_every_step():
    """Two seconds of 26 MW that cannot be are not 26 MW that can, though what is left of them after a cut could be served."""
    huge = {"id": "x", "track": "1", "km": 10.0, "power_kw": 26000.0, "limits": "none", "from": 3.0, "to": 13.0}
    done = advanced(couple(run("E"), loads=[huge], end_s=20.0))
    steps, power = done.buffers.steps, done.buffers.load_v[:, 0] * done.buffers.load_a[:, 0]
    assert (steps["status"][3:13] == NOT_SERVABLE).all()
    assert (steps["status"][:3] == 0).all()
    assert (steps["status"][13:] == 0).all()
    np.testing.assert_allclose(power[3:13], steps["factor"][3:13] * 26e6, rtol=1e-6)
    assert np.ptp(steps["factor"][3:13]) < 0.02  # the train is light beside it


# --- profiles of loads


PROFILE = [(3.0, 2000.0), (5.0, 9000.0), (6.0, 0.0), (8.0, 4500.0), (11.0, 4500.0)]


def profile_of(rows, kind="power_kw"):
    return [{"time": time, kind: value} for time, value in rows]


@pytest.mark.parametrize("kind", ["power_kw", "current_a"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_profile_is_the_loads_of_its_rows_one_after_the_other(kind, sign):
    rows = [(time, sign * value / (3.0 if kind == "current_a" else 1.0)) for time, value in PROFILE]
    place = {"id": "x", "track": "1", "km": 7.0, kind: None}
    steady = load("base", 3.0, "2", power_kw=8000.0)
    whole = advanced(make_scenario(steady, place | {"profile": profile_of(rows, kind), "to": 14.0}, clock={"end": 20.0}))
    buffers, at = whole.buffers, np.searchsorted([time for time, _ in rows], np.arange(20.0), side="right") - 1
    for step in range(20):
        value = rows[at[step]][1] if at[step] >= 0 and step < 14 else 0.0
        alone = advanced(make_scenario(steady, place | {kind: value}, clock={"end": 1.0}))
        np.testing.assert_allclose(buffers.load_v[step], alone.buffers.load_v[0], atol=1e-3)
        np.testing.assert_allclose(buffers.load_a[step], alone.buffers.load_a[0], atol=1e-3)
    assert whole.buffers.steps["iterations"].nonzero()[0].tolist() == [0, 3, 5, 6, 8, 14]  # solved when something changes


def test_a_row_of_a_profile_that_cannot_be_served_is_cut_like_a_load_of_its_value():
    rows = [(0.0, 3000.0), (2.0, 26000.0), (4.0, 30000.0), (6.0, 3000.0)]
    other = load("y", 14.0, "2", power_kw=1000.0)
    place = {"id": "x", "track": "1", "km": 10.0, "limits": "none", "power_kw": None}
    done = advanced(make_scenario(place | {"profile": profile_of(rows)}, other, clock={"end": 8.0})).buffers
    assert done.steps["status"].tolist() == [0, 0, *[NOT_SERVABLE] * 4, 0, 0]
    for step, value in ((2, 26000.0), (3, 26000.0), (4, 30000.0), (6, 3000.0)):
        alone = advanced(make_scenario(place | {"power_kw": value}, other, clock={"end": 1.0})).buffers
        assert done.steps["factor"][step] == pytest.approx(alone.steps["factor"][0], rel=1e-5)
        power = done.load_v[step] * done.load_a[step]
        np.testing.assert_allclose(power, alone.load_v[0] * alone.load_a[0], rtol=1e-4)


def test_times_of_a_profile_are_met_whatever_the_rounding_of_the_clock():
    """0.1 s steps from 21600 s on: start + k step is rounded, a row at 21600.3 s holds from the third step on."""
    rows = [(21600.0, 100.0), (21600.3, 200.0), (21600.7, 300.0)]
    clock = {"start": 21600.0, "end": 21601.0, "step_s": 0.1}
    done = advanced(make_scenario({"id": "x", "track": "1", "km": 5.0, "profile": profile_of(rows)}, clock=clock)).buffers
    power = done.load_v[:, 0] * done.load_a[:, 0]
    np.testing.assert_allclose(power / 1e3, [100.0] * 3 + [200.0] * 4 + [300.0] * 3, rtol=1e-6)


def test_many_rows_pass_within_one_step():
    rows = [(0.001 * k, 1.0 + k % 7) for k in range(20_000)]
    done = advanced(make_scenario({"id": "x", "track": "1", "km": 5.0, "profile": profile_of(rows)}, clock={"end": 30.0})).buffers
    power = done.load_v[:, 0] * done.load_a[:, 0] / 1e3
    np.testing.assert_allclose(power[:20], [1.0 + (1000 * step) % 7 for step in range(20)], rtol=1e-5)
    np.testing.assert_allclose(power[20:], 1.0 + 19_999 % 7, rtol=1e-5)

"""The clock of the block: what a step has to cut is asked for again in the next one."""

import numpy as np
import pytest
from coupled import advanced, couple, run
from small_studies import run_in_memory

from tractionpower.kernels.network import NOT_SERVABLE


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_a_load_that_cannot_be_served_while_trains_run(kind):
    load = {"id": "x", "track": "1", "km": 10.0, "power_kw": 26000.0, "limits": "none", "from": 40.0, "to": 60.0}
    scenario = couple(run("E", kind), run("F", kind, track="2", low=20.0, high=0.0), loads=[load], end_s=120.0)
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
    load = {"id": "x", "track": "1", "km": 10.0, "power_kw": 26000.0, "limits": "none", "from": 3.0, "to": 13.0}
    done = advanced(couple(run("E"), loads=[load], end_s=20.0))
    steps, power = done.buffers.steps, done.buffers.load_v[:, 0] * done.buffers.load_a[:, 0]
    assert (steps["status"][3:13] == NOT_SERVABLE).all()
    assert (steps["status"][:3] == 0).all()
    assert (steps["status"][13:] == 0).all()
    np.testing.assert_allclose(power[3:13], steps["factor"][3:13] * 26e6, rtol=1e-6)
    assert np.ptp(steps["factor"][3:13]) < 0.02  # the train is light beside it

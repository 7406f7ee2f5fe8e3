import re

import numpy as np
import pytest
from chains import AT_ONCE, LOCOMOTIVE, WAGON, WEDGE, free, make_chain, pulled, spring

from tractionpower.dynamics.driven import DrivenSession
from tractionpower.dynamics.session import NotComputableError, Session
from tractionpower.errors import UsageError

BRAKE = {"brake_ratio": 0.6}


def started(**more):
    commands = [{"time_s": 0.0, "drive": 1}, {"time_s": 4.0, "drive": 0, "brake": 10}]
    return pulled(4, WEDGE, commands=commands, brake=BRAKE, run={"duration_s": 30.0}, **more)


def test_rows_come_at_their_interval_up_to_the_end():
    session = Session(started())
    assert session.advance(1e9) == "ended" and session.has_ended
    rows = session.take_rows()
    assert rows.chain["time_s"] == pytest.approx(np.arange(0.0, 30.0001, 0.05), abs=1e-9)
    assert rows.vehicles.shape == (601, 5) and rows.links.shape == (601, 4)
    assert len(session.take_rows().chain) == 0


def test_rows_do_not_depend_on_how_often_they_are_taken():
    whole, parts = Session(started()), Session(started())
    whole.advance(1e9)
    taken = []
    for until in np.arange(0.0, 31.0, 0.7):
        parts.advance(until)
        taken.append(parts.take_rows())
    rows = whole.take_rows()
    for name in ("chain", "vehicles", "links", "turns"):
        assert np.array_equal(np.concatenate([getattr(part, name) for part in taken]), getattr(rows, name))


def test_commands_between_steps_are_met():
    commands = [{"time_s": 0.0, "drive": 1}, {"time_s": 1.00137, "drive": 0}]
    session = Session(free([80.0], spring(10.0), commands=commands, run={"duration_s": 5.0, "step_s": 0.01}))
    session.advance(2.0)
    assert session.steps == 201  # one of them cut in two
    assert session.time_s == pytest.approx(2.0)


def test_a_driver_takes_over_from_the_commands():
    scenario = started()
    played, driven = Session(scenario), DrivenSession(scenario)
    played.advance(6.0)
    driven.advance(4.0)
    driven.set(drive=0, brake=10)
    driven.advance(6.0)
    assert np.array_equal(driven.state.movers["v_mps"], played.state.movers["v_mps"])
    assert driven.snapshot()["brake"] == 10 and driven.snapshot()["drive"] == 0


def test_a_second_setting_at_the_same_time_replaces_the_first():
    driven = DrivenSession(started())
    driven.set(drive=0, brake=15)
    driven.set(drive=1, brake=0)
    driven.advance(3.0)
    straight = Session(started())
    straight.advance(3.0)
    assert driven.state.movers["v_mps"] == pytest.approx(straight.state.movers["v_mps"])


def test_two_controls_set_at_the_same_time_both_hold():
    driven = DrivenSession(started())
    driven.advance(1.0)
    driven.set(brake=5)
    driven.set(drive=0)
    driven.set(electric=4)
    driven.advance(2.0)
    now = driven.snapshot()
    assert (now["drive"], now["brake"], now["electric_percent"]) == (0, 5, 50.0)


@pytest.mark.parametrize(
    ("setting", "told"),
    [
        ({"brake": "emergancy"}, "brake: there is no 'emergancy'; it takes 0 to 15, charge"),
        ({"brake": "unchanged"}, "brake: there is no 'unchanged'"),
        ({"brake": 16}, "brake: 16 is not from 0 to 15"),
        ({"drive": -3, "electric": 9.0}, "drive: -3 is not from 0 to 1; electric: 9 is not from 0 to 8"),
        ({"independent_bar": float("nan")}, "independent_bar: nan is not from 0 to 15"),
    ],
)
def test_a_control_that_the_case_does_not_have_is_refused(setting, told):
    driven = DrivenSession(started())
    driven.set(brake="emergency")
    driven.advance(2.0)
    with pytest.raises(UsageError, match=re.escape(told)):
        driven.set(**setting)
    driven.advance(4.0)
    assert driven.snapshot()["brake"] == 16 and driven.snapshot()["pipe_bar"] < 0.1


def test_many_settings_find_room():
    driven = DrivenSession(started())
    for k in range(200):
        driven.set(drive=k % 2, brake=k % 7, electric=k % 3, independent_bar=0.01 * k)
        driven.advance(0.01 * (k + 1))
    assert driven.snapshot()["independent_bar"] == pytest.approx(1.99) and driven.snapshot()["brake"] == 199 % 7
    assert driven.snapshot()["drive"] == 1


def test_a_driven_train_does_not_end_by_its_time():
    driven = DrivenSession(started())
    assert driven.advance(100.0) == "done" and driven.time_s == pytest.approx(100.0)


def test_emergency_empties_the_pipe():
    driven = DrivenSession(started())
    driven.set(brake="emergency")
    driven.advance(20.0)
    now = driven.snapshot()
    assert now["brake"] == 16 and now["pipe_bar"] == pytest.approx(0.0, abs=1e-6) and now["speed_kmh"] == 0.0


def test_a_snapshot_tells_the_forces_of_a_steady_pull():
    scenario = make_chain(
        [{"id": "loco"}, {"id": "wagon", "count": 3}], spring(10.0, damping_kns_per_m=600.0), (LOCOMOTIVE, WAGON),
        traction=AT_ONCE, commands=[{"time_s": 0.0, "drive": 1}],
    )  # fmt: skip
    session = Session(scenario)
    session.advance(60.0)
    now = session.snapshot()
    assert now["forces_kn"] == pytest.approx([150.0, 100.0, 50.0], rel=1e-6)
    assert now["first_coupling_kn"] == now["forces_kn"][0] and now["tractive_force_kn"] == pytest.approx(200.0)
    assert now["acceleration_mps2"] == pytest.approx(200.0 / 320.0, rel=1e-6)
    assert now["speed_kmh"] == pytest.approx(3.6 * 60.0 * 200.0 / 320.0, rel=1e-3)


def test_statistics_add_up_and_count_the_cycles_of_the_first_coupling():
    driven = DrivenSession(started())
    driven.advance(4.0)
    driven.set(drive=0, brake=12)
    driven.advance(25.0)
    found = driven.statistics()
    for name in ("drive_speed", "brake_speed", "force", "acceleration"):
        assert found[name].sum() == pytest.approx(1.0)
    assert found["drive_speed"][1].sum() == pytest.approx(4.0 / 25.0)
    assert found["brake_speed"][12].sum() == pytest.approx(21.0 / 25.0)
    index = sum(count * (range_kn / 100.0) ** 3 for range_kn, _, count in found["rainflow"])
    # the index is that of the exact ranges, the cycles are told by classes
    assert index > 0.0 and driven.snapshot()["damage_index"] == pytest.approx(index, rel=0.05)


def test_what_cannot_be_computed_on_is_said_and_kept():
    run = {"step_s": 0.1, "duration_s": 100.0, "record_every_s": 0.1}
    session = Session(free([20.0] * 3, spring(100.0), run=run))
    session.state.movers["v_mps"] = [0.1, -0.1, 0.1]
    with pytest.raises(NotComputableError, match="no number"):
        session.advance(100.0)
    assert len(session.take_rows().chain) > 1


def test_a_state_can_be_gone_back_to():
    session = Session(started())
    session.advance(5.0)
    kept = session.copy()
    session.advance(9.0)
    speeds = session.state.movers["v_mps"].copy()
    session.restore(kept)
    assert session.time_s == pytest.approx(5.0)
    session.advance(9.0)
    assert np.array_equal(session.state.movers["v_mps"], speeds)


def test_one_vehicle_alone_is_a_train():
    session = Session(free([80.0], spring(10.0), start={"speed_kmh": 36.0}, run={"duration_s": 3.0}))
    session.advance(1e9)
    assert session.snapshot()["position_m"] == pytest.approx(30.0) and session.snapshot()["forces_kn"] == []


@pytest.mark.parametrize(("couplings", "stretch"), [("centred", 0.0), ("stretched", 0.015), ("bunched", -0.015)])
def test_a_train_starts_where_its_couplings_are_in_their_slack(couplings, stretch):
    session = Session(pulled(3, WEDGE, start={"couplings": couplings}))
    assert session.state.links["stretch_m"] == pytest.approx([stretch] * 3)
    assert np.diff(session.state.movers["s_m"]) == pytest.approx([-15.0 - stretch] * 3)
    session.advance(0.0)
    assert session.snapshot()["forces_kn"] == pytest.approx([0.0] * 3, abs=1e-9)

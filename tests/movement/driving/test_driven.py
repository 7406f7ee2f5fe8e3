"""Trains driven by rules: closed forms of coasting and cruising, lateness, and caps."""

import numpy as np
import pytest
from small_trains import (
    BRAKE,
    INVERTER,
    SERIES_MOTORS,
    Stepper,
    call,
    energy_kwh,
    journey,
    make_run,
    make_trains,
    passing,
    run,
)

from tractionpower.kernels.train_tables import COASTING, CRUISING
from tractionpower.movement.driving import plan_runs
from tractionpower.movement.driving.driven import compile_driven
from tractionpower.movement.journey import theoretical_journeys

LIMIT = {"limits": [(-1.0, 40.0, 144.0)]}
STOPS = {"stations": {"A": 0.0, "B": 20.0}, "end": "stop"}
AT_5 = {"stations": {"A": 0.0, "B": 5.0}}
CALLS = [call("A", departure=0.0), call("B", arrival=800.0)]


def rules(**more):
    return {"kind": "rules", **more}


def coasting(found):
    return found.rows[found.rows["phase"] == COASTING]


def test_a_train_cruises_at_its_share_of_the_limit():
    found = run(20.0, driving=rules(speed_percent=80.0), **LIMIT, **STOPS)
    cruising = found.rows["v_mps"][found.rows["phase"] == CRUISING]
    assert found.rows["v_mps"].max() == pytest.approx(32.0, abs=1e-9)
    assert cruising == pytest.approx(32.0, abs=1e-9)


def test_a_train_cruises_no_faster_than_told():
    assert run(20.0, driving=rules(speed_kmh=90.0), **LIMIT, **STOPS).rows["v_mps"].max() == pytest.approx(25.0, abs=1e-9)


def test_coasting_with_constant_resistance_is_the_closed_form():
    """From v0 it takes v0 t - w g t2 / 2 to come that far; the train coasts from km 10 to its braking curve."""
    drag = {"specific_a_n_per_kn": 2.0}
    found = run(20.0, driving=rules(coast_from=[{"km": 10.0, "to_km": 14.0}]), resistance=drag, **LIMIT, **STOPS)
    assert coasting(found)["traction_n"][:-1] == pytest.approx(0.0)
    inside = found.rows[(found.rows["s_m"] >= 10_000.0) & (found.rows["s_m"] <= 14_000.0)]
    s, v = inside["s_m"], inside["v_mps"]
    assert v**2 == pytest.approx(40.0**2 - 2.0 * 2e-3 * 9.80665 * (s - 10_000.0), rel=1e-9)


def test_coasting_without_an_end_goes_to_the_next_stop():
    found = run(20.0, driving=rules(coast_from=[{"km": 15.0}]), resistance={"specific_a_n_per_kn": 2.0}, **LIMIT, **STOPS)
    behind = found.rows[found.rows["s_m"] > 15_000.0]
    assert (behind["traction_n"] < 1.0).all()
    assert found.end_m == pytest.approx(20_000.0)


def test_coasting_before_stops_saves_energy_and_takes_longer():
    flat = run(20.0, resistance={"a_n": 4000.0}, **LIMIT, **STOPS)
    saved = run(20.0, driving=rules(coast_before_stops_km=4.0), resistance={"a_n": 4000.0}, **LIMIT, **STOPS)
    first = coasting(saved)[0]
    assert first["s_m"] == pytest.approx(16_000.0, abs=40.0)
    assert energy_kwh(saved) < energy_kwh(flat)
    assert saved.finished_s > flat.finished_s


def test_a_train_holds_the_lowest_speed_of_its_coasting():
    drag = {"specific_a_n_per_kn": 8.0}
    how = rules(coast_from=[{"km": 6.0, "to_km": 16.0}], coast_down_to_kmh=72.0)
    found = run(20.0, driving=how, resistance=drag, **LIMIT, **STOPS)
    inside = found.rows[(found.rows["s_m"] > 14_000.0) & (found.rows["s_m"] < 16_000.0)]
    assert inside["v_mps"] == pytest.approx(20.0, abs=0.2)
    assert inside["traction_n"][5:-2] == pytest.approx(8e-3 * 9.80665 * 200_000.0, rel=1e-6)
    after = found.rows[(found.rows["s_m"] > 16_100.0) & (found.rows["s_m"] < 16_500.0)]
    assert (after["traction_n"] > 17_000.0).all()


def test_a_capped_effort_accelerates_less():
    found = run(20.0, driving=rules(effort_percent=50.0), **LIMIT, **STOPS)
    assert found.rows["traction_n"][2] == pytest.approx(100_000.0)
    assert found.rows["wished_n"][2] == pytest.approx(100_000.0)


@pytest.mark.parametrize("drive", [None, SERIES_MOTORS])
def test_a_cap_of_the_current_holds_whatever_the_drive(drive):
    more = {} if drive is None else {"drive": drive}
    found = run(20.0, max_current_a=250.0, **LIMIT, **STOPS, **more)
    assert found.rows["current_a"].max() == pytest.approx(250.0, rel=1e-6)


def test_a_cap_of_the_power_holds_at_the_wheel():
    found = run(20.0, max_power_kw=1000.0, **LIMIT, **STOPS)
    assert found.rows["wheel_w"].max() == pytest.approx(1e6, rel=1e-6)


def test_a_late_train_is_driven_flat_out_until_it_is_on_time():
    """It leaves 60 s late: it passes M at the limit, catches up before B, from there on it keeps its reduced speed."""
    stations = {"A": 0.0, "M": 15.0, "B": 60.0}
    calls = [call("A", departure=0.0), passing("M", arrival=690.0), call("B", arrival=2560.0)]
    how = rules(speed_percent=60.0)
    late = make_trains(
        60.0,
        calls=calls,
        time=60.0,
        driving=how,
        stations=stations,
        end="stop",
        limits=[(-1.0, 61.0, 144.0)],
        resistance={"specific_a_n_per_kn": 4.0},
    )
    stepper = Stepper.of(compile_driven(late))
    while not stepper.gone:
        stepper.step(3000.0)
    rows, arrived = stepper.rows, stepper.state.arrived_s
    fast = rows["v_mps"] > 0.61 * 40.0
    assert fast.any()
    assert not stepper.mover["late"]
    assert 2450.0 < arrived[2] < 2561.5  # it coasts on from its higher speed
    # It is late by the plan from M on, and catches up where flat out and plan meet.
    first, last = np.flatnonzero(fast)[[0, -1]]
    assert rows["s_m"][first] < 3000.0
    assert rows["s_m"][last] < 55_000.0


def test_a_train_on_time_follows_its_plan_at_another_voltage_too():
    stations, calls = {"A": 0.0, "B": 20.0}, [call("A", departure=0.0), call("B", arrival=900.0)]
    how = rules(speed_percent=70.0)
    stepper = Stepper.of(compile_driven(make_trains(20.0, calls=calls, driving=how, stations=stations, end="stop", **LIMIT)))
    while not stepper.gone:
        stepper.step(2700.0)
    assert stepper.rows["v_mps"].max() <= 28.0 + 1e-9
    assert stepper.state.arrived_s[1] < 900.0


def test_without_plans_nothing_is_laid():
    assert (compile_driven(make_trains(5.0)).tables.trains["plans"] == 0).all()


CAR = {"resistance": {"a_n": 2500.0, "c_n_per_kmh2": 0.7}, "brake": BRAKE, "limits": [(-1.0, 40.0, 140.0)]}


@pytest.mark.parametrize("behind_s", [0.0, 2.0, 10.0, 60.0, 100.0])
def test_a_train_that_starts_late_arrives_on_time_and_not_before(behind_s):
    """It comes down to its plan when coasting down brings it there on time; then it has used no more than it had to."""
    calls = [call("A", departure=0.0), call("B", arrival=700.0)]
    found = make_trains(20.0, calls=calls, time=behind_s, driving={"kind": "to_time"}, **STOPS | CAR)
    stepper = Stepper.of(compile_driven(found))
    while not stepper.gone:
        stepper.step(3000.0)
    assert stepper.state.arrived_s[1] == pytest.approx(700.0, abs=1.0)
    seconds = 700.0 - behind_s
    replanned = run(
        20.0, driving={"kind": "to_time"}, calls=[call("A", departure=0.0), call("B", arrival=seconds)], **STOPS | CAR
    )
    assert stepper.rows["power_w"].sum() / 3.6e6 == pytest.approx(energy_kwh(replanned), rel=0.02)


@pytest.mark.parametrize("rules_of", [{"effort_percent": 25.0}, {"coast_from": [{"km": 0.5}]}])
def test_plans_do_not_depend_on_the_step(rules_of):
    hill = [(-1.0, 1.0, 0.0), (1.0, 2.0, 25.0), (2.0, 7.0, 0.0)]
    times = [run(5.0, driving=rules(**rules_of), slopes=hill, step_s=h, **STOPS | CAR | AT_5).finished_s for h in (0.1, 1.0, 2.0)]
    assert times[1:] == pytest.approx([times[0]] * 2, rel=5e-3)


UNIT = {"brake": BRAKE, "resistance": {"a_n": 2500.0, "c_n_per_kmh2": 0.7}}
STATIONS = {"A": 0.0, "P": 5.0, "C": 10.0, "D": 15.0, "B": 20.0}
HILL = {"slopes": [(-1.0, 5.0, 0.0), (5.0, 9.0, 30.0), (9.0, 14.0, -30.0), (14.0, 21.0, 4.0)]}
NEVER_LATE = {"kind": "to_time", "late_after_s": 1e6}
DEAD = [(0.0, 3300.0), (7000.0, 3300.0), (7001.0, 0.0), (8000.0, 0.0), (8001.0, 3300.0)]


def lateness(scenario, **more):
    """Return by how much the run of a scenario by its plan is late at its timed calls [s]."""
    found = journey(scenario, **more)
    assert found.status == "complete"
    return np.array([one.arrival_s - one.planned_arrival_s for one in found.calls if one.planned_arrival_s is not None])


def shortest(voltage_v=3000.0, **more):
    calls = [call("A", departure=0.0), call("B")]
    return run(20.0, calls=calls, stations=STATIONS, voltage_v=voltage_v, **UNIT, **more).finished_s


def in_time(due, *, between=(), driving=NEVER_LATE, **more):
    calls = [call("A", departure=0.0), *between, call("B", arrival=float(due))]
    return make_trains(20.0, calls=calls, stations=STATIONS, driving=driving, **UNIT, **more)


def test_stops_without_times_behind_the_last_timed_pass():
    calls = [call("A", departure=0.0), passing("P", arrival=400.0), call("C"), call("D"), call("B")]
    scenario = make_trains(20.0, calls=calls, stations=STATIONS, driving={"kind": "to_time"}, **UNIT)
    assert lateness(scenario) == pytest.approx([0.0], abs=0.3)


@pytest.mark.parametrize(
    ("times", "late_s"), [((150.0, 240.0, 330.0, 420.0, 570.0), 0.6), ((250.0, 340.0, 470.0, 560.0, 760.0), 2.5)]
)
def test_a_train_brakes_to_be_no_earlier_than_planned_where_it_passes(times, late_s):
    """Parts as short as flat out beside others with much time: without braking it passed 19 and 59 s too early.

    Behind a part in which it loses much time it is late: ways far from each other are mixed there.
    """
    names = {"A": 0.0, "P": 5.0, "Q": 9.0, "R": 12.0, "S": 16.0, "B": 20.0}
    calls = [call("A", departure=0.0), *(passing(name, arrival=at) for name, at in zip("PQRS", times[:4], strict=True))]
    calls.append(call("B", arrival=times[4]))
    scenario = make_trains(20.0, calls=calls, stations=names, driving={"kind": "to_time"}, **UNIT)
    late = lateness(scenario)
    assert late[:3] == pytest.approx(0.0, abs=0.3)
    assert 0.0 <= late[3] < late_s
    assert late[4] < 0.3  # at the stop it waits


@pytest.mark.parametrize("percent", [103.0, 110.0, 130.0, 180.0])
@pytest.mark.parametrize(
    "more",
    [
        {"drive": INVERTER | {"power_kw": 250.0}},
        {"drive": INVERTER | {"power_kw": 800.0}, "power_off": [{"from_km": 6.0, "to_km": 6.3, "kind": "neutral"}]},
        {"drive": SERIES_MOTORS, "clock": {"step_s": 5.0}},
    ],
    ids=["weak", "neutral section", "steps of 5 s"],
)
def test_a_plan_run_alone_is_on_time(more, percent):
    due = shortest(**HILL, **more) * percent / 100.0
    assert lateness(in_time(due, **HILL, **more))[-1] == pytest.approx(0.0, abs=0.25)


@pytest.mark.parametrize("factor", [1.03, 1.3])
def test_a_plan_for_a_voltage_with_a_gap_is_on_time(factor):
    due = shortest(DEAD, **HILL) * factor
    assert lateness(in_time(due, **HILL), voltage_v=DEAD, plan_voltage=DEAD)[-1] == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize("driving", [{"kind": "to_time"}, {"kind": "to_time", "method": "cruise"}])
def test_what_a_group_is_late_by_the_next_one_makes_up_for(driving):
    late = lateness(in_time(700.0, between=[call("C", arrival=200.0, departure=200.0)], driving=NEVER_LATE | driving))
    assert late[0] > 60.0
    assert late[1] == pytest.approx(0.0, abs=0.3)


def test_a_plan_is_made_for_the_voltage_that_it_names():
    due = 1.1 * shortest(2400.0)
    low, named = {"voltage_v": 2400.0}, NEVER_LATE | {"voltage_v": 2400.0}
    assert abs(lateness(in_time(due), **low)[-1]) > 1.0
    assert lateness(in_time(due, driving=named), **low)[-1] == pytest.approx(0.0, abs=0.25)
    assert lateness(in_time(due), plan_voltage=2400.0, **low)[-1] == pytest.approx(0.0, abs=0.25)
    assert lateness(in_time(due, driving=named), plan_voltage=3300.0, **low)[-1] == pytest.approx(0.0, abs=0.25)


def test_a_plan_that_does_not_arrive_is_given_up_and_told(caplog):
    """With 3 % of its effort the train does not come up 30 permille; flat out it does."""
    scenario = in_time(1200.0, driving=rules(effort_percent=3.0), **HILL)
    movement = compile_driven(scenario)
    assert "Train x is driven flat out" in caplog.text
    assert (movement.tables.trains["plans"] == 0).all()
    assert journey(scenario).status == "complete"


def test_runs_that_are_alike_are_run_alone_once(monkeypatch):
    runs = [
        make_run(name, 20.0, time=at, calls=[call("A", departure=at), call("B", arrival=at + 800.0)])
        for name, at in (("x", 0.0), ("y", 600.0))
    ]
    scenario = make_trains(20.0, runs=[one | {"driving": {"kind": "to_time"}} for one in runs], stations=STATIONS, **UNIT)
    count, run_journey = [], plan_runs.run_journey
    monkeypatch.setattr(plan_runs, "run_journey", lambda *given: count.append(1) or run_journey(*given))
    first, second = theoretical_journeys(scenario)
    assert len(count) == 1
    assert second.calls[1].arrival_s - first.calls[1].arrival_s == pytest.approx(600.0, abs=1e-6)
    tables = compile_driven(scenario).tables
    due = [tables.points[row["first_due"] : row["first_due"] + row["dues"]]["y"] for row in tables.trains]
    assert due[1][:-1] - due[0][:-1] == pytest.approx(600.0, abs=1e-6)

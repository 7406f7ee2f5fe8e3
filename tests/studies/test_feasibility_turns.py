"""Delays that a train brings along from the run that it was before: knock-on, followed back to where it arose."""

import math

import pytest
from coupled import couple, run, vehicle

from tractionpower.model.timetable import Timetable
from tractionpower.studies.feasibility import judge, lateness

AMPS = {"kind": "inverter", "starting_effort_kn": 200.0, "power_kw": 3000.0, "efficiency": 0.85, "max_current_a": 1000.0}
VEHICLES = [vehicle("inverter", drive=AMPS)]
LATE_S = 100.0


def judged(*runs, ohm=0.12, **links):
    plants = [{"id": "S", "km": 0.0, "no_load_voltage_v": 3100.0, "internal_resistance_ohm": ohm}]
    scenario = couple(*runs, end_s=2500.0, vehicles=VEHICLES, substations=plants)
    timetable = Timetable.model_validate({"trains": list(runs), **links})
    scenario = scenario.model_copy(update={"timetable": timetable})
    found = judge(scenario)
    late = lateness(scenario)
    for train in found.trains:
        assert late[train.train] == pytest.approx(max(0.0, train.late_s), abs=1e-6)
    for row in found.delays:
        parts = (row.knock_on_s, row.timetable_s, row.current_limit_s, row.voltage_s, row.dwell_s, row.driving_s)
        origins = (row.origin_timetable_s, row.origin_current_limit_s, row.origin_voltage_s, row.origin_dwell_s)
        assert min(*parts, *origins) >= 0.0
        assert sum(parts) == pytest.approx(max(row.late_s, 0.0), abs=1e-6)
        assert sum(origins) + row.origin_driving_s == pytest.approx(max(row.late_s, 0.0), abs=1e-6)
    return found, {(row.train, row.station, row.kind): row for row in found.delays}


def out(arrival, **more):
    return run("out", high=6.0, calls=[{"station": "A", "departure": 0.0}, {"station": "P", "arrival": arrival}], **more)


def back(departure, **more):
    calls = [{"station": "P", "departure": departure}, {"station": "A", "arrival": departure + 900.0}]
    return run("back", low=6.0, high=0.0, time=departure, calls=calls, **more)


def shortest_s():
    found, _ = judged(out(2000.0))
    return found.sections[0].shortest_s


def test_a_late_train_hands_its_delay_on_with_its_cause():
    arrival = round(shortest_s())
    found, rows = judged(
        out(float(arrival)), back(arrival + 30.0), ohm=2.5, rotations=[{"runs": ["out", "back"], "turn_round_s": 20.0}]
    )
    late, after = rows["out", "P", "arrival"], rows["back", "P", "departure"]
    assert late.voltage_s == pytest.approx(late.delay_s, abs=0.6)
    assert late.delay_s > 20.0
    assert after.delay_s == after.knock_on_s == pytest.approx(late.delay_s - 10.0)  # ten seconds of reserve in the turn-round
    assert after.origin_voltage_s > 0.95 * after.delay_s
    assert rows["back", "A", "arrival"].delay_s == 0.0
    assert {train.train: train.cause for train in found.trains} == {"out": "voltage", "back": "voltage"}


def test_a_turn_round_that_is_longer_than_planned_is_a_dwell():
    arrival = round(shortest_s()) + 5.0
    _, rows = judged(out(arrival), back(arrival + 30.0), rotations=[{"runs": ["out", "back"], "turn_round_s": 90.0}])
    after = rows["back", "P", "departure"]
    assert rows["out", "P", "arrival"].delay_s == 0.0
    assert 50.0 < after.delay_s < 60.0
    assert after.cause == "dwell"
    # less what low voltage has made it later, which the reserve of the run before takes up on arrival
    assert after.dwell_s == after.origin_dwell_s == pytest.approx(after.delay_s, abs=0.2)
    assert after.knock_on_s == 0.0
    on_time, rows = judged(out(arrival), back(arrival + 90.0), rotations=[{"runs": ["out", "back"], "turn_round_s": 90.0}])
    assert on_time.verdict == "feasible"
    assert rows["back", "P", "departure"].late_s == 0.0


def test_a_joined_train_waits_for_the_last_of_its_portions():
    arrival = round(shortest_s())
    first = run("a", high=6.0, calls=[{"station": "A", "departure": 0.0}, {"station": "P", "arrival": arrival + 30.0}])
    calls = [{"station": "A", "departure": LATE_S}, {"station": "P", "arrival": arrival + LATE_S - 40.0}]
    second = run("b", high=6.0, time=LATE_S, calls=calls)
    calls = [{"station": "P", "departure": arrival + LATE_S - 10.0}, {"station": "Q", "arrival": arrival + 1500.0}]
    joined = run("j", low=6.0, high=13.0, time=arrival + LATE_S - 10.0, calls=calls)
    _, rows = judged(first, second, joined, joins=[{"portions": ["a", "b"], "into": "j", "coupling_s": 10.0}])
    after, late = rows["j", "P", "departure"], rows["b", "P", "arrival"]
    assert late.delay_s > 35.0
    assert after.delay_s == pytest.approx(late.delay_s - 20.0, abs=1e-6)
    # alone, it is late by the same seconds less, and so by the same share of them after the slack of 20 s
    assert after.origin_timetable_s == pytest.approx(late.origin_timetable_s - 20.0, abs=1e-6)
    assert after.origin_voltage_s == pytest.approx(late.origin_voltage_s, abs=1e-6)
    assert after.knock_on_s == pytest.approx(after.delay_s)


def test_a_split_that_takes_too_long_is_not_handed_on_by_a_run_that_was_early():
    arrival = math.ceil(shortest_s())
    calls = [{"station": "P", "departure": arrival + 60.0}, {"station": "Q", "arrival": arrival + 1500.0}]
    parts = [run(name, low=6.0, high=13.0, time=arrival + 60.0, calls=calls) for name in ("k1", "k2")]
    split = [{"run": "out", "portions": ["k1", "k2"], "uncoupling_s": 120.0}]
    found, rows = judged(out(arrival + 18.0), *parts, splits=split)
    early = rows["out", "P", "arrival"].late_s
    assert -19.1 < early < -17.0
    for name in ("k1", "k2"):
        row = rows[name, "P", "departure"]  # ready 120 s after it came, planned 42 s after it should have come
        assert row.delay_s == pytest.approx(early + 120.0 - 42.0, abs=1e-6)
        assert row.dwell_s == row.origin_dwell_s == pytest.approx(row.delay_s, abs=0.2)
        assert (row.knock_on_s, row.cause) == (0.0, "dwell")
    assert found.trains[1].why.startswith("late 60 s at P: 60 s at stops and turn-rounds")


@pytest.mark.parametrize(("turn_s", "end"), [(120.0, "leave"), (120.0, "stay"), (90.0, "leave")])
def test_a_turn_round_keeps_the_seconds_of_its_causes(turn_s, end):
    # "a" is late by the timetable and by voltage; 100 s are planned between it and "b"
    plants = [
        {"id": n, "km": km, "no_load_voltage_v": 3200.0, "internal_resistance_ohm": 1.5} for n, km in (("A", 0.0), ("B", 20.0))
    ]
    calls = [{"station": "A", "departure": 0.0}, {"station": "B", "arrival": 600.0, "stops": end == "stay"}]
    a = run("a", calls=calls, end=end)
    calls = [{"station": "B", "departure": 700.0}, {"station": "A", "arrival": 1430.0}]
    b = run("b", low=20.0, high=0.0, time=630.0, calls=calls)
    scenario = couple(a, b, end_s=2000.0, substations=plants)
    rotation = {"trains": [a, b], "rotations": [{"runs": ["a", "b"], "turn_round_s": turn_s}]}
    found = judge(scenario.model_copy(update={"timetable": Timetable.model_validate(rotation)}))
    rows = {(row.train, row.kind): row for row in found.delays}
    late = rows["a", "arrival" if end == "stay" else "pass"]
    after = next(row for row in found.delays if row.train == "b" and row.kind == "departure")
    assert late.timetable_s > 15.0
    assert late.voltage_s > 5.0
    assert after.delay_s == pytest.approx(late.delay_s + turn_s - 100.0, abs=1e-6)
    assert after.origin_dwell_s == pytest.approx(max(turn_s - 100.0, 0.0), abs=1e-6)  # 100 s are planned
    assert after.origin_timetable_s == pytest.approx(late.timetable_s - max(100.0 - turn_s, 0.0), abs=1e-6)
    assert after.origin_voltage_s == pytest.approx(late.voltage_s, abs=1e-6)
    assert after.knock_on_s == pytest.approx(late.delay_s - max(100.0 - turn_s, 0.0), abs=1e-6)

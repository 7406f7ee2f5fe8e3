"""Delays that a train brings along from the run that it was before: knock-on, followed back to where it arose."""

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
    assert after.cause == "knock_on"
    assert after.origin_dwell_s == pytest.approx(after.delay_s)
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
    assert after.origin_timetable_s / after.delay_s == pytest.approx(late.origin_timetable_s / late.delay_s, abs=1e-6)

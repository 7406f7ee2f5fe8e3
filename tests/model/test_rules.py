"""What was built past the model is told by the rules of the model."""

from small_trains import make_trains

from tractionpower.model.rules import broken_rules
from tractionpower.model.timetable import Leg, TrainRun


def test_a_sound_scenario_breaks_none():
    assert broken_rules(make_trains(), ("line", "supply", "timetable", "trains", "vehicles", "clock", "limits")) == []


def test_each_broken_rule_is_told_at_its_place():
    scenario = make_trains()
    vehicle = scenario.vehicles[0].model_copy(update={"mass_t": -3.0, "length_m": float("nan")})
    run = scenario.timetable.trains[0].model_copy(update={"route": (Leg.model_construct(track="1", from_km=2.0, to_km=2.0),)})
    other = TrainRun.model_construct(id="7")
    timetable = scenario.timetable.model_copy(update={"trains": (run, other)})
    broken = scenario.model_copy(update={"vehicles": (vehicle,), "timetable": timetable})
    told = {problem.path: problem.found for problem in broken_rules(broken, ("timetable", "vehicles"))}
    assert set(told) >= {
        "vehicles[car].mass_t",
        "vehicles[car].length_m",
        "timetable.trains[x].route[0]",
        "timetable.trains[7].route",
    }
    assert told["vehicles[car].mass_t"].startswith("-3.0: ")
    assert {problem.path for problem in broken_rules(broken, ("vehicles",))} == {"vehicles[car].mass_t", "vehicles[car].length_m"}


def test_a_value_that_the_model_would_convert_is_told():
    scenario = make_trains()
    train = scenario.trains[0].model_copy(update={"id": 7})
    (problem,) = broken_rules(scenario.model_copy(update={"trains": (train,)}), ("timetable", "trains"))
    assert (problem.path, problem.severity) == ("trains", "error")
    whole = scenario.vehicles[0].model_copy(update={"mass_t": 200})  # 200 is 200.0
    assert broken_rules(scenario.model_copy(update={"vehicles": (whole,)}), ("vehicles",)) == []

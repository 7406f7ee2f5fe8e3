import pytest
from remedy_cases import case_of, judged, small_study

from tractionpower.model.change import apply_changes
from tractionpower.studies.remedies.sensitivities import lost_seconds, sensitivities, small_changes
from tractionpower.supply.characteristics import internal_resistance


def station(name, km, **more):
    return {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12} | more


STATIONS = [
    station("A", 0.0, state="rectifiers_out"),
    station("B", 20.0, units=3, units_in_service=1, grid_resistance_ohm=0.03),
    station("D", 12.0, units=2, grid_resistance_ohm=0.02),
]
BASE = judged({"X": 20.0, "Y": 0.0}, lost_s=40.0)  # all of it in the area of B


@pytest.fixture
def study():
    cabins = [{"id": "C", "km": 10.0, "state": "open"}]
    return small_study(substations=STATIONS, section_cabins=cabins, remedies={"sensitivities": 20})


def test_the_small_changes_are_those_that_the_devices_allow(study):
    told = {(small.kind, small.subject): small for small in small_changes(case_of(study), BASE)}
    assert set(told) == {
        ("units", "B"), ("no_load_voltage", "B"), ("internal_resistance", "B"),
        ("in_service", "A"),
        ("units", "D"), ("no_load_voltage", "D"), ("internal_resistance", "D"),
        ("section_cabin", "C"),
        ("current_cap", "trains of type inverter"),
    }  # fmt: skip
    stations = apply_changes(study, [text for small in told.values() for text in small.change if "resistance" not in text]).supply
    a, b, d = stations.substations
    assert a.state == "in_service"
    assert (b.units_in_service, b.no_load_voltage_v) == (2, pytest.approx(3535.0))
    assert d.units == 3
    assert stations.section_cabins[0].state == "closed"
    capped = apply_changes(study, told["current_cap", "trains of type inverter"].change)
    assert [run.max_current_a for run in capped.runs] == [900.0, 900.0]


def test_one_more_unit_lowers_the_resistance_that_units_share(study):
    small = next(each for each in small_changes(case_of(study), BASE) if (each.kind, each.subject) == ("units", "D"))
    changed = apply_changes(study, small.change).supply.substations[2]
    assert changed.internal_resistance_ohm == pytest.approx(0.02 + 0.2 / 3)  # units of 0.2 ohm each, three in parallel
    assert small.per == "3 units in place of 2"


def test_plants_given_by_their_units_change_alike():
    whole = station("D", 12.0, units=2, grid_resistance_ohm=0.02)
    by_unit = {k: v for k, v in whole.items() if k != "internal_resistance_ohm"} | {"unit_resistance_ohm": 0.2}
    found = []
    for plant in (whole, by_unit):
        study = small_study(substations=[STATIONS[1], plant], remedies={"sensitivities": 20})
        small = {each.kind: each for each in small_changes(case_of(study), BASE) if each.subject == "D"}
        changed = [apply_changes(study, small[kind].change).supply.substations[1] for kind in ("units", "internal_resistance")]
        found.append([internal_resistance(each) for each in changed])
    assert found[0] == pytest.approx([0.02 + 0.2 / 3, 0.99 * 0.12], rel=1e-6)
    assert found[1] == pytest.approx(found[0], rel=1e-6)


def test_a_short_list_has_something_of_every_device(study):
    case = case_of(apply_changes(study, ["remedies.sensitivities=4"]))
    assert {small.subject for small in small_changes(case, BASE)} == {"A", "B", "C", "D"}
    assert small_changes(case, BASE)[0].subject == "B"  # where most is lost


def test_they_are_differences_of_real_runs_the_greatest_first(study):
    def judge(scenario):
        volts = scenario.supply.substations[1].no_load_voltage_v - 3500.0
        return judged({"X": 20.0, "Y": 0.0}, lost_s=40.0 - 0.1 * volts + (0.5 if scenario.runs[0].max_current_a else 0.0))

    rows = sensitivities(case_of(study), study, BASE, judge)
    assert (rows[0].subject, rows[0].kind, rows[0].per) == ("B", "no_load_voltage", "+1 %")
    assert rows[0].lost_s_change == pytest.approx(-3.5)
    assert (rows[1].kind, rows[1].lost_s_change) == ("current_cap", pytest.approx(0.5))
    assert all(row.lost_s_change == 0.0 for row in rows[2:])


def test_none_where_none_are_asked_for(study):
    assert sensitivities(case_of(apply_changes(study, ["remedies.sensitivities=0"])), study, BASE, pytest.fail) == ()


def test_what_is_lost_is_summed_over_trains():
    assert lost_seconds(BASE) == pytest.approx(40.0)

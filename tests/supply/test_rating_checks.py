"""Checks of ratings: each fault gives one problem with its code, its place and what a person needs to mend it."""

import pytest
from small_studies import make_scenario, station
from small_supplies import assert_only

from tractionpower.cosimulation.check import check_scenario
from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.model.limits import Limit, overlay
from tractionpower.model.ratings import DutyRow
from tractionpower.model.scenario import Scenario
from tractionpower.supply.rating_checks import check_ratings


def made(*stations, limits=None, duty=DUTY_CLASSES.shipped, step_s=1.0, **supply):
    base = make_scenario(substations=[*stations, station("Z", 20.0)], clock={"step_s": step_s}, **supply)
    parts = {name: getattr(base, name) for name in Scenario.model_fields}
    own = overlay(base.limits, limits or ())
    return Scenario(**parts | {"duty_classes": duty, "rectifier_units": RECTIFIER_UNITS.shipped, "limits": own})


def problems(**more):
    return check_ratings(made(station("A", 0.0, **more)))


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"unit": "PD-17", "units": 2},
        {"unit": "PD-17", "rated_current_a": 1000.0, "duty_class": "II"},
        {"rated_current_a": 1000.0, "duty_class": "IX"},
        {"unit": "PD-16", "reserve_units": 1, "reserve_after_s": 60.0, "reserve_overload_percent": 20.0},
    ],
)
def test_what_is_in_order_is_not_told(more):
    assert problems(**more) == []


def test_an_unknown_unit_names_the_nearest():
    found = problems(unit="PD17")
    assert_only(found, "unknown_unit", "supply.substations[A].unit", "no rectifier unit 'PD17'", "did you mean PD-17?", "ADIF")


def test_an_unknown_class_names_the_nearest():
    found = problems(rated_current_a=1000.0, duty_class="Vi")
    assert_only(found, "unknown_duty_class", "supply.substations[A].duty_class", "did you mean VI?", "`duty_classes:`")


def test_a_class_that_a_unit_names_must_exist_and_ships():
    scenario = made(station("A", 0.0, unit="PD-17"), duty=())
    path = "supply.substations[A].unit"
    assert_only(check_ratings(scenario), "unknown_duty_class", path, "'VI' of unit PD-17", "put its rows into")


@pytest.mark.parametrize(
    ("more", "code", "field"),
    [
        ({"rated_current_a": 1000.0}, "no_duty_class", "duty_class"),
        ({"duty_class": "V"}, "duty_class_without_current", "duty_class"),
        ({"reserve_after_s": 60.0}, "reserve_without_units", "reserve_after_s"),
        ({"reserve_overload_percent": 20.0}, "reserve_without_units", "reserve_overload_percent"),
        ({"unit": "ADIF-1250"}, "unit_voltage", "unit"),
    ],
)
def test_what_is_doubtful_is_a_warning(more, code, field):
    assert_only(problems(**more), code, f"supply.substations[A].{field}", severity="warning")


def own_class(*rows):
    return [DutyRow(duty_class="own", window_s=window_s, multiple=multiple) for window_s, multiple in rows]


def of_class(*rows, step_s=1.0):
    return check_ratings(made(station("A", 0.0, rated_current_a=1.0, duty_class="own"), duty=own_class(*rows), step_s=step_s))


def test_a_window_below_the_step():
    assert of_class((0.0, 1.0), (2.0, 3.0), step_s=2.0) == []
    assert_only(of_class((0.0, 1.0), (2.0, 3.0), step_s=5.0), "window_below_step", "duty_classes", "window of 2 s", "step is 5 s")


def test_a_row_that_a_shorter_window_makes_useless():
    found = of_class((0.0, 1.0), (7200.0, 1.5), (60.0, 1.2))
    assert_only(found, "duty_row_without_effect", "duty_classes", "1.2 over 60 s and 1.5", severity="warning")
    assert_only(of_class((0.0, 1.0), (60.0, 0.9)), "duty_row_without_effect", "duty_classes", severity="warning")


def test_one_contract_for_each_supply_point():
    first = station("A", 0.0, supply_point="north", contract_power_kw=9000.0)
    same = station("B", 5.0, supply_point="north", contract_power_kw=9000.0)
    other = station("C2", 15.0, contract_power_kw=5000.0)
    assert check_ratings(made(first, same, other)) == []
    found = check_ratings(made(first, same | {"contract_power_kw": 8000.0}, other))
    assert_only(found, "contract_twice", "supply.substations[B].contract_power_kw", "8000 kW", "A has 9000 kW")


@pytest.mark.parametrize(
    ("name", "value", "code"),
    [
        ("window_cable_s", 0.5, "window_below_step"),
        ("wire_wind_mps", -1.0, "bad_limit"),
        ("wire_emissivity", 6.0, "bad_limit"),
        ("grid_low", 1.1, "bad_limit"),
        ("grid_high", 0.9, "bad_limit"),
    ],
)
def test_limits_that_cannot_be_used(name, value, code):
    scenario = made(station("A", 0.0), limits=[Limit(system="dc3000", name=name, value=value)])
    assert_only(check_ratings(scenario), code, "limits", name)


def test_windows_that_are_no_whole_number_of_steps():
    found = of_class((0.0, 1.0), (10.0, 3.0), (60.0, 2.0), step_s=4.0)
    assert_only(found, "window_not_whole", "clock.step_s", "10 s (class own)", "counts as 8 s", severity="warning")
    fine = {"limits": [Limit(system="dc3000", name="window_cable_s", value=7.0)], "step_s": 4.0}
    assert check_ratings(made(station("A", 0.0), **fine)) == []  # no cable is rated
    told = check_ratings(made(station("A", 0.0, feeder_rated_current_a=900.0), **fine))
    assert_only(told, "window_not_whole", "clock.step_s", "7 s (window_cable_s)", "counts as 4 s", severity="warning")
    assert of_class((0.0, 1.0), (10.0, 3.0), step_s=0.1) == []  # 100 steps, in whatever way 0.1 is rounded


def test_wires_that_may_carry_nothing():
    rows = [{"from_km": 0.0, "to_km": 10.0, "type": "C120-2C"}, {"from_km": 10.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05}]
    base = made(station("A", 0.0), contact_lines=rows, limits=[Limit(system="dc3000", name="wire_ambient_c", value=80.0)])
    hot = base.model_copy(update={"conductors": shipped_conductors()})
    assert_only(check_ratings(hot), "no_ampacity", "supply.contact_lines[0]", "at 80 °C", "may carry nothing", severity="warning")
    own = made(station("A", 0.0), contact_lines=[rows[0] | {"rated_current_a": 900.0}, rows[1]], limits=[hot.limits[0]])
    assert check_ratings(own.model_copy(update={"conductors": shipped_conductors(), "limits": hot.limits})) == []
    assert check_ratings(base.model_copy(update={"conductors": ()})) == []  # wires that nobody knows are told by others


def test_missing_windows_matter_where_conductors_are_rated():
    limits = tuple(limit for limit in shipped_limits() if not limit.name.startswith("window_"))
    for more, told in (({}, 0), ({"feeder_rated_current_a": 900.0}, 1)):
        scenario = made(station("A", 0.0, **more))
        found = check_ratings(scenario.model_copy(update={"limits": limits}))
        assert [problem.code for problem in found] == ["missing_limit"] * told


def test_all_is_told_at_once_by_the_checks_of_a_scenario():
    bad = station("A", 0.0, unit="PD17", contract_power_kw=1.0, supply_point="n")
    twice = station("B", 5.0, contract_power_kw=2.0, supply_point="n")
    codes = {problem.code for problem in check_scenario(made(bad, twice))}
    assert {"unknown_unit", "contract_twice"} <= codes


def test_units_with_a_rating_are_not_told_to_be_without_effect():
    codes = {problem.code for problem in check_scenario(made(station("A", 0.0, unit="PD-17", units=2)))}
    assert codes == set()

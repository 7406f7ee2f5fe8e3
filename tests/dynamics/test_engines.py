"""Engines of a train: who drives, where the effort comes from, the electric brake."""

import numpy as np
import pytest
from small_controls import scenario, vehicle

from tractionpower.dynamics.engines import compile_engines, effort_of, electric_brake_of, powered
from tractionpower.model.dynamics.case import CasePart, DynamicsScenario
from tractionpower.model.dynamics.gear import Traction

TABLE = {
    "kind": "table",
    "effort": [
        {"speed_kmh": v, "voltage_v": u, "effort_kn": f * u / 3000} for v, f in ((36, 200), (0, 300)) for u in (3000, 1500)
    ],
    "current": [{"speed_kmh": v, "voltage_v": u, "current_a": 1000.0} for v in (0, 36) for u in (1500, 3000)],
}
SERIES = {
    "kind": "series_motors",
    "motors": 4,
    "groupings": [{"series": 4, "parallel": 1}],
    "starting_current_a": 300.0,
    "motor_resistance_ohm": 0.2,
    "magnetisation": [{"current_a": 100.0, "emf_vs_per_rev": 50.0}, {"current_a": 300.0, "emf_vs_per_rev": 90.0}],
    "gear_ratio": 4.0,
    "wheel_diameter_m": 1.2,
    "gear_efficiency": 0.97,
}
TRACTION = {"starting_effort_kn": 200.0, "power_kw": 1000.0}


def with_vehicles(parts, *vehicles, **given):
    plain = scenario(**given)
    case = plain.case.model_copy(update={"vehicles": tuple(CasePart.model_validate(part) for part in parts)})
    return DynamicsScenario(case=case, vehicles=vehicles, couplings=())


def test_who_drives():
    vehicles = (scenario().vehicle("loco"), vehicle(), vehicle("steam", "locomotive"))
    parts = [
        {"id": "loco"},
        {"id": "loco", "powered": False},
        {"id": "wagon", "count": 2},
        {"id": "steam"},
        {"id": "wagon", "traction": TRACTION},
    ]
    assert powered(with_vehicles(parts, *vehicles)) == (True, False, False, False, False, True)
    assert powered(with_vehicles(parts, *vehicles, traction=TRACTION)) == (True, False, False, False, True, True)


def test_equal_vehicles_share_a_row():
    vehicles = (scenario().vehicle("loco"), vehicle())
    parts = [{"id": "loco", "count": 2}, {"id": "wagon"}, {"id": "loco"}, {"id": "loco", "traction": TRACTION | {"levels": 4}}]
    tables = compile_engines(with_vehicles(parts, *vehicles), [])
    assert tables.rows == (0, 0, -1, 0, 1)
    assert tables.engines["first_level"].tolist() == [0, 15]
    assert tables.engines["levels"].tolist() == [15, 4]
    np.testing.assert_allclose(tables.levels["effort_n"][15:], [50e3, 100e3, 150e3, 200e3])
    assert compile_engines(with_vehicles([{"id": "wagon"}], *vehicles), []).engines.shape == (0,)


def test_a_table_gives_the_curve_of_its_highest_voltage_by_speed():
    loco = vehicle("loco", "locomotive", drive=TABLE)
    assert effort_of(Traction(levels=2), loco).points == (((0.0, 150e3), (10.0, 100e3)), ((0.0, 300e3), (10.0, 200e3)))
    given = effort_of(Traction(starting_effort_kn=90.0, power_kw=400.0), loco)
    assert (given.effort_n, given.power_w, given.points) == (90e3, 400e3, ())
    curves = [(7.0, 7.0)]  # of gears, before
    levels = compile_engines(scenario(loco=loco, traction={"levels": 2}), curves).levels
    assert levels["first_point"].tolist() == [1, 3]
    assert curves[3:] == [(0.0, 300e3), (10.0, 200e3)]


def test_series_motors_do_not_tell_their_effort():
    loco = vehicle("loco", "locomotive", drive=SERIES)
    assert not effort_of(Traction(), loco).known
    assert effort_of(Traction(starting_effort_kn=90.0, power_kw=400.0), loco).known


def test_what_the_traction_leaves_out_is_the_drives():
    effort = effort_of(Traction(starting_effort_kn=90.0), scenario().vehicle("loco"))
    assert (effort.effort_n, effort.power_w) == (90e3, 1500e3)


def test_the_electric_brake_of_the_case_goes_before_that_of_the_vehicle():
    own = {"electric_effort_kn": 120.0, "electric_power_kw": 1100.0, "electric_above_kmh": 8.0}
    loco = vehicle("loco", "locomotive", brake=own, drive=scenario().vehicle("loco").drive)
    taken = electric_brake_of(scenario(loco=loco).parts[0], loco)
    assert taken is not None
    assert (taken.effort_kn, taken.power_kw, taken.fades_below_kmh) == (120.0, 1100.0, 8.0)
    case_brake = {"effort_kn": 50.0, "power_kw": 500.0}
    tables = compile_engines(scenario(loco=loco, electric_brake=case_brake), [])
    assert tables.engines["electric_n"].tolist() == [50e3]
    assert compile_engines(scenario(), []).engines["electric_n"].tolist() == [0.0]


@pytest.mark.parametrize(("adhesion", "weight"), [(True, 70e3 * 9.80665), (False, np.inf)])
def test_adhesion_caps_only_where_it_is_asked_for(adhesion, weight):
    loco = vehicle("loco", "locomotive", drive=scenario().vehicle("loco").drive, adhesive_mass_t=70.0)
    tables = compile_engines(scenario(loco=loco, traction={"adhesion": adhesion}), [])
    assert tables.engines["adhesive_n"][0] == pytest.approx(weight)

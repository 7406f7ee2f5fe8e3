"""A train as sums over its vehicles."""

import pytest

from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.formation import form

G = 9.80665
DRIVE = {"kind": "inverter", "starting_effort_kn": 200.0, "power_kw": 4000.0, "efficiency": 0.85}
LOCO = {
    "id": "loco", "kind": "locomotive", "mass_t": 80.0, "length_m": 20.0, "max_speed_kmh": 160.0, "drive": DRIVE,
    "rotating_mass_factor": 1.2, "resistance": {"a_n": 1000.0, "b_n_per_kmh": 10.0, "c_n_per_kmh2": 0.3},
    "auxiliaries": {"power_kw": 60.0}, "brake": {"service_rate_mps2": 0.6},
}  # fmt: skip
COACH = {
    "id": "coach", "kind": "coach", "mass_t": 40.0, "load_t": 10.0, "length_m": 25.0, "max_speed_kmh": 140.0,
    "rotating_mass_factor": 1.05,
    "resistance": {"specific_a_n_per_kn": 1.5, "specific_b_n_per_kn_per_kmh": 0.01, "specific_c_n_per_kn_per_kmh2": 1e-4,
                   "tunnel_factor_single_track": 2.0},
    "auxiliaries": {"power_kw": 10.0, "heating_kw": 30.0}, "brake": {"service_rate_mps2": 0.8},
}  # fmt: skip


def formed(*parts, **more):
    vehicles = {one["id"]: Vehicle.model_validate(one) for one in (LOCO, COACH)}
    return form(Train.model_validate({"id": "t", "vehicles": list(parts), **more}), vehicles)


def test_a_locomotive_with_loaded_coaches():
    found = formed({"id": "loco"}, {"id": "coach", "count": 6, "load_percent": 50.0})
    weight_kn = 6 * 45.0 * G
    assert found.mass_kg == pytest.approx(80e3 + 6 * 45e3)
    assert found.inertia_kg == pytest.approx(1.2 * 80e3 + 6 * (1.05 * 40e3 + 5e3))
    assert (found.length_m, found.spread_m, found.max_mps) == (170.0, 170.0, pytest.approx(140.0 / 3.6))
    assert found.service_rate_mps2 == 0.6
    assert found.a_n == pytest.approx(1000.0 + 1.5 * weight_kn)
    assert found.b_ns_per_m * 20.0 == pytest.approx(72.0 * (10.0 + 0.01 * weight_kn))
    assert found.c_ns2_per_m2 * 400.0 == pytest.approx(72.0**2 * (0.3 + 1e-4 * weight_kn))
    assert (found.auxiliary_w, found.heating_w, found.units) == (120e3, 180e3, 1)


def test_tunnels_act_on_vehicles_one_by_one():
    found = formed({"id": "loco"}, {"id": "coach", "count": 6})
    (plain, drag), (both, none) = found.tunnel
    assert plain * found.mass_kg * G == pytest.approx(2.0 * 80.0 * G)  # 2 N/kN on the locomotive alone
    assert drag * 400.0 == pytest.approx(72.0**2 * 1e-4 * 240.0 * G)
    assert (both, none) == (pytest.approx(1e-3), 0.0)


def test_hauled_locomotives_are_mass_and_resistance():
    one = formed({"id": "loco"})
    two = formed({"id": "loco"}, {"id": "loco", "powered": False})
    assert (two.units, two.auxiliary_w) == (1, one.auxiliary_w)
    assert (two.mass_kg, two.a_n) == (2 * one.mass_kg, 2 * one.a_n)
    assert formed({"id": "loco", "powered": False}).driver is None
    assert formed({"id": "loco", "count": 2}).units == 2


def test_what_the_train_gives_replaces_what_follows_from_vehicles():
    found = formed({"id": "loco"}, max_speed_kmh=90.0, service_rate_mps2=0.4, mass_distribution="point")
    assert (found.max_mps, found.service_rate_mps2, found.spread_m) == (25.0, 0.4, 0.0)


def test_constant_power_heating():
    coach = COACH | {"id": "loco", "auxiliaries": {"power_kw": 10.0, "heating_kw": 30.0, "heating": "constant_power"}}
    found = form(Train.model_validate({"id": "t", "vehicles": [{"id": "loco"}]}), {"loco": Vehicle.model_validate(coach)})
    assert (found.auxiliary_w, found.heating_w) == (40e3, 0.0)

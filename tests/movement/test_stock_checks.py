"""Checks of vehicles and trains: each fault alone, at its place; what is in order is not told."""

import pytest
from small_trains import BRAKE, INVERTER, TABLE, VEHICLE

from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rolling_stock import load_train, shipped_trains
from tractionpower.model.limits import system_voltages
from tractionpower.model.vehicle import Part, Vehicle
from tractionpower.movement.stock_checks import check_train, check_vehicle

VOLTAGES = system_voltages(shipped_limits(), "dc3000")
GOOD = VEHICLE | {"resistance": {"a_n": 2000.0}, "adhesive_mass_t": 200.0}


def vehicle(**more):
    return Vehicle.model_validate(GOOD | more)


def told(problems):
    """Return the problems as (code, path below the vehicle, severity)."""
    return [(problem.code, problem.path.removeprefix("vehicles[car]."), problem.severity) for problem in problems]


def vehicle_problems(**more):
    return told(check_vehicle(vehicle(**more), VOLTAGES))


@pytest.mark.parametrize("name", sorted(shipped_trains()))
def test_what_ships_is_in_order(name):
    train, vehicles = load_train(name)
    known = {item.id: item for item in vehicles}
    assert [problem for item in vehicles for problem in check_vehicle(item, VOLTAGES)] == []
    assert check_train("trains[x].vehicles", train.vehicles, known, VOLTAGES) == []


@pytest.mark.parametrize(
    ("more", "code", "path", "severity"),
    [
        ({"mass_t": 80000.0, "adhesive_mass_t": None}, "absurd_mass", "mass_t", "warning"),
        ({"mass_t": 10.0, "adhesive_mass_t": None, "drive": None}, "absurd_mass", "mass_t", "warning"),
        ({"axles": 4}, "absurd_mass", "mass_t", "warning"),
        ({"resistance": {}}, "no_resistance", "resistance", "warning"),
        ({"drive": None, "brake": {"electric_effort_kn": 5.0}}, "brake_without_drive", "brake.electric_effort_kn", "error"),
        ({"brake": {"electric_effort_kn": 5.0}}, "brake_without_power", "brake.electric_power_kw", "warning"),
        ({"mass_t": 30.0, "adhesive_mass_t": None}, "absurd_effort", "drive.starting_effort_kn", "warning"),
        ({"drive": INVERTER | {"power_kw": 20001.0}}, "absurd_power", "drive.power_kw", "warning"),
        # mu = 7.5 / 44 + 0.161 = 0.331: 200 t give 650 kN
        ({"brake": BRAKE | {"electric_effort_kn": 651.0}}, "brake_adhesion", "brake.electric_effort_kn", "warning"),
        ({"drive": TABLE, "max_speed_kmh": 161.0}, "short_table", "drive.effort", "warning"),
        ({"drive": TABLE | {"current": TABLE["current"][:-1]}}, "short_table", "drive.current", "warning"),
    ],
)
def test_each_fault_of_a_vehicle(more, code, path, severity):
    assert vehicle_problems(**more) == [(code, path, severity)]


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"axles": 5},
        {"mass_t": 40.0, "adhesive_mass_t": 40.0},
        {"drive": None},
        {"drive": INVERTER | {"power_kw": 20000.0}},
        {"drive": TABLE},
        {"brake": BRAKE | {"electric_effort_kn": 649.0}},
        {"brake": BRAKE | {"electric_effort_kn": 900.0}, "adhesive_mass_t": None},
    ],
)
def test_what_a_vehicle_may_be(more):
    assert vehicle_problems(**more) == []


def test_where_a_table_ends():
    low = [point | {"voltage_v": 2000.0} for point in TABLE["effort"] if point["speed_kmh"] <= 60.0]
    high = [point | {"voltage_v": 3000.0} for point in TABLE["effort"]]
    amps = [{"voltage_v": 2000.0, "speed_kmh": kmh, "current_a": 2000.0} for kmh in (0.0, 60.0)]
    amps += [point | {"voltage_v": 3000.0} for point in TABLE["current"]]
    (problem,) = check_vehicle(vehicle(drive=TABLE | {"effort": low + high, "current": amps}), VOLTAGES)
    told = "the points at 2000 V end at 60 km/h: effort and losses stay those of 60 km/h up to 160 km/h"
    assert (problem.code, problem.found) == ("short_table", told)


KNOWN = {
    "car": vehicle(auxiliaries={"power_kw": 30.0, "heating_kw": 60.0}),
    "loco": vehicle(id="loco", kind="locomotive"),
    "coach": vehicle(id="coach", kind="coach", drive=None, load_t=8.0, auxiliaries={"power_kw": 45.0}),
}


def train_problems(*parts, **more):
    known = KNOWN | {name: Vehicle.model_validate(item) for name, item in more.items()}
    return check_train("trains[t].vehicles", [Part.model_validate(part) for part in parts], known, VOLTAGES)


def test_an_unknown_vehicle_is_told_with_the_nearest():
    (problem,) = train_problems({"id": "car"}, {"id": "coahc", "load_percent": 50.0})
    assert (problem.code, problem.path, problem.found) == ("unknown_vehicle", "trains[t].vehicles[1].id", "'coahc'")
    assert problem.allowed == "car, coach, loco"
    assert problem.remedy == "did you mean coach?"


def test_drives_of_two_kinds_are_an_error_unless_one_is_hauled():
    (problem,) = train_problems({"id": "car"}, {"id": "loco"})
    assert (problem.code, problem.severity, problem.path) == ("mixed_drives", "error", "trains[t].vehicles")
    assert problem.found.endswith("car, loco")
    assert train_problems({"id": "car"}, {"id": "loco", "powered": False}, {"id": "coach"}) == []
    assert train_problems({"id": "car"}, {"id": "car", "count": 2}) == []


def test_a_load_of_a_vehicle_that_takes_none():
    (problem,) = train_problems({"id": "coach", "load_percent": 60.0}, {"id": "car", "load_percent": 60.0})
    assert (problem.code, problem.path) == ("load_without_mass", "trains[t].vehicles[1].load_percent")


@pytest.mark.parametrize(
    ("limit", "coaches", "severity"), [(31.0, 0, None), (30.0, 0, "warning"), (44.0, 1, "warning"), (46.0, 1, None)]
)
def test_a_current_below_that_of_the_auxiliaries(limit, coaches, severity):
    # 90 kW at 3000 V are 30 A, those of a coach 15 A more
    car = KNOWN["car"].model_dump() | {"drive": GOOD["drive"] | {"max_current_a": limit}}
    found = train_problems({"id": "car"}, *[{"id": "coach"}] * coaches, car=car)
    assert [problem.severity for problem in found] == [severity] * bool(severity)
    if found:
        assert f"take {30 + 15 * coaches} A at 3000 V" in found[0].found

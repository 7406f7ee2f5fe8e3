"""Checks of drives: each fault alone, at its place; what is in order is not told."""

import pytest
from pydantic import TypeAdapter
from small_trains import INVERTER, SERIES_MOTORS, TABLE

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.drive import Drive
from tractionpower.model.limits import system_voltages
from tractionpower.movement.drive_checks import check_drive

VOLTAGES = system_voltages(shipped_limits(), "dc3000")
DRIVE = TypeAdapter(Drive)


def problems(base, voltages=VOLTAGES, **more):
    return check_drive("d", DRIVE.validate_python(base | more), voltages)


def told(base, **more):
    return [(problem.code, problem.path, problem.severity) for problem in problems(base, **more)]


@pytest.mark.parametrize("base", [INVERTER, SERIES_MOTORS, TABLE], ids=lambda base: base["kind"])
@pytest.mark.parametrize("voltages", [VOLTAGES, None], ids=["voltages", "none"])
def test_good_drives_are_in_order(base, voltages):
    assert problems(base, voltages) == []


def points(*rows):
    return [{"voltage_v": volts, "power_kw": power} for volts, power in rows]


def grid(*rows):
    return [{"load_percent": load, "speed_kmh": speed, "efficiency": 0.8} for load, speed in rows]


WHOLE_MAP = [(50.0, 0.0), (50.0, 80.0), (100.0, 80.0), (100.0, 0.0)]


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (
            {"power_over_voltage": points((2000, 500), (3000, 900), (3300, 800))},
            ("non_monotone_curve", "power_over_voltage[2].power_kw"),
        ),
        ({"power_over_voltage": points((2000, 500), (3000, 900), (3300, 900))}, None),
        ({"fold_back_from_v": 3800.0, "fold_back_to_v": 3700.0}, ("fold_back", "fold_back_from_v")),
        ({"fold_back_from_v": 3700.0, "fold_back_to_v": 3800.0}, None),
        ({"fold_back_from_v": 4000.0}, ("fold_back", "fold_back_from_v")),  # to U_max2 = 3900 V
        ({"fold_back_to_v": 3500.0}, ("fold_back", "fold_back_to_v")),  # from U_max1 = 3600 V
        ({"efficiency": None, "efficiency_map": grid(*WHOLE_MAP)}, None),
        ({"efficiency": None, "efficiency_map": grid(*WHOLE_MAP[:3])}, ("efficiency_map", "efficiency_map")),
        ({"efficiency": None, "efficiency_map": grid(*WHOLE_MAP, (50.0, 80.0))}, ("efficiency_map", "efficiency_map")),
    ],
)
def test_inverter_drives(more, expected):
    assert told(INVERTER, **more) == ([(expected[0], f"d.{expected[1]}", "error")] if expected else [])


def test_what_a_map_lacks_is_named():
    (problem,) = problems(INVERTER, efficiency=None, efficiency_map=grid(*WHOLE_MAP[:3], (50.0, 80.0)))[1:]
    assert problem.found == "the load of 100 % has no point at 0 km/h"


@pytest.mark.parametrize("base", [INVERTER, SERIES_MOTORS, TABLE], ids=lambda base: base["kind"])
@pytest.mark.parametrize(("factor", "is_told"), [(0.7, True), (0.701, False), (0.5, True), (0.9, False)])
def test_a_knee_at_the_lowest_voltage(base, factor, is_told):
    # 1.05 U_min2 are 2100 V
    assert told(base, knee_factor=factor) == [("low_knee", "d.knee_factor", "error")] * is_told
    assert problems(base, None, knee_factor=factor) == []


def test_a_low_knee_is_told_with_the_voltages():
    (problem,) = problems(INVERTER, knee_factor=0.6)
    assert problem.found == "0.6, a knee at 1800 V"
    assert problem.allowed == "above 2100 V, 1.05 of U_min2 = 2000 V: above 0.7"


def magnetisation(*rows):
    return [{"current_a": amps, "emf_vs_per_rev": emf} for amps, emf in rows]


def resistors(**more):
    return {"starting_resistors_ohm": more}


GROUPINGS = SERIES_MOTORS["groupings"]
FALLING = magnetisation((100, 50), (300, 90), (400, 80))
RESISTORS = "starting_resistors"


@pytest.mark.parametrize(
    ("more", "code", "path", "severity"),
    [
        ({"motors": 6}, "grouping", "groupings[0]", "error"),
        ({"groupings": GROUPINGS[::-1]}, "grouping_order", "groupings[1].series", "error"),
        ({"magnetisation": FALLING}, "non_monotone_curve", "magnetisation[2].emf_vs_per_rev", "error"),
        ({"magnetisation": magnetisation((100, 50), (200, 75))}, "short_curve", "magnetisation", "warning"),
        ({"field_steps_percent": [90.0, 60.0]}, "field_steps", "field_steps_percent[0]", "error"),
        (resistors(series=[12.0, 0.0], series_parallel=[3.0, 0.0]), RESISTORS, f"{RESISTORS}_ohm.series_parallel", "error"),
        (resistors(series=[12.0, 5.0, 6.0, 0.0]), RESISTORS, f"{RESISTORS}_ohm.series[2]", "error"),
        (resistors(series=[12.0, 5.0]), RESISTORS, f"{RESISTORS}_ohm.series[1]", "error"),
        (resistors(series=[12.0, 0.0], parallel=[1.0, 2.0, 0.0]), RESISTORS, f"{RESISTORS}_ohm.parallel[1]", "error"),
        # 3000 V / (9 + 4 * 0.1) ohm = 319 A; 300 A are held
        (resistors(series=[9.0, 0.0]), "first_notch", "starting_resistors_ohm.series[0]", "warning"),
        ({"relay": {"off_v": 2000.0, "on_v": 3000.0}}, "relay_never_closes", "relay.on_v", "warning"),
    ],
)
def test_each_fault_of_series_motors(more, code, path, severity):
    found = [item for item in told(SERIES_MOTORS, **more) if (more.get("motors"), item[1]) != (6, "d.groupings[1]")]
    assert found == [(code, f"d.{path}", severity)]


@pytest.mark.parametrize(
    "more",
    [
        resistors(series=[9.6, 5.0, 5.0, 0.0], parallel=[2.0, 0.0]),  # 3000 V / 10 ohm are the 300 A that are held
        {"relay": {"off_v": 2000.0, "on_v": 2999.0}},
        {"groupings": [GROUPINGS[0], {"series": 2, "parallel": 2, "starting_current_a": 450.0}]},
    ],
)
def test_what_series_motors_may_have(more):
    assert told(SERIES_MOTORS, **more) == []


def test_one_grouping_has_notches_in_series_only():
    more = {"groupings": GROUPINGS[:1]} | resistors(series=[12.0, 0.0], parallel=[2.0, 0.0])
    (problem,) = problems(SERIES_MOTORS, **more)
    assert (problem.path, problem.allowed) == ("d.starting_resistors_ohm.parallel", "only series")


def curve(name, *rows, **more):
    return [{"speed_kmh": float(kmh), name: float(value)} | more for kmh, value in rows]


@pytest.mark.parametrize(
    ("effort", "current", "expected"),
    [
        # 100 kN at 36 km/h are 1000 kW, 333.3 A at 3000 V
        ([(0, 100), (36, 100)], [(0, 0), (36, 333)], ("table_power", "effort[1]", "error")),
        ([(0, 100), (36, 100)], [(0, 0), (36, 334)], None),
        # between its points too: at 18 km/h 500 kW
        ([(0, 100), (36, 100)], [(0, 0), (18, 160), (36, 400)], ("table_power", "effort[0]", "error")),
        ([(0, 100), (36, 101)], [(0, 0), (36, 400)], ("rising_effort", "effort[1].effort_kn", "warning")),
        ([(36, 101), (0, 100)], [(0, 0), (36, 400)], ("rising_effort", "effort[0].effort_kn", "warning")),
        ([(0, 100), (36, 80), (36, 70)], [(0, 0), (36, 400)], ("table_curve", "effort[2].speed_kmh", "error")),
    ],
)
def test_tables(effort, current, expected):
    drive = {"kind": "table", "effort": curve("effort_kn", *effort), "current": curve("current_a", *current)}
    assert told(drive) == ([(expected[0], f"d.{expected[1]}", expected[2])] if expected else [])


def test_voltages_of_tables():
    low = curve("effort_kn", (0, 100), (36, 50), voltage_v=2000.0)
    high = curve("effort_kn", (0, 100), (36, 90), voltage_v=3000.0)
    amps = curve("current_a", (0, 10), (36, 400), voltage_v=2000.0)
    drive = {"kind": "table", "effort": low + high, "current": amps}
    (problem,) = problems(drive)
    assert (problem.code, problem.found) == ("table_voltages", "efforts at 2000 V, 3000 V, currents at 2000 V")
    assert told(drive, current=amps + curve("current_a", (0, 10), (36, 400), voltage_v=3000.0)) == []
    found = told(drive, effort=low + curve("effort_kn", (0, 1), (9, 1)), current=amps + curve("current_a", (0, 9), (9, 9)))
    assert found == [("table_voltages", "d.effort", "error"), ("table_voltages", "d.current", "error")]
    assert told(drive, effort=[*low, high[0]], current=amps) == [
        ("table_curve", "d.effort[2]", "error"),
        ("table_voltages", "d", "error"),
    ]

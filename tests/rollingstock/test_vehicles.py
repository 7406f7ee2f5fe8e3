"""The rolling stock that ships: every file reads, and gives the efforts, speeds and masses that are known of it.

The natural curves are worked out here from the figures of the files alone, with formulas of their own:
E = c(f I) n, U/n_s = E + I R, F = N eta c(f I) I i / (pi D), n = v i / (pi D).
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

from tractionpower.io.documents import read_document
from tractionpower.model.vehicle import Train, Vehicle

STOCK = Path(__file__).parents[2] / "rollingstock"
VEHICLES = sorted(path.stem for path in (STOCK / "vehicles").glob("*.yaml"))
TRAINS = sorted(path.stem for path in (STOCK / "trains").glob("*.yaml"))
G = 9.81
HEAVY_AXLES_T = {"locomotive-4400hp": 32.5, "locomotive-96t": 24.0, "wagon-heavy-haul": 25.0}
"""Axle loads of heavy haul in North America and of the gauge of 1520 mm; the others are UIC lines of 22.5 t."""


def read(folder, name):
    """Return the plain content of a file, read as YAML 1.2 without the package."""
    return YAML(typ="safe", pure=True).load(STOCK / folder / f"{name}.yaml")


def frohlich(a, b, p=1.0):
    return lambda x: a * x / (b**p + x**p) ** (1.0 / p)


# Fitted magnetisation curves c(x) [V s/rev] over the field current [A], the largest relative error of straight lines
# between points, and the largest current that must lie on the curve.
CURVES = {
    "ep09": (frohlich(140.3, 382.5, 2.626), 850.0),  # LKa-740, fitted to 104e_1.fiz
    "eu07": (frohlich(126.6, 127.8), 750.0),  # EE541, fitted to 303E.chk
    "et22": (frohlich(126.6, 127.8), 750.0),
    "en57": (frohlich(132.5 * math.pi * 1.0 / 3.55, 48.0), 220.0),  # reconstruction per metre, 132.5 I / (48 + I) V s/m
}

FIELDS_EP09 = {"100": 1.0, "84": 0.84, "69": 0.69, "58": 0.58, "48": 0.48, "40": 0.40}
FIELDS_EE541 = {"100": 1.0, "73": 0.727, "54": 0.544, "41": 0.410, "31": 0.314, "24": 0.244, "18": 0.183}

# Natural curves at 3000 V: rows "branches, field %, speed km/h / effort kN ..." over the current of one motor [A]. Worked
# out from the fitted curves (LKa-740 from 104e_1.fiz, EE541 from 303E.chk); speeds are rounded to 0.1 km/h, efforts to 1 kN.
NATURAL = {
    "ep09": (
        (200, 300, 400, 500, 600, 700, 850),
        FIELDS_EP09,
        """
1 100 78.7/25 57.3/51 48.3/80 43.7/110 41.1/138 39.5/166 37.9/208
1 84 91.6/22 64.8/45 52.9/73 46.7/102 43.2/132 40.9/161 38.8/203
1 69 109.7/18 75.7/39 60.1/64 51.6/93 46.6/122 43.4/152 40.3/195
1 58 129.4/15 88.0/33 68.4/57 57.5/83 50.8/112 46.5/141 42.4/185
1 48 155.4/13 104.5/28 79.9/48 65.9/73 57.2/99 51.4/128 45.7/172
1 40 185.7/11 124.1/24 93.9/41 76.4/63 65.3/87 57.7/114 50.2/156
2 100 158.9/25 116.3/51 98.4/80 89.6/110 84.7/138 81.7/166 79.0/208
2 84 185.0/22 131.4/45 107.9/73 95.8/102 88.9/132 84.7/161 80.8/203
2 69 221.6/18 153.6/39 122.4/64 105.7/93 95.9/122 89.8/152 84.1/195
2 58 261.2/15 178.4/33 139.4/57 117.8/83 104.7/112 96.3/141 88.5/185
2 48 313.7/13 212.0/28 163.0/48 135.1/73 117.8/99 106.3/128 95.4/172
2 40 375.0/11 251.7/24 191.5/41 156.6/63 134.5/87 119.5/114 104.8/156
""",
    ),
    "eu07": (
        (150, 200, 250, 300, 350, 450, 600),
        FIELDS_EE541,
        """
1 100 34.3/43 30.0/65 27.4/88 25.6/113 24.2/137 22.3/187 20.4/265
1 73 40.2/37 34.4/57 30.9/79 28.4/101 26.7/125 24.1/173 21.7/248
1 54 47.5/31 39.8/49 35.2/69 32.0/90 29.7/112 26.4/158 23.4/231
1 41 57.0/26 46.9/42 40.7/60 36.6/79 33.6/99 29.4/142 25.5/211
1 31 68.7/22 55.6/35 47.6/51 42.3/68 38.4/87 33.1/126 28.2/191
1 24 83.1/18 66.3/30 56.1/43 49.3/58 44.3/75 37.6/111 31.5/171
1 18 104.7/14 82.3/24 68.8/35 59.7/48 53.2/62 44.3/94 36.3/148
2 100 69.6/43 61.3/65 56.2/88 52.8/113 50.3/137 46.8/187 43.5/265
2 73 81.6/37 70.3/57 63.4/79 58.7/101 55.3/125 50.7/173 46.4/248
2 54 96.5/31 81.3/49 72.2/69 66.0/90 61.5/112 55.5/158 49.9/231
2 41 115.7/26 95.7/42 83.6/60 75.5/79 69.6/99 61.7/142 54.5/211
2 31 139.6/22 113.5/35 97.8/51 87.2/68 79.7/87 69.4/126 60.2/191
2 24 168.9/18 135.4/30 115.2/43 101.7/58 91.9/75 78.9/111 67.2/171
2 18 212.6/14 168.0/24 141.2/35 123.2/48 110.3/62 93.0/94 77.6/148
""",
    ),
    "et22": (
        (150, 200, 250, 300, 350, 450, 600),
        FIELDS_EE541,
        """
1 100 22.5/65 19.6/98 17.8/133 16.5/169 15.5/206 14.1/281 12.7/397
1 54 31.2/47 26.0/74 22.8/103 20.6/135 19.0/168 16.7/237 14.5/346
1 31 45.1/32 36.3/53 30.9/76 27.3/102 24.6/130 21.0/190 17.5/287
1 18 68.7/21 53.7/36 44.6/53 38.5/72 34.1/94 28.1/141 22.6/222
2 100 46.1/65 40.5/98 37.0/133 34.6/169 32.9/206 30.5/281 28.1/397
2 54 63.8/47 53.7/74 47.5/103 43.3/135 40.3/168 36.1/237 32.2/346
2 31 92.4/32 74.9/53 64.4/76 57.3/102 52.1/130 45.2/190 38.9/287
2 18 140.7/21 110.9/36 92.9/53 80.9/72 72.2/94 60.5/141 50.1/222
3 100 69.6/65 61.3/98 56.2/133 52.8/169 50.3/206 46.8/281 43.5/397
3 54 96.5/47 81.3/74 72.2/103 66.0/135 61.5/168 55.5/237 49.9/346
3 31 139.6/32 113.5/53 97.8/76 87.2/102 79.7/130 69.4/190 60.2/287
3 18 212.6/21 168.0/36 141.2/53 123.2/72 110.3/94 93.0/141 77.6/222
""",
    ),
    # Reconstruction from 0.5 m/s2, 180 A and the rated powers, per metre of way with R = 0.45 ohm, eta = 0.94
    "en57": ((107, 137, 180, 220), {"100": 1.0}, "2 100 57.1/36.8 52.8/50.5 48.8/70.8 46.4/90"),
}


def c_at(drive, current_a, share=1.0):
    """Return the voltage per speed [V s/rev]: straight between the points and from zero to the first."""
    points = drive["magnetisation"]
    x = [0.0, *(point["current_a"] for point in points)]
    y = [0.0, *(point["emf_vs_per_rev"] for point in points)]
    assert np.all(share * np.asarray(current_a) <= x[-1])
    return np.interp(share * np.asarray(current_a, dtype=float), x, y)


def natural_kmh(drive, series, current_a, share=1.0, voltage_v=3000.0):
    rev_per_s = (voltage_v / series - current_a * drive["motor_resistance_ohm"]) / c_at(drive, current_a, share)
    return rev_per_s * math.pi * drive["wheel_diameter_m"] / drive["gear_ratio"] * 3.6


def effort_kn(drive, current_a, share=1.0):
    torque_nm = drive["gear_efficiency"] * c_at(drive, current_a, share) * current_a / (2.0 * math.pi)
    return drive["motors"] * torque_nm * 2.0 * drive["gear_ratio"] / drive["wheel_diameter_m"] / 1000.0


def greatest_effort_kn(vehicle, speed_kmh, voltage_v=3000.0):
    """Return the greatest effort at a speed, over all groupings and field steps; adhesion does not count."""
    drive = vehicle["drive"]
    if drive["kind"] == "inverter":
        limit = drive["power_kw"] * 3.6 / speed_kmh if speed_kmh else math.inf
        return min(drive["starting_effort_kn"], limit)
    found = 0.0
    for grouping in drive["groupings"]:
        held = grouping.get("starting_current_a", drive["starting_current_a"])
        for percent in drive["field_steps_percent"]:
            currents = np.linspace(1.0, held, 4000)
            speeds = natural_kmh(drive, grouping["series"], currents, percent / 100.0, voltage_v)
            current = np.interp(-speed_kmh, -speeds, currents)  # speeds fall with the current
            if speed_kmh <= speeds[-1] and percent < 100:
                continue  # starting resistors go with full field
            found = max(found, float(effort_kn(drive, current, percent / 100.0)))
    return found


def mass_t(name, load_percent=0.0):
    vehicle = read("vehicles", name)
    return vehicle["mass_t"] + vehicle.get("load_t", 0.0) * load_percent / 100.0


def resistance_kn(name, speed_kmh, load_percent=0.0):
    law = {"a_n": 0.0, "b_n_per_kmh": 0.0, "c_n_per_kmh2": 0.0, **read("vehicles", name)["resistance"]}
    specific = (
        law.get("specific_a_n_per_kn", 0.0)
        + law.get("specific_b_n_per_kn_per_kmh", 0.0) * speed_kmh
        + law.get("specific_c_n_per_kn_per_kmh2", 0.0) * speed_kmh**2
    )
    absolute = law["a_n"] + law["b_n_per_kmh"] * speed_kmh + law["c_n_per_kmh2"] * speed_kmh**2
    return (absolute + specific * mass_t(name, load_percent) * G) / 1000.0


def rows(name):
    currents, fields, text = NATURAL[name]
    for line in text.strip().splitlines():
        branches, percent, *cells = line.split()
        for current, cell in zip(currents, cells, strict=True):
            speed, effort = map(float, cell.split("/"))
            yield int(branches), fields[percent], current, speed, effort


@pytest.mark.parametrize("name", VEHICLES)
def test_a_vehicle_reads_and_is_named_as_its_file(name):
    vehicle = read_document(STOCK / "vehicles" / f"{name}.yaml", Vehicle)
    assert vehicle.id == name
    assert vehicle.name
    assert vehicle.source
    assert (vehicle.drive is None) == (vehicle.kind in {"coach", "wagon"})
    assert vehicle.axles is not None
    assert 4.0 <= vehicle.mass_t / vehicle.axles <= HEAVY_AXLES_T.get(name, 22.5)


@pytest.mark.parametrize("name", TRAINS)
def test_a_train_reads_and_its_vehicles_ship(name):
    train = read_document(STOCK / "trains" / f"{name}.yaml", Train)
    assert train.id == name
    assert train.source
    assert train.category in {"passenger", "freight"}
    assert {part.id for part in train.vehicles} <= set(VEHICLES)


def test_what_was_asked_for_is_there():
    assert {"ep09", "eu07", "et22", "en57", "ed250", "vectron-dc", "dragon", "e464", "coach", "e464-coach"} <= set(VEHICLES)
    assert {"ep09-10-coaches", "eu07-7-coaches", "en57", "en57-double", "ed250", "e464-5-coaches"} <= set(TRAINS)
    assert {"et22-freight", "dragon-freight", "vectron-9-coaches", "vectron-freight"} <= set(TRAINS)


def test_the_table_of_the_readme_agrees_with_the_files():
    told = {}
    for line in (STOCK / "README.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("| ").split("|")]
        if re.fullmatch(r"`[\w-]+`", cells[0]):
            told[cells[0].strip("`"), len(cells)] = cells
    for name in VEHICLES:
        cells = told[name, 8]
        vehicle = read("vehicles", name)
        assert float(cells[2].split("+")[0]) == vehicle["mass_t"]
        assert float(cells[5]) == vehicle["max_speed_kmh"]
    for name in TRAINS:
        train = read("trains", name)
        whole = sum(part.get("count", 1) * mass_t(part["id"], part.get("load_percent", 0.0)) for part in train["vehicles"])
        assert float(told[name, 5][2]) == pytest.approx(whole, abs=0.51)


@pytest.mark.parametrize("path", sorted(STOCK.rglob("*.*")), ids=lambda path: path.name)
def test_a_file_names_no_place_of_this_machine(path):
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"/work\b|/tmp\b|\.\./shared|/home/\w|[A-Z]:\\", text)
    if path.suffix == ".yaml":
        assert re.search(r"secondary|recalled|[Aa]ssumed", text), "figures have a source and a status"


@pytest.mark.parametrize("name", sorted(CURVES))
def test_the_magnetisation_curve_is_dense_enough(name):
    drive = read("vehicles", name)["drive"]
    curve, last_a = CURVES[name]
    currents = [point["current_a"] for point in drive["magnetisation"]]
    assert currents == sorted(set(currents))
    assert currents[0] <= 10
    assert currents[-1] >= last_a
    assert max(np.diff(currents)) <= 50
    x = np.linspace(currents[0], last_a, 5000)
    assert c_at(drive, x) == pytest.approx(curve(x), rel=0.003)


@pytest.mark.parametrize("name", sorted(NATURAL))
def test_natural_curves(name):
    drive = read("vehicles", name)["drive"]
    branches = {grouping["parallel"]: grouping["series"] for grouping in drive["groupings"]}
    assert all(parallel * series == drive["motors"] for parallel, series in branches.items())
    percents = [percent / 100.0 for percent in drive["field_steps_percent"]]
    for parallel, share, current, speed, effort in rows(name):
        assert any(share == pytest.approx(percent) for percent in percents)
        case = f"{name}: {parallel} branches, field {share}, {current} A"
        # rounding to 0.1 km/h and 1 kN, and straight lines between points (0.3 %), count where they are more than 2 %
        assert natural_kmh(drive, branches[parallel], current, share) == pytest.approx(speed, rel=0.02), case
        assert effort_kn(drive, current, share) == pytest.approx(effort, rel=0.02, abs=0.5 + 0.003 * effort), case


@pytest.mark.parametrize(
    ("name", "effort", "current_a"),
    # Published: EP09 206 kN (enkol.pl 104E), EU07 280 kN and ET22 411 kN (pl.wikipedia EU07, EP23); the currents lie at the
    # overload relays. EN57: 126.5 t x 1.08 x 0.5 m/s2 + 2.5 kN (pl.wikipedia EN57) at a recalled current.
    [("ep09", 206.0, 844.0), ("eu07", 280.0, 630.0), ("et22", 411.0, 618.0), ("en57", 126.5 * 1.08 * 0.5 + 2.5, 180.0)],
)
def test_starting_effort_of_series_motors(name, effort, current_a):
    drive = read("vehicles", name)["drive"]
    assert drive["starting_current_a"] == current_a
    assert drive["groupings"][0]["parallel"] == 1
    assert effort_kn(drive, current_a) == pytest.approx(effort, rel=0.02)
    lower = [grouping.get("starting_current_a", current_a) for grouping in drive["groupings"]]
    assert max(lower) == current_a


@pytest.mark.parametrize(
    ("name", "current_a", "shaft_kw", "rpm"),
    # Published powers: EP09 2920-2940 and 3180 kW (Wikipedia, enkol.pl), EU07 2000 and 2080, ET22 3000 and 3120 kW
    # (pl.wikipedia), EN57 4 x 145 and 185 kW (pl.wikipedia, cryer.org.uk). Speeds: EE541 950-1000 rpm at 500 kW (exam card
    # of zawodowe.edu.pl; the curve lies 2-7 % below).
    [
        ("ep09", 517.0, 2930.0, None),
        ("ep09", 564.0, 3180.0, None),
        ("eu07", 358.0, 2000.0, 975.0),
        ("eu07", 373.0, 2080.0, None),
        ("et22", 358.0, 3000.0, 975.0),
        ("et22", 373.0, 3120.0, None),
        ("en57", 107.0, 580.0, None),
        ("en57", 137.0, 740.0, None),
    ],
)
def test_published_ratings(name, current_a, shaft_kw, rpm):
    drive = read("vehicles", name)["drive"]
    speed = natural_kmh(drive, 2, current_a)
    at_rail_kw = effort_kn(drive, current_a) * speed / 3.6
    # Shaft power of all motors: iron and friction of a motor take 3.5 %, as in the VL10 whose ratings are all published. The
    # EN57 was rebuilt with its rated powers at the rail.
    shaft = 1.0 if name == "en57" else 0.965 / drive["gear_efficiency"]
    assert at_rail_kw * shaft == pytest.approx(shaft_kw, rel=0.02)
    if rpm:
        turns = speed / 3.6 * drive["gear_ratio"] / (math.pi * drive["wheel_diameter_m"]) * 60.0
        assert turns == pytest.approx(rpm, rel=0.05)


def test_en57_per_metre_of_way():
    drive = read("vehicles", "en57")["drive"]
    for current in (50.0, 107.0, 137.0, 180.0, 220.0):
        per_metre = c_at(drive, current) * drive["gear_ratio"] / (math.pi * drive["wheel_diameter_m"])
        assert per_metre == pytest.approx(132.5 * current / (48.0 + current), rel=0.003)
    assert natural_kmh(drive, 4, 180.0) == pytest.approx(23.0, abs=0.5)  # series ends


@pytest.mark.parametrize("name", ["ep09", "eu07"])
def test_starting_resistors_fall_to_none(name):
    drive = read("vehicles", name)["drive"]
    for grouping, list_name in zip(drive["groupings"], ("series", "parallel"), strict=True):
        ohms = drive["starting_resistors_ohm"][list_name]
        assert ohms == sorted(ohms, reverse=True)
        assert ohms[-1] == 0
        first_a = 3000.0 / (ohms[0] + grouping["series"] * drive["motor_resistance_ohm"])
        assert first_a < grouping.get("starting_current_a", drive["starting_current_a"])
    # currents at standstill on the first notches in series, U / (R + 4 R_m), as worked out from the simulators' lists
    expected = {"ep09": (272, 272, 363, 466, 590, 696), "eu07": (118, 172, 232, 289, 344, 399, 423, 451, 481, 515)}[name]
    series = drive["starting_resistors_ohm"]["series"]
    circuit = 0.01 if name == "eu07" else 0.0  # of a branch; the file leaves it out and says so
    found = [3000.0 / (ohm + circuit + 4 * drive["motor_resistance_ohm"]) for ohm in series[: len(expected)]]
    assert found == pytest.approx(expected, rel=0.005)


@pytest.mark.parametrize(
    ("name", "effort", "power", "v_break"),
    [  # effort [kN], power [kW], speed where the two meet [km/h]; ED250 0.49 m/s2 x 410 t x 1.04, EN97 and EN100 1.2 m/s2 x 1.08
        ("vectron-dc", 300.0, 5200.0, 62.4),
        ("dragon", 410.0, 5000.0, 43.9),
        ("e464", 200.0, 3500.0, 63.0),
        ("ed250", 0.49 * 410 * 1.04, 5664.0, 97.6),
        ("en97", 1.2 * 101.5 * 1.08, 1440.0, 39.4),
        ("en100", 1.2 * 111.9 * 1.08, 1440.0, 35.8),
    ],
)
def test_inverter_vehicles(name, effort, power, v_break):
    drive = read("vehicles", name)["drive"]
    assert drive["starting_effort_kn"] == pytest.approx(effort, rel=0.002)
    assert drive["power_kw"] == power
    assert drive["power_kw"] / drive["starting_effort_kn"] * 3.6 == pytest.approx(v_break, abs=0.1)
    if "max_current_a" in drive:  # of a train on Polish lines at most 3200 A (Szelag 2017); nearly the full power at 3 kV
        assert power / drive["efficiency"] / 3.0 <= drive["max_current_a"] <= 3200


@pytest.mark.parametrize(
    ("name", "speed_kmh", "expected_kn"),
    # Davis worked out by hand with A 10 m2 and cd 0.8: EP09 1048 + 27.5 v + 4.6 v2 N, EU07 7.5 kN at 125 km/h
    [("ep09", 160.0, 11.4), ("eu07", 125.0, 7.5), ("e464", 100.0, (1.625 + 2.05) * 72 * G / 1000)],
)
def test_running_resistance(name, speed_kmh, expected_kn):
    assert resistance_kn(name, speed_kmh) == pytest.approx(expected_kn, rel=0.01)


def test_running_resistance_of_coach_and_wagon():
    v = 160.0 / 3.6
    m = mass_t("coach", 60.0)
    assert resistance_kn("coach", 160.0, 60.0) * 1000 == pytest.approx(
        6.374 * m + 129.0 * 4 + 0.329 * m * v + 0.815 * v**2, rel=0.002
    )
    v, m = 80.0 / 3.6, mass_t("wagon-eaos", 100.0)
    expected = 7.355 * m + 80.6 * 4 + 0.1645 * m * v + 1.2 * v**2
    assert resistance_kn("wagon-eaos", 80.0, 100.0) * 1000 == pytest.approx(expected, rel=0.002)


def test_eu07_hauls_what_is_published():
    # 650 t at 125 km/h, 2000 t at 70 km/h on the level (wikimili.com, PKP class EU07)
    eu07 = read("vehicles", "eu07")
    coaches = 650.0 / mass_t("coach", 60.0) * resistance_kn("coach", 125.0, 60.0)
    assert greatest_effort_kn(eu07, 125.0) >= coaches + resistance_kn("eu07", 125.0)
    wagons = 2000.0 / mass_t("wagon-eaos", 100.0) * resistance_kn("wagon-eaos", 70.0, 100.0)
    assert greatest_effort_kn(eu07, 70.0) >= wagons + resistance_kn("eu07", 70.0)


@pytest.mark.parametrize("name", TRAINS)
def test_a_train_reaches_its_speed_on_the_level(name):
    parts = read("trains", name)["vehicles"]
    vehicles = [(read("vehicles", part["id"]), part.get("count", 1)) for part in parts]
    top = min(vehicle["max_speed_kmh"] for vehicle, _ in vehicles)
    effort = sum(count * greatest_effort_kn(vehicle, 0.97 * top) for vehicle, count in vehicles if "drive" in vehicle)
    drag = sum(part.get("count", 1) * resistance_kn(part["id"], 0.97 * top, part.get("load_percent", 0.0)) for part in parts)
    assert effort > drag


def test_the_train_of_the_e464_study():
    # M. Alice 2018: 296.4 t, 309.45 t with rotating masses, 190 kW of auxiliaries
    parts = [(read("vehicles", part["id"]), part) for part in read("trains", "e464-5-coaches")["vehicles"]]
    inertia = power = 0.0
    for vehicle, part in parts:
        load = vehicle.get("load_t", 0.0) * part.get("load_percent", 0.0) / 100.0
        inertia += part.get("count", 1) * (vehicle["rotating_mass_factor"] * vehicle["mass_t"] + load)
        power += part.get("count", 1) * vehicle["auxiliaries"]["power_kw"]
    assert sum(part.get("count", 1) * mass_t(part["id"], part.get("load_percent", 0.0)) for _, part in parts) == pytest.approx(
        296.4
    )
    assert inertia == pytest.approx(309.45)
    assert power == 190
    # the electric brake gives 0.3 of the braking force
    assert parts[0][0]["brake"]["electric_effort_kn"] == pytest.approx(0.3 * 309.45 * 0.2585, rel=0.002)


@pytest.mark.parametrize(("name", "hauled_t"), [("et22-freight", 2000.0), ("dragon-freight", 3000.0)])
def test_freight_trains_have_the_mass_they_are_for(name, hauled_t):
    wagons = [part for part in read("trains", name)["vehicles"] if "wagon" in part["id"]]
    assert sum(part["count"] * mass_t(part["id"], part["load_percent"]) for part in wagons) == pytest.approx(hauled_t, rel=0.02)


def test_the_electric_brake_of_the_ep09():
    # 5.8 ohm for each branch of two motors at 500 A (MaSzyna vehicle code)
    ep09 = read("vehicles", "ep09")
    drive, brake = ep09["drive"], ep09["brake"]
    generated_kw = 2 * 500.0**2 * (5.8 + 2 * 0.07) / 1000.0
    assert brake["rheostat_kw"] == pytest.approx(2 * 500.0**2 * 5.8 / 1000.0)
    assert brake["electric_power_kw"] == pytest.approx(generated_kw / drive["gear_efficiency"], rel=0.002)
    assert brake["electric_effort_kn"] == pytest.approx(effort_kn(drive, 500.0) / drive["gear_efficiency"] ** 2, rel=0.005)
    assert brake["electric_power_kw"] * brake["efficiency"] <= brake["rheostat_kw"]


def test_the_examples_of_the_readme_read(tmp_path):
    blocks = re.findall(r"```yaml\n(.*?)```", (STOCK / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 2
    for block, model in zip(blocks, (Vehicle, Train), strict=True):
        path = tmp_path / "example.yaml"
        path.write_text(block, encoding="utf-8")
        assert read_document(path, model).id.startswith("my-")

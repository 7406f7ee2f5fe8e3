"""Import of railtoolkit and TrainRuns: forces of its snapshots by the imported vehicles, its own steps, bad files told."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

import tractionpower
from tractionpower.io.imports.railtoolkit.reading import read_railtoolkit
from tractionpower.io.scenario_files import load
from tractionpower.io.text_files import write_files

ROOT = Path(__file__).parents[4]
CASE = ROOT / "validation" / "trainruns"
SOURCE = CASE / "source"
EXAMPLES = ROOT / "tests" / "data" / "railtoolkit"
TRAINS = {"freight": "Fr100", "local": "RB50-1"}
GRAVITY = 9.80665
WORDS = ("behavior", "label", "measure")


@pytest.fixture(scope="module")
def scenario():
    return load(CASE)


def points(train, path):
    with (SOURCE / "snapshots" / "poi" / f"{train}_{path}.csv").open(encoding="utf-8", newline="") as file:
        return [{key: cell if key in WORDS else float(cell) for key, cell in row.items()} for row in csv.DictReader(file)]


def members(scenario, train):
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    (formation,) = [item for item in scenario.trains if item.id == train]
    return [(vehicles[part.id], part.count, vehicles[part.id].load_t * part.load_percent / 100) for part in formation.vehicles]


def drive_of(scenario, train):
    (drive,) = [vehicle.drive for vehicle, _, _ in members(scenario, train) if vehicle.drive is not None]
    return [point.speed_kmh for point in drive.effort], [1000 * point.effort_kn for point in drive.effort]


def force_n(scenario, train, v, *, powered):
    """Return the running resistance of all powered, or all other vehicles of a train [N], v in km/h."""
    total = 0.0
    for vehicle, count, load_t in members(scenario, train):
        of, weight = vehicle.resistance, (vehicle.mass_t + load_t) * GRAVITY
        if (vehicle.drive is not None) == powered:
            a = of.a_n + of.specific_a_n_per_kn * weight
            b = of.b_n_per_kmh + of.specific_b_n_per_kn_per_kmh * weight
            c = of.c_n_per_kmh2 + of.specific_c_n_per_kn_per_kmh2 * weight
            total += count * (a + b * v + c * v**2)
    return total


def accelerated_t(scenario, train):
    return sum(count * (item.mass_t * item.rotating_mass_factor + load) for item, count, load in members(scenario, train))


@pytest.mark.parametrize("train", TRAINS)
@pytest.mark.parametrize("path", ["const", "slope"])
def test_resistances_are_those_of_the_snapshots(scenario, train, path):
    for row in points(train, path):
        v = row["v"] * 3.6
        assert force_n(scenario, TRAINS[train], v, powered=True) == pytest.approx(row["R_traction"], rel=1e-8)
        assert force_n(scenario, TRAINS[train], v, powered=False) == pytest.approx(row["R_wagons"], rel=1e-8)


@pytest.mark.parametrize("train", TRAINS)
def test_efforts_are_those_of_the_snapshots(scenario, train):
    speeds, efforts = drive_of(scenario, TRAINS[train])
    driven = [row for row in points(train, "slope") if row["behavior"] == "accelerating"]
    assert len(driven) >= 3
    for row in driven:
        assert np.interp(row["v"] * 3.6, speeds, efforts) == pytest.approx(row["F_T"], rel=1e-9)


def test_rotating_masses(scenario):
    assert accelerated_t(scenario, "RB50-1") == pytest.approx(88 * 1.08)
    assert accelerated_t(scenario, "Fr100") == pytest.approx(80 * 1.09 + 840 * 1.03)


@pytest.mark.parametrize("train", TRAINS)
def test_steps_of_20_m_make_the_difference_at_the_start(scenario, train):
    """TrainRuns' own method: with its steps its snapshot to all digits, with short ones the journey of this program."""
    speeds, efforts = drive_of(scenario, TRAINS[train])
    factor = {"freight": (80 * 1.09 + 250 * 1.03) / 330 * 920e3, "local": 1.08 * 88e3}[train]

    def passed(step_m, inertia_kg, to_m=850.0):
        s = v = t = 0.0
        while s < to_m - 1e-9:
            h = min(step_m, to_m - s)
            w = sum(force_n(scenario, TRAINS[train], v * 3.6, powered=powered) for powered in (True, False))
            a = (np.interp(v * 3.6, speeds, efforts) - w) / inertia_kg
            faster = math.sqrt(v * v + 2 * h * a)
            t, s, v = t + (faster - v) / a, s + h, faster
        return t

    (seen,) = [row["t"] for row in points(train, "slope") if row["label"] == "view_point_1"]
    assert passed(20.0, factor) == pytest.approx(seen, rel=1e-8)
    fine = passed(0.5, accelerated_t(scenario, TRAINS[train]) * 1000)
    assert fine - seen > 1.5
    calls = tractionpower.journeys(scenario, runs=[f"{TRAINS[train]} slope"]).table("calls")
    (ours,) = calls[calls["station"] == "slope view_point_1"]["actual_s"] - 8 * 3600
    assert ours == pytest.approx(fine, rel=2e-3)


def test_the_case_is_what_the_import_gives():
    imported = read_railtoolkit(SOURCE)
    assert imported.notes.problems == []
    made = {name: text for name, text in imported.texts.items() if name != "README.md"}
    for name, text in made.items():
        assert (CASE / name).read_text(encoding="utf-8") == text, name
    kept = {path.relative_to(CASE).as_posix() for path in CASE.rglob("*.yaml")}
    assert {name for name in kept if not name.startswith("source/")} == {*made, "case.yaml"}
    assert any("path_schema_2022.json: path const, the same as in" in note for note in imported.notes.ignored)


def test_the_rear_passes_a_train_length_later(scenario):
    places = {station.id: station.km for station in scenario.line.stations}
    assert places["const point_3 rear of Fr100"] == pytest.approx(3.3333 + 0.01432 + 10 * 0.01904)
    assert places["const point_3 rear of RB50-1"] == pytest.approx(3.375)


def test_the_newer_form_with_keys(tmp_path):
    imported = read_railtoolkit(EXAMPLES)
    assert [(problem.code, problem.severity) for problem in imported.notes.problems] == [("doubtful_unit", "warning")]
    write_files(tmp_path, imported.texts)
    scenario = load(tmp_path)
    assert tractionpower.check(scenario) == []
    assert [row.permille for row in scenario.line.gradients] == [0, 1, 2, 5, -3, 5, -10, 15, -10, 20, 0]
    places = {station.id: station.km for station in scenario.line.stations}
    assert places["A:platform middle of RB50-1"] == pytest.approx(5.5 + 0.0417)
    assert places["1:clearing point rear of RB50-1"] == pytest.approx(9.05 + 0.0834)
    assert scenario.trains[0].vehicles[0].count == 2


@pytest.mark.parametrize("train", ["freight", "local", "longdistance"])
def test_a_train_alone_gives_rolling_stock(train):
    imported = read_railtoolkit(SOURCE / "trains" / f"{train}.yaml")
    assert imported.notes.problems == []
    assert imported.texts
    assert all(name.startswith("rollingstock/") for name in imported.texts)


def test_a_path_and_a_train_from_two_files(tmp_path):
    imported = read_railtoolkit(SOURCE / "paths" / "slope.yaml", train=SOURCE / "trains" / "local.yaml")
    write_files(tmp_path, imported.texts)
    scenario = load(tmp_path)
    assert [problem.severity for problem in tractionpower.check(scenario)] == ["warning"]  # its effort table rises at 64 km/h
    assert [(run.id, len(run.calls)) for run in scenario.runs] == [("RB50-1 slope", 6)]
    (problem,) = read_railtoolkit(SOURCE / "paths" / "slope.yaml", train=tmp_path / "none.yaml").notes.problems
    assert problem.code == "no_file"


def test_passenger_coaches_have_head_wind(scenario):
    # Sauthoff's form in TrainRuns.jl: f0 + f1 V/100 + f2 ((V + 15)/100)²
    (coach,) = [vehicle for vehicle in scenario.vehicles if vehicle.id == "DABpza68"]
    of, v = coach.resistance, 120.0
    told = of.specific_a_n_per_kn + of.specific_b_n_per_kn_per_kmh * v + of.specific_c_n_per_kn_per_kmh2 * v * v
    assert told == pytest.approx(2.0 + 0.715 * 1.2 + 3.64 * 1.35**2, rel=1e-9)


def spoilt(folder, path, change):
    data = YAML(typ="safe").load(path)
    change(data)
    folder.mkdir(exist_ok=True)
    with (folder / path.name).open("w", encoding="utf-8") as file:
        YAML(typ="safe").dump(data, file)
    return folder / path.name


def test_problems_come_all_at_once(tmp_path):
    def spoil(data):
        data["vehicles"][0]["mass"] = "heavy"
        data["vehicles"][0]["tractive_effort"][3] = [3.0]
        data["vehicles"][0]["vehicle_type"] = "tram"
        del data["vehicles"][0]["length"]
        data["trains"][0]["formation"] = []

    imported = read_railtoolkit(spoilt(tmp_path, SOURCE / "trains" / "local.yaml", spoil))
    assert imported.texts == {}
    assert {(problem.path, problem.code) for problem in imported.notes.problems} == {
        ("vehicles[DB_BR_642].mass", "wrong_type"),
        ("vehicles[DB_BR_642].tractive_effort[3]", "bad_row"),
        ("vehicles[DB_BR_642].vehicle_type", "bad_choice"),
        ("vehicles[DB_BR_642].length", "missing_key"),
        ("trains[RB50-1].formation", "empty_list"),
    }
    assert all(problem.place.startswith("local.yaml:") for problem in imported.notes.problems)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda data: data["trains"][0]["formation"].append("ghost"), "unknown_vehicle"),
        (lambda data: data["trains"][0].update(formation=["Facs124"]), "no_drive"),
        (lambda data: data.update(schema_version="2031.01"), "bad_choice"),
        (lambda data: data.update(schema="https://example.org/schema.json"), "unknown_kind"),
    ],
)
def test_trains_that_make_no_sense(change, code, tmp_path):
    imported = read_railtoolkit(spoilt(tmp_path, SOURCE / "trains" / "freight.yaml", change))
    assert imported.texts == {}
    assert [problem.code for problem in imported.notes.problems] == [code]


def test_sections_out_of_order_are_put_in_order_only_when_asked(tmp_path):
    def swap(data):
        rows = data["paths"][0]["characteristic_sections"]
        rows[4], rows[5] = rows[5], rows[4]

    path = SOURCE / "paths" / "slope.yaml"
    copy = spoilt(tmp_path, path, swap)
    (problem,) = read_railtoolkit(copy).notes.problems
    assert (problem.code, problem.path) == ("not_rising", "paths[slope].characteristic_sections[5]")
    mended = read_railtoolkit(copy, repair=True)
    assert mended.notes.repaired
    assert mended.texts["line.yaml"] == read_railtoolkit(path).texts["line.yaml"]


def test_a_first_section_without_speed_is_told(tmp_path):
    def bare(data):
        del data["paths"][0]["characteristic_sections"][0]["speed"]

    (problem,) = read_railtoolkit(spoilt(tmp_path, EXAMPLES / "running-path.example.yaml", bare)).notes.problems
    assert (problem.code, problem.path) == ("missing_key", "paths[example].characteristic_sections[0].speed")


def test_sections_keep_what_they_do_not_name(tmp_path):
    def bare(data):
        del data["paths"][0]["characteristic_sections"][3]["resistance"]
        del data["paths"][0]["characteristic_sections"][8]["speed"]

    imported = read_railtoolkit(spoilt(tmp_path, EXAMPLES / "running-path.example.yaml", bare))
    assert any("2 sections without speed or resistance" in note for note in imported.notes.assumed)
    write_files(tmp_path / "study", imported.texts)
    line = load(tmp_path / "study").line
    assert line.gradients[3].permille == 2.0
    assert line.speed_limits[8].kmh == 80.0


def test_a_label_that_stands_twice_makes_two_places(tmp_path):
    def twice(data):
        for row in data["paths"][0]["points_of_interest"][:2]:
            row["label"] = "signal"

    texts = read_railtoolkit(spoilt(tmp_path, EXAMPLES / "running-path.example.yaml", twice)).texts
    write_files(tmp_path / "study", texts)
    scenario = load(tmp_path / "study")
    places = {station.id: station.km for station in scenario.line.stations}
    assert [places[call.station] for call in scenario.runs[0].calls[:2]] == [0.85, 1.0]


def test_two_files_with_different_vehicles_of_one_name(tmp_path):
    path = SOURCE / "trains" / "local.yaml"
    spoilt(tmp_path / "a", path, lambda data: data["vehicles"][0].update(mass=70.0))
    spoilt(tmp_path / "b", path, lambda data: None)
    assert {problem.path for problem in read_railtoolkit(tmp_path).notes.problems} == {"vehicles[DB_BR_642]", "trains[RB50-1]"}


def test_nothing_to_read(tmp_path):
    assert [problem.code for problem in read_railtoolkit(tmp_path / "none.yaml").notes.problems] == ["no_file"]
    assert [problem.code for problem in read_railtoolkit(tmp_path).notes.problems] == ["no_file"]

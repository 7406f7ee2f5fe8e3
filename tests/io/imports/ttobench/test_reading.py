"""Import of TTOBench: every file of it becomes a study without problems, numbers are those of the JSON, bad files are told."""

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest

import tractionpower
from tractionpower.io.imports.ttobench.reading import read_ttobench
from tractionpower.io.text_files import write_files

DATA = Path(__file__).parents[3] / "data" / "ttobench"
TRACKS = sorted((DATA / "tracks").glob("*.json"))
TRAINS = sorted((DATA / "trains").glob("*.json"))
JOURNEY = DATA / "journeys" / "CH_StGallen_Wil_Journey_01.json"
FLIRT = DATA / "trains" / "CH_Stadler_FLIRT_TPF.json"
FRIBOURG = DATA / "tracks" / "CH_Fribourg_Bern.json"


def content(path):
    return json.loads(path.read_text(encoding="utf-8"))


def study_of(imported, folder):
    assert imported.notes.problems == []
    write_files(folder, imported.texts)
    scenario = tractionpower.load(folder)
    assert tractionpower.check(scenario) == []
    return scenario


def changed(tmp_path, path, change):
    """Return a copy of a file of TTOBench with a change, in a folder without others."""
    data = content(path)
    change(data)
    copy = tmp_path / "files" / path.name
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(json.dumps(data, indent=1), encoding="utf-8")
    return copy


def lengths(rows, end):
    """Return each row that begins before the end, with the length for which it holds."""
    rows = [row for row in rows if row[0] < end]
    ends = [*(row[0] for row in rows[1:]), end]
    return [(row, after - row[0]) for row, after in zip(rows, ends, strict=True)]


def test_the_data_are_complete():
    assert (len(TRACKS), len(TRAINS), JOURNEY.is_file()) == (11, 3, True)
    assert "BSD 2-Clause License" in (DATA / "LICENSE.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", TRACKS, ids=lambda path: path.stem)
def test_every_track_becomes_a_study(path, tmp_path):
    source, line = content(path), study_of(read_ttobench(path), tmp_path).line
    stops = source["stops"]["values"]
    assert [station.km * 1000 for station in line.stations] == pytest.approx(stops)
    assert (line.tracks[0].from_km, line.tracks[0].to_km * 1000) == (0.0, pytest.approx(stops[-1]))
    assert [row.kmh for row in line.speed_limits] == [row[1] for row, _ in lengths(source["speed limits"]["values"], stops[-1])]
    rise = sum(row[1] * length for row, length in lengths(source["gradients"]["values"], stops[-1]))
    assert sum(row.permille * (row.to_km - row.from_km) for row in line.gradients) == pytest.approx(rise / 1000.0)
    assert all(before.to_km == after.from_km for before, after in pairwise(line.gradients))


def test_curves_turn_by_the_same_angle(tmp_path):
    path = DATA / "tracks" / "CH_StGallen_Wil.json"
    source, line = content(path), study_of(read_ttobench(path), tmp_path).line
    turned = 0.0
    for (_, first, last), length in lengths(source["curvatures"]["values"], source["stops"]["values"][-1]):
        ends = [0.0 if radius == "infinity" else 1.0 / radius for radius in (first, last)]
        # the integral of |curvature|, by a sum of many parts
        turned += length * sum(abs(ends[0] + (ends[1] - ends[0]) * (k + 0.5) / 1000) for k in range(1000)) / 1000
    assert turned > math.pi
    assert sum(1000 * (row.to_km - row.from_km) / row.radius_m for row in line.curves) == pytest.approx(turned, rel=1e-3)


@pytest.mark.parametrize("path", TRAINS, ids=lambda path: path.stem)
def test_every_train_becomes_a_vehicle(path, tmp_path):
    scenario = study_of(read_ttobench(DATA / "tracks" / "00_reference.json", train=path), tmp_path)
    assert sorted(read_ttobench(path).texts) == [f"rollingstock/{kind}/{path.stem}.yaml" for kind in ("trains", "vehicles")]
    (vehicle,) = scenario.vehicles
    source = {key: item["value"] for key, item in content(path).items() if "value" in item}
    r0, r1, r2 = (source[f"rolling resistance r{k}"] for k in range(3))
    inertia_t = source["mass"] * (1 + source["rho"] / 100) / 1000
    assert vehicle.mass_t * vehicle.rotating_mass_factor == pytest.approx(inertia_t)
    for v in (0.0, 50.0, source["max speed"]):
        of = vehicle.resistance
        assert (of.a_n + of.b_n_per_kmh * v + of.c_n_per_kmh2 * v * v) / 1000 == pytest.approx(r0 + r1 * v + r2 * v * v, rel=1e-9)
    assert vehicle.drive.power_kw == source["max traction power"]
    assert vehicle.drive.efficiency == pytest.approx(source["efficiency traction"] / 100)
    assert vehicle.brake.efficiency == pytest.approx(source["efficiency reg brake"] / 100)
    assert vehicle.brake.electric_power_kw == source["max reg braking power"]
    assert vehicle.brake.electric_effort_kn == source["max reg braking force"]
    most = min(source.get("max acceleration", math.inf), (source["max traction force"] - r0) / inertia_t)
    assert (vehicle.drive.starting_effort_kn - r0) / inertia_t == pytest.approx(most)
    assert scenario.trains[0].mass_distribution == ("uniform" if "length" in source else "point")


def test_tunnels_follow_the_cross_sections_of_the_train(tmp_path):
    scenario = study_of(read_ttobench(DATA / "tracks" / "00_reference_with_tunnels.json", train=FLIRT), tmp_path)
    told = [(row.from_km, row.to_km, row.kind) for row in scenario.line.tunnels]
    assert told == [(7.0, 8.05, "double_track"), (20.0, 25.05, "single_track")]
    of = scenario.vehicles[0].resistance
    assert of.c_n_per_kmh2 * (of.tunnel_factor_single_track - 1) == pytest.approx(1.1698)
    assert of.c_n_per_kmh2 * (of.tunnel_factor_double_track - 1) == pytest.approx(0.5579)


def test_a_journey_keeps_its_windows(tmp_path):
    imported = read_ttobench(JOURNEY)
    calls = study_of(imported, tmp_path).timetable.trains[0].calls
    start = calls[0].departure

    def after(time):
        return None if time is None else time - start

    assert [(call.station, call.stops, after(call.arrival), after(call.departure)) for call in calls] == [
        ("Stop 1", True, None, 0.0),
        ("Point 12.5", False, 540.0, None),
        ("Point 15", True, 680.0, 800.0),
        ("Point 20", False, 1250.0, None),
        ("Stop 2", True, 1450.0, None),
    ]
    assert any("earliest times of 4" in note for note in imported.notes.ignored)
    assert any("speed constraints at 1" in note for note in imported.notes.ignored)


def test_what_is_left_out_is_told():
    notes = read_ttobench(FLIRT).notes
    assert {"num seats", "num coaches", "ETCS braking data"} <= {note.rpartition(": ")[2] for note in notes.ignored}
    assert any("150 kN in place of 200 kN" in note for note in notes.assumed)


def test_units_are_those_of_the_file(tmp_path):
    def other_units(data):
        data["stops"] = {"unit": "km", "values": [x / 1000 for x in data["stops"]["values"]]}
        data["speed limits"]["units"] = {"position": "km", "velocity": "m/s"}
        data["speed limits"]["values"] = [[x / 1000, v / 3.6] for x, v in data["speed limits"]["values"]]
        data["gradients"]["units"]["slope"] = "%"
        data["gradients"]["values"] = [[x, slope / 10] for x, slope in data["gradients"]["values"]]

    path = DATA / "tracks" / "CN_Songjiazhuang_Yizhuang.json"
    copy = read_ttobench(changed(tmp_path, path, other_units), train=FLIRT)
    assert copy.texts["line.yaml"] == read_ttobench(path, train=FLIRT).texts["line.yaml"]


def test_problems_come_all_at_once_with_file_and_line(tmp_path):
    def spoil(data):
        data["stops"]["unit"] = "mile"
        data["speed limits"]["values"][0] = [0.0, "fast"]
        data["gradients"]["values"][1] = [10.0]
        del data["metadata"]["id"]

    imported = read_ttobench(changed(tmp_path, FRIBOURG, spoil), train=FLIRT)
    assert imported.texts == {}
    assert {(problem.path, problem.code) for problem in imported.notes.problems} == {
        ("metadata.id", "missing_key"),
        ("stops.unit", "bad_choice"),
        ("[speed limits].values[0]", "bad_row"),
        ("gradients.values[1]", "bad_row"),
    }
    assert all(problem.place.startswith("CH_Fribourg_Bern.json:") for problem in imported.notes.problems)


def swap(data):
    rows = data["gradients"]["values"]
    rows[2], rows[3] = rows[3], rows[2]


def cut(data):
    data["speed limits"]["values"][0][0] = 100.0


@pytest.mark.parametrize(("change", "code"), [(swap, "not_rising"), (cut, "gap")])
def test_repair_mends_only_when_asked(change, code, tmp_path):
    copy = changed(tmp_path, FRIBOURG, change)
    refused = read_ttobench(copy, train=FLIRT)
    assert refused.texts == {}
    assert {problem.code for problem in refused.notes.problems} == {code}
    mended = read_ttobench(copy, train=FLIRT, repair=True)
    assert mended.notes.problems == []
    assert len(mended.notes.repaired) == 1
    assert mended.texts["line.yaml"] == read_ttobench(FRIBOURG, train=FLIRT).texts["line.yaml"]


def test_a_journey_beyond_its_track_is_refused(tmp_path):
    def beyond(data):
        data["timing points"]["values"][-1][0] = 40000.0

    copy = changed(tmp_path, JOURNEY, beyond)
    (alone,) = read_ttobench(copy).notes.problems
    assert (alone.code, alone.path) == ("no_file", "metadata.associated track")
    problems = read_ttobench(copy, track=DATA / "tracks" / "CH_StGallen_Wil.json").notes.problems
    assert [problem.code for problem in problems] == ["off_track"]


def test_a_slope_that_no_study_may_have_is_a_problem(tmp_path):
    def steep(data):
        data["gradients"]["values"][0][1] = 150.0

    (problem,) = read_ttobench(changed(tmp_path, FRIBOURG, steep)).notes.problems
    assert (problem.code, problem.path) == ("not_allowed", "gradients.0.permille")


def test_a_track_longer_than_any_line_is_a_problem(tmp_path):
    def far(data):
        data["stops"]["values"][-1] = 1e30

    (problem,) = read_ttobench(changed(tmp_path, FRIBOURG, far), train=FLIRT).notes.problems
    assert (problem.code, problem.path) == ("absurd_length", "track 1")


@pytest.mark.parametrize(
    ("text", "code"),
    [("", "empty_file"), ("[1, 2]", "not_a_mapping"), ('{"a": 1}', "unknown_kind"), ('{"stops": [', "syntax_error")],
)
def test_files_of_another_kind_are_refused(text, code, tmp_path):
    (tmp_path / "file.json").write_text(text, encoding="utf-8")
    imported = read_ttobench(tmp_path / "file.json")
    assert imported.texts == {}
    assert [problem.code for problem in imported.notes.problems] == [code]


def test_a_folder_is_no_file():
    (problem,) = read_ttobench(DATA).notes.problems
    assert (problem.code, problem.found) == ("no_file", "a folder")
    assert "tracks/CH_Fribourg_Bern.json" in problem.allowed

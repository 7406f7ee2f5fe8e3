"""Fribourg - Bern: what is real of it is what the import of TTOBench gives, and its trains keep their times."""

from pathlib import Path

import pytest

import tractionpower
from tractionpower.io.imports.ttobench.reading import read_ttobench
from tractionpower.io.text_files import write_files

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "lines" / "fribourg-bern"
TTOBENCH = ROOT / "tests" / "data" / "ttobench"


@pytest.fixture(scope="module")
def shipped():
    return tractionpower.load(FOLDER)


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("imported")
    track, train = TTOBENCH / "tracks" / "CH_Fribourg_Bern.json", TTOBENCH / "trains" / "CH_Stadler_FLIRT_TPF.json"
    write_files(folder, read_ttobench(track, train=train).texts)
    return tractionpower.load(folder)


def test_nothing_is_wrong_or_doubtful(shipped):
    assert tractionpower.check(shipped) == []


def test_profile_and_limits_are_those_of_the_source(shipped, imported):
    assert shipped.line.gradients == imported.line.gradients
    assert shipped.line.speed_limits == imported.line.speed_limits
    assert [station.km for station in shipped.line.stations] == [station.km for station in imported.line.stations]
    assert sum(row.permille * (row.to_km - row.from_km) for row in shipped.line.gradients) == pytest.approx(-92.0, abs=3.0)


def test_the_train_is_that_of_the_source(shipped, imported):
    (ours,), (theirs,) = shipped.vehicles, imported.vehicles
    same = ("mass_t", "length_m", "max_speed_kmh", "rotating_mass_factor")
    assert [getattr(ours, name) for name in same] == [getattr(theirs, name) for name in same]
    for name, value in theirs.resistance:
        assert getattr(ours.resistance, name) == pytest.approx(value, rel=1e-6)
    for name in ("starting_effort_kn", "power_kw", "efficiency"):
        assert getattr(ours.drive, name) == pytest.approx(getattr(theirs.drive, name))
    for name in ("electric_effort_kn", "electric_power_kw", "efficiency"):
        assert getattr(ours.brake, name) == getattr(theirs.brake, name)


def test_the_licence_stands_beside_the_data():
    licence = (FOLDER / "source" / "LICENSE-ttobench.txt").read_bytes()
    assert licence == (TTOBENCH / "LICENSE.txt").read_bytes()
    assert "BSD-2" in (FOLDER / "README.md").read_text(encoding="utf-8") or b"BSD 2-Clause" in licence


FLAT_OUT = ('timetable.driving={"kind": "flat_out"}',)


def arrivals_of(results):
    calls = results.table("calls")
    return calls[calls["kind"] == "arrival"]


def test_flat_out_every_train_is_two_minutes_early(shipped):
    arrivals = arrivals_of(tractionpower.journeys(tractionpower.change(shipped, FLAT_OUT)))
    assert len(arrivals) == len(shipped.runs) == 14
    # 21 minutes planned: at least a tenth of the shortest running time is in reserve
    assert (arrivals["late_s"] < -0.1 * 1120).all()
    assert (arrivals["late_s"] > -180).all()


def test_driven_to_time_every_train_arrives_on_time_and_needs_a_quarter_less(shipped):
    saving, flat = tractionpower.simulate(shipped), tractionpower.simulate(tractionpower.change(shipped, FLAT_OUT))
    assert arrivals_of(saving)["late_s"].abs().max() < 1.0
    delivered = [float(results.table("substations")["power_kw"].sum()) / 3600.0 for results in (saving, flat)]
    assert delivered[1] == pytest.approx(4320.0, rel=0.02)
    assert delivered[0] < 0.75 * delivered[1]


def test_trains_run_half_hourly_each_way(shipped):
    for track in ("1", "2"):
        starts = [run.calls[0].departure for run in shipped.runs if run.route[0].track == track]
        assert len(starts) == 7
        assert {after - before for before, after in zip(sorted(starts), sorted(starts)[1:], strict=False)} == {1800.0}

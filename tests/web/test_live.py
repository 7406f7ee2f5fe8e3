"""A driven run: nothing is lost, and running the driven case again gives the same numbers."""

import json

import pandas as pd
import pytest
from chains import pulled

from tractionpower.dynamics.run import CaseRun
from tractionpower.errors import InputError, OutputError
from tractionpower.io.dynamics_files import load_case
from tractionpower.results.kept import input_hash_of
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.web import live as live_module
from tractionpower.web.controls import Controls
from tractionpower.web.desk import Desk
from tractionpower.web.hello import has_independent_brake, hello, highest_levels
from tractionpower.web.live import LiveRun
from tractionpower.web.orders import Action, SetFactor, SetLevel
from tractionpower.web.pacing import Pacer
from tractionpower.web.quantities import CHARTS

POINT = ("time_s", *(name for chart in CHARTS for name in chart))

STIFF = {"draw": {"stiffness_kn_per_mm": 5.0}, "damping_kns_per_m": 50.0, "slack_mm": 20.0}
BRAKED = {"traction": {}, "brake": {"brake_ratio": 0.6}, "commands": [{"time_s": 0.0, "drive": 2}, {"time_s": 3.0, "drive": 0}]}


def scenario(**more):
    run = {"duration_s": 30.0, "step_s": 0.01, "record_every_s": 0.07}
    return pulled(4, STIFF, **{**BRAKED, "run": run, **more})


def new_live(folder, given=None):
    given = given or scenario()
    writer = RunWriter(folder, "test-driven", input_hash_of(given), kind="dynamics", scenario=given)
    return LiveRun(given, writer, "test-driven")


def drive_by_clock(live, plan, frames):
    """Drive from a desk whose clock stands still but for its waiting; `plan` gives orders by the number of frames before them."""
    told, now = [], [0.0]

    def publish(kind, content):
        if kind == "frame":
            told.append(content)
            for order in plan.get(len(told), ()):
                desk.order(order)
            if len(told) >= frames:
                desk.stop()

    def sleep(seconds):
        now[0] += seconds

    compiled = live.session.compiled
    controls = Controls(highest_levels(compiled), independent=has_independent_brake(compiled))
    pacer = Pacer(clock=lambda: now[0], sleep=sleep)
    desk = Desk(live.session, controls, live, publish, pacer=pacer, clock=lambda: now[0])
    desk.run()
    assert desk.failure is None
    return told


def set_and_run(live, until_s, **setting):
    live.session.set(**setting)
    live.note(live.session.time_s, setting)
    tick = live.session.time_s
    while tick < until_s - 1e-9:
        tick += 0.01
        live.session.advance(tick)
    live.take()


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A drive of 12.3 s, and the same as `dynamics run` computes it."""
    folder = tmp_path_factory.mktemp("driven")
    live = new_live(folder / "live")
    live.begin()
    set_and_run(live, 4.0, drive=15)
    set_and_run(live, 8.0, drive=0, brake=9)
    set_and_run(live, 10.0, brake="emergency")
    set_and_run(live, 12.3, brake=0, drive=4)
    live.close()
    live.finish()
    again = load_case(live.folder).scenario
    writer = RunWriter(folder / "again", "again", input_hash_of(again), kind="dynamics", scenario=again)
    outcome = CaseRun(again, writer, "again").execute()
    writer.finish(outcome.run, outcome.key_figures)
    return folder / "live", folder / "again"


@pytest.mark.parametrize("table", ["vehicles", "couplings", "coupling_extremes", "distributions", "rainflow"])
def test_running_the_driven_case_again_gives_the_same_table(driven, table):
    live, again = (pd.read_parquet(folder / f"{table}.parquet") for folder in driven)
    assert len(live) > 0
    pd.testing.assert_frame_equal(live, again, check_exact=True)


def test_running_it_again_gives_the_same_key_figures_of_the_same_input(driven):
    figures = [json.loads((folder / "key_figures.json").read_text(encoding="utf-8")) for folder in driven]
    assert figures[0] == figures[1]
    runs = [json.loads((folder / "run.json").read_text(encoding="utf-8")) for folder in driven]
    assert runs[0]["input_hash"] == runs[1]["input_hash"]
    assert (runs[0]["status"], runs[0]["end_s"]) == ("complete", pytest.approx(12.3))


def test_the_results_know_the_case_as_it_was_driven(driven):
    case = Results.open(driven[0]).scenario.case
    # What the case sets at the start is part of the drive, what it would set later is not.
    assert [row.drive for row in case.commands] == [15, 0, None, 4]
    assert [row.brake for row in case.commands] == [None, 9, "emergency", 0]
    controls = pd.read_parquet(driven[0] / "controls.parquet")
    assert {*controls.loc[controls["time_s"].between(3.1, 3.9), "drive"]} == {15}


def test_the_page_is_told_the_extremes_of_the_results_however_fast_time_passes(tmp_path):
    live = new_live(tmp_path / "out")
    live.begin()
    told = drive_by_clock(live, {1: [SetFactor(10), SetLevel("drive", 15)], 20: [SetLevel("drive", 0), Action("emergency")]}, 60)
    live.close()
    live.finish()
    extremes = pd.read_parquet(tmp_path / "out" / "coupling_extremes.parquet")
    last = told[-1]["snapshot"]
    assert last["greatest_kn"] == pytest.approx(extremes["greatest_tension_kn"].tolist())
    assert last["least_kn"] == pytest.approx((-extremes["greatest_compression_kn"]).tolist())
    greatest, least = float(extremes["greatest_tension_kn"][0]), -float(extremes["greatest_compression_kn"][0])
    points = [dict(zip(POINT, point, strict=True)) for frame in told for point in frame["points"]]
    assert max(point["first_coupling_greatest_kn"] for point in points) == pytest.approx(greatest, abs=1e-4)
    assert min(point["first_coupling_least_kn"] for point in points) == pytest.approx(least, abs=1e-4)
    # The instants that are shown alone would understate it.
    assert max(point["first_coupling_kn"] for point in points) < greatest - 1.0


def test_rows_reach_the_disk_while_driving(tmp_path, monkeypatch):
    monkeypatch.setattr(live_module, "PART_S", 0.0)
    live = new_live(tmp_path / "out")
    live.begin()
    set_and_run(live, 2.0, drive=5)
    set_and_run(live, 3.0, brake=5)
    live.close()
    running = live._writer.running
    assert len([*running.glob("vehicles-*.parquet")]) >= 2
    # As after a crash: the commands are there, and can be run again.
    kept = load_case(running / "driven").scenario
    assert [(row.time_s, row.drive, row.brake) for row in kept.case.commands] == [(0.0, 5, None), (pytest.approx(2.0), None, 5)]
    live.abandon()
    assert json.loads((running / "run.json").read_text(encoding="utf-8"))["status"] == "interrupted"


def test_a_drive_that_never_began_leaves_nothing(tmp_path):
    live = new_live(tmp_path / "out")
    live.begin()
    live.abandon()
    assert not live.has_driven
    assert not (tmp_path / "out").exists()


def test_a_disk_that_takes_nothing_ends_the_drive(tmp_path, monkeypatch):
    monkeypatch.setattr(live_module, "PART_S", 0.0)
    live = new_live(tmp_path / "out")
    live.begin()

    def full(*_):
        raise OutputError("the disk is full")

    monkeypatch.setattr(live._writer, "append", full)
    with pytest.raises(OutputError, match="full"):
        for until_s in range(1, 200):
            set_and_run(live, float(until_s), drive=1)
        live.close()


def test_a_failure_of_the_computation_is_kept_with_what_was_computed(tmp_path):
    live = new_live(tmp_path / "out")
    live.begin()
    set_and_run(live, 1.0, drive=5)
    live.close()
    outcome = live.finish("at 1.000 s a speed is no number any more")
    assert outcome.flagged
    assert outcome.run["status"] == "flagged"
    assert "no number" in outcome.run["notes"][-1]
    assert len(pd.read_parquet(tmp_path / "out" / "vehicles.parquet")) > 0


def test_a_bad_case_is_refused_before_anything_runs(tmp_path):
    with pytest.raises(InputError):
        new_live(tmp_path / "out", scenario(commands=[{"time_s": 0.0, "drive": 99}]))


def test_a_page_is_told_what_the_train_has(tmp_path):
    live = new_live(tmp_path / "out")
    compiled = live.session.compiled
    assert highest_levels(compiled) == {"drive": 15, "brake": 15, "electric": 0}
    told = hello(compiled, "out")
    assert told["powered"] == [True, False, False, False, False]
    assert told["length_m"] == pytest.approx(sum(compiled.scenario.vehicle(part.id).length_m for part in compiled.scenario.parts))
    assert len(told["limits"]) == 4
    assert json.loads(json.dumps(told)) == told
    assert isinstance(has_independent_brake(compiled), bool)
    live.abandon()

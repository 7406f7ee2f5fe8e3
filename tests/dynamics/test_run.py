"""Runs of cases: key figures of the steps however coarse the rows, rolling back, what run.json keeps of warnings and ledger."""

import dataclasses

import pytest
from chains import pulled

from tractionpower.dynamics import recorder
from tractionpower.dynamics.run import CaseRun
from tractionpower.errors import Problem
from tractionpower.results.store import MemoryWriter

STIFF = {"draw": {"stiffness_kn_per_mm": 5.0}, "damping_kns_per_m": 50.0, "slack_mm": 20.0}
DRIVEN = {
    "traction": {}, "brake": {"brake_ratio": 0.6},
    "commands": [{"time_s": 0.0, "drive": 15}, {"time_s": 7.3, "drive": 0, "brake": "full_service"}],
}  # fmt: skip
ROLLING = {
    "brake": {"brake_ratio": 0.6}, "track": {"gradients": [{"from_m": -5000.0, "to_m": 5000.0, "permille": 20.0}]},
    "commands": [{"time_s": 20.25, "brake": "full_service"}],
}  # fmt: skip


def computed(given, **how):
    writer = MemoryWriter()
    return CaseRun(given, writer, "test", **how).execute(), writer.tables()


def with_rows(every_s, case=DRIVEN, **run):
    return pulled(3, STIFF, **case, run={"duration_s": 40.0, "step_s": 0.01, "record_every_s": every_s, **run})


@pytest.fixture(scope="module")
def fine():
    return computed(with_rows(0.01))


@pytest.mark.parametrize("every_s", [0.1, 6.0, 1000.0])
def test_key_figures_do_not_depend_on_how_often_rows_are_recorded(fine, every_s):
    outcome, _ = computed(with_rows(every_s))
    assert outcome.key_figures == fine[0].key_figures
    assert outcome.run["stops"] == fine[0].run["stops"]


def test_key_figures_of_all_steps_are_those_of_rows_of_every_step(fine):
    outcome, tables = fine
    figures = {figure["name"]: figure["value"] for figure in outcome.key_figures}
    rows = tables["vehicles"].to_pandas()
    first = rows[rows["vehicle"].str.startswith("1 ")].reset_index()
    assert figures["greatest_speed_kmh"] == pytest.approx(first["speed_kmh"].max(), rel=1e-6)
    moved = rows["relative_position_m"].abs().max()
    assert abs(figures["greatest_relative_movement_m"]) == pytest.approx(moved, rel=1e-6)
    (stop,) = outcome.run["stops"]
    at = first[(first["time_s"] - 7.3).abs() < 1e-6].iloc[0]
    still = rows.groupby("time_s")["speed_kmh"].apply(lambda speed: speed.abs().max()) == 0.0
    stood_s = still.index[still & (still.index > 7.3)][0]
    end = first[first["time_s"] == stood_s].iloc[0]
    assert stop["braked_from_kmh"] == pytest.approx(at["speed_kmh"], rel=1e-6)
    assert stop["stopped_at_s"] == pytest.approx(stood_s)
    assert stop["stopping_distance_m"] == pytest.approx(end["position_m"] - at["position_m"], rel=1e-9)
    assert figures["stopping_distance_m"] == stop["stopping_distance_m"]


def test_a_train_that_rolls_back_is_told_with_its_direction():
    outcome, tables = computed(with_rows(0.05, ROLLING))
    figures = {figure["name"]: figure for figure in outcome.key_figures}
    rows = tables["vehicles"].to_pandas()
    first = rows[rows["vehicle"].str.startswith("1 ")]
    top = figures["greatest_speed_kmh"]
    assert top["value"] == pytest.approx(-first["speed_kmh"].min(), abs=0.05) and top["value"] > 5.0
    assert top["place"].startswith("vehicle 1 ") and top["place"].endswith(", backwards")
    stop = figures["stopping_distance_m"]
    assert stop["place"] == "stop 1, backwards" and stop["value"] > 1.0
    assert figures["braked_from_kmh"]["value"] > 5.0
    speed, way = figures["braked_from_kmh"]["value"] / 3.6, stop["value"]
    assert figures["mean_deceleration_mps2"]["value"] == pytest.approx(speed**2 / (2.0 * way))
    assert outcome.run["stops"][0]["backwards"] is True


def test_warnings_of_reading_are_kept_beside_those_of_the_checks():
    given = Problem("thinned", "case.run.record_every_s", "200000 rows", "100000", "take 0.02", "warning")
    outcome, _ = computed(with_rows(1.0), warnings=[given])
    assert outcome.run["warnings"] == [str(given), *map(str, outcome.warnings)]
    assert given not in outcome.warnings, "the command tells them with the files"


def test_a_ledger_beyond_what_is_asked_is_noted_and_beyond_its_limit_flagged(monkeypatch):
    true = recorder.EnergyLedger.of

    def lossy(share):
        def of(*given):
            ledger = true(*given)
            return dataclasses.replace(ledger, brake=ledger.brake - share * ledger.put_in)

        return of

    for share, status, is_noted in ((0.0, "complete", False), (6.4e-5, "complete", True), (2e-3, "flagged", True)):
        monkeypatch.setattr(recorder.EnergyLedger, "of", lossy(share))
        outcome, _ = computed(with_rows(1.0, method="rk4", step_s=0.0025))
        assert outcome.run["status"] == status
        assert any("shorten step_s of 0.0025 s" in note for note in outcome.run["notes"]) is is_noted
        assert outcome.run["ledgers"]["energy"]["limit_share"] == 1e-3

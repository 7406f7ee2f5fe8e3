"""The shipped study whose weak substation breaks the timetable: what its README tells, and the change that makes it hold."""

import math
from pathlib import Path

import pytest

import tractionpower
from tractionpower.model.change import apply_changes
from tractionpower.studies.feasibility import judge
from tractionpower.studies.remedies.search import search

STUDY = Path(__file__).parents[2] / "lines" / "two-substations" / "weak.yaml"
BOTH_UNITS = "supply.substations[B].units_in_service=2"


@pytest.fixture(scope="module")
def study():
    return tractionpower.load(STUDY)


@pytest.fixture(scope="module")
def judgement(study):
    return judge(study)


@pytest.fixture(scope="module")
def remedies(study, judgement):
    return search(study, judgement)


def late_of(scenario, tolerance_s=1.0):
    """Return who is late by the calls of a plain run of a scenario."""
    calls = tractionpower.simulate(scenario).table("calls")
    assert calls["actual_s"].notna().all()
    late = calls[calls["late_s"] > tolerance_s]
    return dict(zip(late["train"], late["late_s"], strict=True))


def test_nothing_is_wrong_or_doubtful(study):
    assert tractionpower.check(study) == []


def test_every_train_alone_is_in_time(study):
    calls = tractionpower.journeys(study).table("calls")
    assert calls["late_s"].max() <= 0.0


def test_the_regional_train_is_late_for_lack_of_voltage(study, judgement):
    late = late_of(study)
    assert set(late) == {"R 4"}
    assert 8.0 < late["R 4"] < 11.0
    assert judgement.verdict == "infeasible"
    assert {row.train: row.cause for row in judgement.trains if row.verdict == "infeasible"} == {"R 4": "voltage"}


def test_with_both_units_of_b_it_holds(study):
    assert late_of(apply_changes(study, [BOTH_UNITS])) == {}


def test_each_proposal_makes_it_hold_in_a_run_of_its_own(study, remedies):
    proposals = [row for row in remedies.found if row.feasible]
    assert {row.kind for row in proposals} >= {"departure_shift", "current_cap", "reserve"}
    for row in proposals:
        assert row.verified
        assert late_of(apply_changes(study, row.changes)) == {}, row.words


def test_the_best_is_a_saving_freight_train_and_a_step_less_does_not_do(study, remedies):
    best = remedies.best
    assert (best.kind, best.subject, best.size) == ("driving", "G 9", 2.0)
    assert best.cost == min(row.cost for row in remedies.found if row.feasible)
    assert late_of(apply_changes(study, ['timetable.trains[G 9].driving={"kind": "reserve", "percent": 1.0}']))


def test_the_cap_of_the_current_is_the_weakest_that_does(study, remedies):
    (cap,) = [row for row in remedies.found if row.feasible and row.kind == "current_cap"]
    assert (cap.subject, cap.size) == ("G 9", 65.0)
    amperes = float(cap.changes[0].split("=")[1])
    weaker = amperes * (1.0 - 0.60) / (1.0 - 0.65)
    assert late_of(apply_changes(study, [f"timetable.trains[G 9].max_current_a={weaker}"]))


def test_seconds_that_are_lost_are_those_of_the_judgement(judgement, remedies):
    lost = math.fsum(row.lost_s for row in judgement.lost)
    assert all(row.lost_before_s == pytest.approx(lost) for row in remedies.found)
    assert remedies.best.lost_after_s < lost


def test_the_second_unit_of_b_helps_most(remedies):
    first = remedies.sensitivities[0]
    assert (first.kind, first.subject, first.change) == ("units", "B", (BOTH_UNITS,))
    assert first.lost_s_change < -10.0


def test_the_search_is_deterministic_and_goes_on_where_it_was(study, judgement, remedies, tmp_path):
    told = []
    again = search(study, judgement, lambda done, total: told.append((done, total)), folder=tmp_path)
    assert again == remedies
    assert told[-1][0] == again.tried <= told[-1][1]
    kept = search(study, judgement, folder=tmp_path)
    assert kept == remedies
    assert (again.reused, kept.reused) == (0, remedies.tried)

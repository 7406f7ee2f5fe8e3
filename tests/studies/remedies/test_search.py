"""The search itself, with runs and judgements that are made up, so that the smallest change is known."""

import math
import threading
from dataclasses import replace

import pytest
from remedy_cases import NIGHT, judged, small_study

from tractionpower.model.base import format_time
from tractionpower.model.change import apply_changes
from tractionpower.studies.remedies.case import Peak
from tractionpower.studies.remedies.observe import Watcher
from tractionpower.studies.remedies.remedy import as_notes
from tractionpower.studies.remedies.search import search

QUICK = {"subjects": 2, "sensitivities": 0}
LATE_S = 20.0


@pytest.fixture
def study():
    return small_study(remedies=QUICK)


class Model:
    """X is late by 20 s, less with a lower cap on Y's current, a departure of X later than Y, or a later plan for X.

    Each second of a shift of X takes `shift` seconds away, each ampere of Y's cap below 1000 A `cap` seconds; a cap makes
    Y itself late where it is below `least_a`.
    """

    def __init__(self, shift=0.0, cap=0.0, least_a=0.0):
        self.shift, self.cap, self.least_a = shift, cap, least_a
        self.runs, self.lock = 0, threading.Lock()

    def lateness(self, scenario):
        with self.lock:
            self.runs += 1
        x, y = scenario.runs
        moved = x.calls[0].departure - 300.0
        longer = x.calls[-1].arrival - x.calls[0].departure - 900.0
        current = 1000.0 if y.max_current_a is None else min(y.max_current_a, 1000.0)
        late = LATE_S - self.shift * max(moved, 0.0) - longer - self.cap * (1000.0 - current)
        return {"X": max(late, 0.0), "Y": 30.0 if current < self.least_a else 0.0}

    def judge(self, scenario):
        late = self.lateness(scenario)
        return judged(late, lost_s=sum(late.values()))

    def search(self, study, **more):
        return search(study, judged({"X": LATE_S, "Y": 0.0}, lost_s=LATE_S), lateness=self.lateness, judge=self.judge, **more)


@pytest.fixture(autouse=True)
def _known_peaks(monkeypatch):
    """Every train draws 1000 A and 2500 kW, whatever the run says, so that caps are round."""

    def watch(scenario, late):
        watcher = Watcher(scenario, late)
        watcher.peaks = {name: Peak(1000.0, 2500.0) for name in ("X", "Y")}
        watcher.demand = {"X": 1.0, "Y": 2.0}
        return watcher

    monkeypatch.setattr("tractionpower.studies.remedies.search.watch", watch)


def found_of(remedies, kind, subject):
    return next(row for row in remedies.found if (row.kind, row.subject) == (kind, subject))


def test_each_kind_gets_its_smallest_size_and_the_cheapest_is_best(study):
    model = Model(shift=0.3, cap=0.1)
    remedies = model.search(study)
    shift = found_of(remedies, "departure_shift", "X")
    assert shift.size == 65.0  # 20 - 0.3 * 65 = 0.5, within the tolerance of 1 s; 60 s would leave 2 s
    cap = found_of(remedies, "current_cap", "Y")
    assert cap.size == 20.0  # of 1000 A in steps of 2 %; 18 % would leave 2 s
    assert cap.changes == ("timetable.trains[Y].max_current_a=800",)
    assert found_of(remedies, "reserve", "X").size == 20.0
    assert remedies.best == cap
    assert [row.cost for row in remedies.found if row.feasible] == sorted(row.cost for row in remedies.found if row.feasible)
    for row in remedies.found:
        if row.feasible:
            assert row.verified
            assert max(model.lateness(apply_changes(study, row.changes)).values()) <= 1.0
            assert (row.lost_before_s, row.lost_after_s) == (LATE_S, pytest.approx(row.lateness_after_s))


def test_one_step_less_is_not_feasible(study):
    model = Model(shift=0.3, cap=0.1)
    steps = {"departure_shift": 5.0, "current_cap": 2.0, "reserve": 5.0}
    checked = 0
    for row in model.search(study).found:
        if row.feasible and row.subject in {"X", "Y"}:
            smaller = {
                "departure_shift": [*_shifted(study, row.size - 5.0)],
                "current_cap": [f"timetable.trains[Y].max_current_a={1000.0 - 10.0 * (row.size - 2.0)}"],
                "reserve": [f"timetable.trains[X].calls[2].arrival='00:20:{row.size - 5.0:02.0f}'"],
            }[row.kind]
            assert row.size > steps[row.kind]
            assert model.lateness(apply_changes(study, smaller))["X"] > 1.0
            checked += 1
    assert checked == 3


def _shifted(study, seconds):
    for k, call in enumerate(study.runs[0].calls):
        for name in ("arrival", "departure"):
            if getattr(call, name) is not None:
                yield f"timetable.trains[X].calls[{k}].{name}={format_time(getattr(call, name) + seconds)}"


def test_what_makes_another_train_late_is_no_remedy(study):
    remedies = Model(cap=0.05, least_a=700.0).search(study)  # 380 A less would do, but then Y is late
    cap = found_of(remedies, "current_cap", "Y")
    assert not cap.feasible
    assert 0.0 < cap.lateness_after_s < LATE_S  # how far it gets
    assert remedies.best.kind == "reserve"


def test_a_cap_that_does_harm_again_further_on_is_found(study):
    remedies = Model(cap=0.1, least_a=690.0).search(study)
    assert found_of(remedies, "current_cap", "Y").size == 20.0


def test_two_are_joined_where_one_does_not_suffice():
    study = small_study(remedies=QUICK | {"kinds": ["departure_shift", "current_cap"], "greatest_shift_s": 40.0})
    model = Model(shift=0.3, cap=0.1, least_a=840.0)  # 12 s by the shift, 16 s by the cap
    remedies = model.search(study)
    best = remedies.best
    assert set(best.kind.split(" + ")) == {"departure_shift", "current_cap"}
    assert best.verified
    assert max(model.lateness(apply_changes(study, best.changes)).values()) <= 1.0
    assert not any(row.feasible for row in remedies.found if "+" not in row.kind)


def test_nothing_is_told_to_help_where_nothing_does():
    study = small_study(remedies=QUICK | {"kinds": ["departure_shift", "current_cap"]})
    remedies = Model(shift=0.05).search(study)
    assert remedies.best is None
    assert remedies.found
    assert not any(row.feasible for row in remedies.found)
    assert found_of(remedies, "departure_shift", "X").size == 180.0
    assert remedies.found[0].lateness_after_s == pytest.approx(LATE_S - 9.0)


def test_a_timetable_that_holds_is_not_searched(study):
    model = Model()
    remedies = search(study, judged({"X": 0.0, "Y": 0.5}), lateness=model.lateness, judge=model.judge)
    assert (remedies.found, remedies.tried, model.runs) == ((), 0, 0)


def test_faster_than_physics_only_later_times_help(study):
    model = Model(shift=1.0, cap=1.0)
    judgement = judged({"X": LATE_S, "Y": 0.0}, alone=12.0)
    remedies = search(study, judgement, lateness=model.lateness, judge=model.judge)
    assert {row.kind for row in remedies.found} == {"reserve"}
    assert remedies.best.size == 20.0
    assert any("X (12 s)" in note for note in remedies.notes)


def test_a_turn_round_that_is_too_short_is_told_as_such(study):
    model = Model(shift=1.0, cap=1.0)
    judgement = judged({"X": LATE_S, "Y": 0.0}, alone=12.0)
    rows = tuple(replace(row, origin_timetable_s=0.0, origin_dwell_s=row.origin_timetable_s) for row in judgement.delays)
    remedies = search(study, replace(judgement, delays=rows), lateness=model.lateness, judge=model.judge)
    assert {row.kind for row in remedies.found} == {"reserve"}
    assert any("turn-rounds need: X (12 s)" in note for note in remedies.notes)


def test_of_many_trains_a_note_names_the_worst(study):
    model = Model(shift=1.0, cap=1.0)
    judgement = judged({"X": LATE_S, "Y": 0.0}, alone=12.0)
    more = tuple(replace(judgement.delays[0], train=f"Z {k}", origin_timetable_s=20.0 + k) for k in range(170))
    judgement = replace(judgement, delays=(*judgement.delays, *more))
    remedies = search(study, judgement, lateness=model.lateness, judge=model.judge)
    (note,) = (note for note in remedies.notes if "even alone" in note)
    assert "need: Z 169 (189 s), Z 168 (188 s)" in note
    assert "(171 in all)" in note
    assert len(note) < 600


class Deceiving(Model):
    """In a part of the clock changes do twice as much as in the whole."""

    def lateness(self, scenario):
        factor = 1.0 if scenario.clock.end - scenario.clock.start == NIGHT else 2.0
        return Model(self.shift * factor, self.cap * factor).lateness(scenario)


def test_what_saves_a_part_of_the_clock_only_is_searched_for_again_in_the_whole():
    study = small_study(end_s=NIGHT, remedies=QUICK | {"kinds": ["departure_shift", "current_cap"]})
    remedies = Deceiving(shift=0.3, cap=0.1).search(study)
    assert any("searched again" in note for note in remedies.notes)
    assert found_of(remedies, "departure_shift", "X").size == 65.0  # in the part 35 s do
    assert found_of(remedies, "current_cap", "Y").size == 20.0
    assert all(row.verified for row in remedies.found if row.feasible)


def test_what_does_not_suffice_is_not_told_as_verified(study):
    remedies = Model(shift=0.01, cap=0.1).search(study)
    assert any(not row.feasible for row in remedies.found)
    assert all(row.verified == row.feasible for row in remedies.found)


def test_the_answer_does_not_depend_on_the_number_of_workers(study):
    one, three = (Model(shift=0.3, cap=0.1).search(apply_changes(study, [f"remedies.workers={k}"])) for k in (1, 3))
    assert one == three


def test_a_search_that_is_started_again_runs_nothing_twice(study, tmp_path):
    model, again = Model(shift=0.3, cap=0.1), Model(shift=0.3, cap=0.1)
    first = model.search(study, folder=tmp_path)
    assert first == again.search(study, folder=tmp_path)
    assert again.runs == sum(row.verified for row in first.found if row.feasible)  # only the verifying runs
    assert first.reused == 0
    assert Model(shift=0.3, cap=0.1).search(study, folder=tmp_path).reused == first.tried


def test_ctrl_c_before_the_first_trial_and_while_proposals_are_verified(study, monkeypatch):
    class Interrupted(Model):
        def judge(self, scenario):
            raise KeyboardInterrupt

    remedies = Interrupted(shift=0.3, cap=0.1).search(study)
    assert remedies.interrupted
    assert remedies.stopped
    assert found_of(remedies, "current_cap", "Y").feasible
    assert not any(row.verified for row in remedies.found if row.feasible)
    assert remedies.best is None

    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("tractionpower.studies.remedies.search.watch", interrupt)
    remedies = Model(shift=0.3).search(study)
    assert (remedies.found, remedies.interrupted, remedies.stopped) == ((), True, True)


def test_what_there_was_no_time_to_verify_is_not_called_verified(study, monkeypatch):
    monkeypatch.setattr("tractionpower.studies.remedies.search.TRIAL_SHARE", 1e9)
    remedies = Model(shift=0.3, cap=0.1).search(apply_changes(study, ["remedies.wall_time_s=1e-6"]))
    assert [row.verified for row in remedies.found if row.feasible][:2] == [True, False]
    assert (remedies.interrupted, remedies.stopped) == (True, False)
    assert any("wall time" in note for note in remedies.notes)


def test_ctrl_c_leaves_what_was_found(study, tmp_path):
    class Interrupted(Model):
        def lateness(self, scenario):
            if self.runs == 40:
                raise KeyboardInterrupt
            return super().lateness(scenario)

    study = apply_changes(study, ["remedies.workers=1"])
    remedies = Interrupted(shift=0.3, cap=0.1).search(study, folder=tmp_path)
    assert remedies.interrupted
    assert found_of(remedies, "departure_shift", "X").feasible
    assert remedies.tried == 40
    assert any("Ctrl-C" in note for note in remedies.notes)
    rest = Model(shift=0.3, cap=0.1)
    assert rest.search(study, folder=tmp_path) == Model(shift=0.3, cap=0.1).search(study)


def test_the_wall_time_ends_it_and_what_it_has_is_told(study):
    remedies = Model(shift=0.3).search(apply_changes(study, ["remedies.wall_time_s=1e-9"]))
    assert remedies.interrupted
    assert remedies.found == ()
    assert any("wall time" in note for note in remedies.notes)


def test_what_the_bounds_have_no_room_for_is_named(study):
    remedies = Model(shift=0.3).search(apply_changes(study, ["remedies.most_runs=25"]))
    assert 0 < remedies.tried <= 25
    assert any(note.startswith("Not tried") and "current_cap of Y" in note for note in remedies.notes)


def test_proposals_are_verified_with_the_tolerance_of_the_judgement(study, monkeypatch):
    model, asked = Model(shift=0.3, cap=0.1), []

    def judge(scenario, *, tolerance_s):
        asked.append(tolerance_s)
        return model.judge(scenario)

    monkeypatch.setattr("tractionpower.studies.feasibility.judge", judge)
    judgement = replace(judged({"X": LATE_S, "Y": 0.0}), tolerance_s=3.0)
    assert search(study, judgement, lateness=model.lateness).best is not None
    assert set(asked) == {3.0}


def test_only_kinds_that_are_allowed_are_tried():
    remedies = Model(shift=0.3, cap=0.1).search(small_study(remedies=QUICK | {"kinds": ["reserve"]}))
    assert {row.kind for row in remedies.found} == {"reserve"}


def test_costs_decide_what_is_smallest():
    study = small_study(remedies=QUICK | {"costs": {"current_cap": 50.0, "departure_shift": 0.1}})
    best = Model(shift=0.3, cap=0.1).search(study).best
    assert (best.kind, best.cost) == ("departure_shift", 6.5)


def test_notes_are_plain(study):
    remedies = Model(shift=0.3, cap=0.1).search(study)
    notes = as_notes(remedies)
    assert [note["words"] for note in notes] == [row.words for row in remedies.found]
    assert all(value is None or isinstance(value, bool | int | float | str | list) for note in notes for value in note.values())
    assert all(value is None or not isinstance(value, float) or math.isfinite(value) for note in notes for value in note.values())


def test_a_train_that_never_comes_is_late(study):
    model = Model(cap=0.1)
    base = judged({"X": math.inf, "Y": 0.0})
    remedies = search(study, base, lateness=model.lateness, judge=model.judge)
    assert remedies.best.kind == "current_cap"

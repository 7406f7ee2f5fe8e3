import json
import math

import pytest
from remedy_cases import small_study

from tractionpower.model.scenario import Clock
from tractionpower.studies.remedies.allowance import Allowance
from tractionpower.studies.remedies.trials import FILE, Glance, SpentError, Trials, judged

CAP = "timetable.trains[X].max_current_a={}"


class Lateness:
    """Stands for the run: X is late by what its cap exceeds 900 A."""

    def __init__(self):
        self.runs = []

    def __call__(self, scenario):
        cap = scenario.runs[0].max_current_a
        self.runs.append(cap)
        return {"X": cap - 900.0, "Y": -math.inf if cap < 100.0 else 0.5}


def test_a_trial_says_who_is_late_and_by_how_much_in_all():
    trial = judged({"X": 20.0, "Y": 1.0, "Z": 3.5, "W": math.nan}, 1.0)
    assert trial.late == {"X": 20.0, "Z": 3.5}
    assert (trial.excess_s, trial.worst_s, trial.holds) == (21.5, 20.0, False)
    assert judged({"X": 1.0, "Y": -30.0}, 1.0).holds
    assert not judged({"X": math.inf}, 1.0).holds
    assert judged({}, 1.0).holds


def test_equal_changes_run_once():
    run = Lateness()
    trials = Trials(small_study(), 1.0, run)
    assert trials.run([CAP.format(950)]).late == {"X": 50.0}
    assert trials.run([CAP.format(800), CAP.format(950)]).late == {"X": 50.0}
    assert trials.run([CAP.format(900)]).holds
    assert run.runs == [950.0, 900.0]
    assert trials.tried == 2


def test_a_change_that_is_refused_does_not_hold():
    run = Lateness()
    trial = Trials(small_study(), 1.0, run).run([CAP.format(-5)])
    assert not trial.holds
    assert math.isinf(trial.excess_s)
    assert run.runs == []


def test_trials_are_kept_as_they_come_and_used_again(tmp_path):
    first = Trials(small_study(), 1.0, Lateness(), tmp_path / "kept")
    first.run([CAP.format(950)])
    first.run([CAP.format(50)])
    content = json.loads((tmp_path / "kept" / FILE).read_text(encoding="utf-8"), parse_constant=pytest.fail)
    assert len(content["trials"]) == 2
    run = Lateness()
    again = Trials(small_study(remedies={"subjects": 2}), 3.0, run, tmp_path / "kept")  # other bounds, the same runs
    assert again.run([CAP.format(950)]).late == {"X": 50.0}
    assert again.run([CAP.format(50)]).worst_s == 0.0
    assert run.runs == []
    assert (again.tried, again.reused) == (2, 2)
    assert again.run([CAP.format(960)]).late == {"X": 60.0}
    assert run.runs == [960.0]
    assert (again.tried, again.reused) == (3, 2)


class GlanceLateness(Lateness):
    """X is late by what its cap exceeds 900 A, Y in the second half hour by what it exceeds 700 A."""

    def __call__(self, scenario):
        cap = scenario.runs[0].max_current_a
        self.runs.append((scenario.clock.end, cap))
        return {"X": cap - 900.0, "Y": cap - 700.0 if scenario.clock.end > 900.0 else 0.0}


def test_the_whole_is_run_only_where_a_glance_shows_nobody_late(tmp_path):
    run = GlanceLateness()
    glance = Glance(Clock.model_validate({"start": 0.0, "end": 900.0, "step_s": 1.0}), frozenset("X"), {"Y": 300.0})
    trials = Trials(small_study(), 1.0, run, tmp_path, glance=glance)
    seen = trials.run([CAP.format(950)])
    assert run.runs == [(900.0, 950.0)]
    assert (seen.holds, seen.is_partial, seen.late) == (False, True, {"X": 50.0, "Y": 300.0})
    whole = trials.run([CAP.format(800)])
    assert run.runs[1:] == [(900.0, 800.0), (1800.0, 800.0)]
    assert (whole.holds, whole.is_partial, whole.late) == (False, False, {"Y": 100.0})
    assert trials.run([CAP.format(600)]).holds
    assert trials.tried == 3
    again = Trials(small_study(), 1.0, run, tmp_path, glance=glance)
    assert [again.run([CAP.format(cap)]) for cap in (950, 800)] == [seen, whole]
    assert len(run.runs) == 5
    assert again.reused == 2


def test_another_study_does_not_use_them(tmp_path):
    Trials(small_study(), 1.0, Lateness(), tmp_path).run([CAP.format(950)])
    run = Lateness()
    Trials(small_study(end_s=1900.0), 1.0, run, tmp_path).run([CAP.format(950)])
    assert run.runs == [950.0]


@pytest.mark.parametrize("text", ["", "[1]", '{"trials": 3}'])
def test_a_broken_file_is_written_anew(tmp_path, text):
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    Trials(small_study(), 1.0, Lateness(), tmp_path).run([CAP.format(950)])
    assert len(json.loads((tmp_path / FILE).read_text(encoding="utf-8"))["trials"]) == 1


def test_nothing_is_tried_when_time_is_over_or_it_was_stopped():
    trials = Trials(small_study(remedies={"wall_time_s": 1e-9}), 1.0, Lateness())
    with pytest.raises(SpentError):
        trials.run([CAP.format(950)])
    allowance = Allowance()
    trials = Trials(small_study(), 1.0, Lateness(), allowance=allowance)
    trials.run([CAP.format(950)])
    allowance.stop()
    with pytest.raises(SpentError):
        trials.run([CAP.format(950)])


def test_progress_is_told():
    told = []
    trials = Trials(small_study(), 1.0, Lateness(), progress=lambda done, total: told.append((done, total)))
    trials.planned = 7
    trials.run([CAP.format(950)])
    trials.run([CAP.format(950)])
    trials.run([CAP.format(960)])
    assert told == [(1, 7), (2, 7)]

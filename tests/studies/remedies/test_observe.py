"""What is seen of a run: peaks by its own tables, and who draws where and when the late train lacks voltage."""

import pytest
from remedy_cases import planned, small_study
from small_studies import run_in_memory

from tractionpower.studies.remedies.observe import watch

WEAK = [
    {"id": name, "km": km, "no_load_voltage_v": 3000.0, "internal_resistance_ohm": 0.3} for name, km in (("A", 0.0), ("B", 20.0))
]


@pytest.fixture(scope="module")
def study():
    return small_study(
        planned("X", 0.0),
        planned("near", 30.0, track="2"),
        planned("far", 0.0, track="2", low=20.0, high=0.0) | {"calls": [], "start": {"time": 0.0}},
        planned("later", 1200.0, track="2"),
        substations=WEAK,
        end_s=1500.0,
        output={"every_s": 10.0},
    )


def test_peaks_are_those_of_the_whole_run(study):
    table = run_in_memory(study.model_copy(update={"output": type(study.output)()}))[0].table("trains")
    peaks = watch(study, ["X"]).peaks
    assert set(peaks) == {"X", "near", "far", "later"}
    for name, rows in table.groupby("train", observed=True):
        assert peaks[name].current_a == pytest.approx(rows["current_a"].max())
        assert peaks[name].power_kw == pytest.approx(rows["wheel_power_kw"].max())


def test_who_draws_near_the_late_train_at_its_time_comes_first(study):
    watcher = watch(study, ["X"])
    ranked = watcher.culprits()
    assert set(ranked[:2]) == {"X", "near"}
    assert ranked.index("near") < ranked.index("far")
    assert "later" not in ranked


def test_without_a_late_train_nobody_is_to_blame(study):
    assert watch(study, []).culprits() == ()

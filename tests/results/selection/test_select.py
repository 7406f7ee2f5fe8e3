"""A part of a run: its rows, its key figures against those of the run and against brute force."""

import math

import numpy as np
import pytest

import tractionpower as tp
from tractionpower.errors import InputError, UsageError
from tractionpower.results.results import Results
from tractionpower.results.selection.figures import trains_of
from tractionpower.results.selection.select import select
from tractionpower.results.selection.selection import Selection

SAME = 2e-6
"""Rows hold float32; key figures of a run are of float64."""

OF_TRAINS_AND_LOADS = ("lowest_voltage_v", "highest_voltage_v")
"""Figures that a run also takes from cross-sections, which have no rows."""

IN_PARTS_OF_STEPS = ("running_time_s", "mean_speed_kmh")
"""Figures that a run takes from arrivals within steps, which rows do not tell."""


@pytest.fixture(scope="module")
def run():
    return tp.simulate(tp.load("two-substations"))


@pytest.fixture(scope="module")
def part(run):
    return select(run, run.scenario, Selection(trains=("2",), from_s=60.0, to_s=300.0, from_km=2.0, to_km=9.0))


def figures(results):
    return {(figure["name"], figure["place"]): figure for figure in results.key_figures}


def test_everything_has_the_key_figures_of_the_run(run):
    whole, scenario = select(run, run.scenario, Selection())
    assert scenario.clock == run.scenario.clock
    known, found = figures(run), figures(whole)
    common = [key for key in found if key in known and key[0] not in IN_PARTS_OF_STEPS]
    assert {name for name, _ in common} > {"energy_taken_kwh", "highest_rms_current_1_min_a", "mean_useful_voltage_time_mean_v"}
    for key in common:
        assert found[key]["value"] == pytest.approx(known[key]["value"], rel=SAME, abs=1e-4), key
        assert found[key]["definition"] == known[key]["definition"] or key[0] in OF_TRAINS_AND_LOADS, key


def test_rows_are_those_of_the_part(run, part):
    rows = part[0].table("trains")
    every = run.table("trains")
    own = every[
        (every["train"].astype(str) == "2") & every["time_s"].between(60.0, 299.0) & every["position_km"].between(2.0, 9.0)
    ]
    assert len(rows) == len(own) > 10
    assert rows["position_km"].tolist() == own["position_km"].tolist()
    stations = {each.id: each.km for each in run.scenario.supply.substations}
    fed = set(part[0].table("substations")["substation"].astype(str)) if "substations" in part[0].tables else set()
    assert fed == {name for name, km in stations.items() if 2.0 <= km <= 9.0}
    assert part[1].clock.start == 60.0
    assert part[1].clock.end == 300.0


def test_key_figures_of_a_part_by_brute_force(run, part):
    rows, found = part[0].table("trains"), figures(part[0])
    step_s = run.scenario.clock.step_s
    taken = float((rows["power_kw"] + rows["returned_kw"]).astype(float).sum()) * step_s / 3600.0
    assert found[("energy_taken_kwh", "train 2")]["value"] == pytest.approx(taken, rel=1e-9)
    volts, amps = rows["voltage_v"].to_numpy(float), np.abs(rows["current_a"].to_numpy(float))
    assert found[("mean_useful_voltage_current_weighted_v", "train 2")]["value"] == pytest.approx(volts @ amps / amps.sum())
    assert (
        found[("lowest_voltage_v", "train 2, track 1, km " + f"{rows['position_km'][volts.argmin()]:.2f}")]["value"]
        == volts.min()
    )


def test_the_profile_is_of_the_selected_trains(part):
    rows, profile = part[0].table("trains"), part[0].table("profile")
    assert profile["lowest_voltage_v"].min() == rows["voltage_v"].min()
    assert profile["count"].sum() == len(rows)
    assert set(profile["where"].astype(str)) == {"pantograph"}


def test_sums_over_the_whole_run_do_not_belong_to_a_part(part):
    assert "verdicts" not in part[0].run
    assert "ledgers" not in part[0].run
    assert any("part of the run" in note for note in part[0].run["notes"])
    assert [train["train"] for train in part[0].run["trains"]] == ["2"]


def test_trains_that_are_not_there_are_told(run):
    told = select(run, run.scenario, Selection(trains=("1", "2"), to_km=9.0))[0].run
    assert [train["train"] for train in told["trains"]] == ["2"]
    assert "no row of these trains is in the part: 1" in told["notes"]


def test_a_train_that_leaves_the_part_and_comes_back_runs_only_what_is_in_it(run):
    rows = run.table("trains")
    rows = rows[(rows["train"].astype(str) == "2") & ~rows["position_km"].between(4.0, 6.0)]
    figures_of = {figure.name: figure.value for figure in trains_of(rows, None, {}, run.scenario.clock.step_s)}
    speeds = rows["speed_kmh"].to_numpy(float)
    assert figures_of["length_km"] == pytest.approx(speeds.sum() * run.scenario.clock.step_s / 3600.0, rel=2e-3)
    assert figures_of["mean_speed_kmh"] <= figures_of["highest_speed_kmh"]


def test_a_train_that_goes_on_beyond_the_part_is_said_to(run, part):
    told = {train["train"]: train for train in part[0].run["trains"]}["2"]
    rows = part[0].table("trains")
    assert told["status"] == "beyond"
    assert told["finished_s"] is None
    assert told["entered_s"] == rows["time_s"].min()


def test_what_the_figures_of_a_part_rest_on_is_told():
    changes = ["output.every_s=5", "clock.warm_up=00:06:00"]
    thin = tp.simulate(tp.change(tp.load("two-substations"), changes))
    results, scenario = select(thin, thin.scenario, Selection(to_s=300.0))
    assert any("rows every 5 s" in note for note in results.run["notes"])
    assert any("in the warm-up" in note for note in results.run["notes"])
    assert results.key_figures == []
    assert scenario.clock.end == 300.0


def test_all_that_is_wrong_is_told_at_once(run):
    wrong = Selection(trains=("none",), tracks=("9",), from_s=9e5, from_km=5.0, to_km=4.0)
    with pytest.raises(InputError) as caught:
        select(run, run.scenario, wrong)
    assert {problem.path for problem in caught.value.problems} == {"--train", "--track", "--from, --to", "--from-km, --to-km"}


def test_a_part_without_rows_is_refused(run):
    with pytest.raises(UsageError, match="nothing of the run"):
        select(run, run.scenario, Selection(trains=("1",), from_s=run.scenario.clock.end - 1.0, from_km=0.4, to_km=0.5))


def test_studies_of_many_have_nothing_to_select_from(run):
    with pytest.raises(UsageError, match="no rows over time"):
        select(Results({"kind": "sweep"}, [], {}), run.scenario, Selection(from_km=1.0))


def test_what_is_told_of_a_selection_leaves_out_what_it_does_not_select_by():
    assert Selection().is_everything
    assert Selection(from_s=60.0, to_km=3.5).as_dict() == {"from": "00:01:00", "to_km": 3.5}
    assert math.isinf(Selection(trains=("7",)).to_s)

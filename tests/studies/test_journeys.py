"""Theoretical journeys of a study: rows, calls, figures, and words for those who do not arrive."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from fake_journeys import make_journey, make_line
from train_study import write_train_study

from tractionpower.errors import InputError, UsageError
from tractionpower.io.scenario_files import load
from tractionpower.kernels.train_tables import HOLDING
from tractionpower.model.change import apply_changes
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter
from tractionpower.studies.journeys import (
    choose_runs,
    compute_journeys,
    end_of,
    journeys,
    route_in_words,
    stations_on,
    why_not_complete,
)

START = 6 * 3600.0


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    return load(write_train_study(tmp_path_factory.mktemp("six")))


@pytest.fixture(scope="module")
def computed(scenario):
    """Return results of the whole study."""
    writer = MemoryWriter()
    outcome = compute_journeys(scenario, writer, "six, journey")
    return Results(outcome.run, outcome.key_figures, writer.tables()), outcome


# --- made by hand


def test_where_and_why_a_train_is_stuck():
    journey = make_journey(make_line(), "7", stuck_m=8000.0)
    told = why_not_complete(journey)
    km = 0.5 + journey.rows["s_m"][-1] / 1000.0
    for words in ("train 7 is stuck on track 1", f"km {km:.3f}", "06:07:", "limited by voltage"):
        assert words in told
    standing = np.repeat(journey.rows[-1:], 60)  # a train that holds has neither effort nor resistance
    standing["phase"], standing["resistance_n"], standing["traction_n"] = HOLDING, 0.0, 0.0
    rows = journey.rows.copy()
    rows["resistance_n"][-2:], rows["traction_n"][-2:] = [324e3, 200e3], [258e3, 170e3]
    held = replace(journey, rows=np.concatenate([rows, standing]))
    told = "its tractive effort of 258.0 kN, limited by voltage, does not overcome the resistance of 324.0 kN"
    assert why_not_complete(held).endswith(told)
    told = "its tractive effort, limited by voltage, does not overcome the resistance"
    assert why_not_complete(replace(held, rows=standing)).endswith(told)
    assert "stuck" not in why_not_complete(replace(journey, status="unfinished"))
    assert end_of(journey) == journey.rows["s_m"][-1]


def test_a_route_in_words():
    line = make_line()
    assert route_in_words(make_journey(line), line) == "Alfa – Delta"
    assert route_in_words(make_journey(line, backwards=True), line) == "Delta – Alfa"
    bare = make_line(stations=[])
    assert route_in_words(make_journey(bare), bare) == "track 1, km 0.5 – track 1, km 12.0"
    assert [round(place) for place, _ in stations_on(make_journey(line), line)] == [0, 5500, 5900, 11500]


# --- which trains


def test_trains_are_chosen_by_name_and_sorted(scenario):
    assert choose_runs(scenario, None) == ["11", "EC 2/1"]
    assert choose_runs(scenario, ["EC 2/1", "11", "11"]) == ["11", "EC 2/1"]


def test_an_unknown_train_is_told_with_the_nearest(scenario):
    with pytest.raises(UsageError, match=r"no train 'EC 21', did you mean EC 2/1\?; trains of the timetable: 11, EC 2/1"):
        choose_runs(scenario, ["11", "EC 21"])


def test_a_study_without_trains(scenario):
    bare = scenario.model_copy(update={"timetable": scenario.timetable.model_copy(update={"trains": ()})})
    with pytest.raises(UsageError, match="no trains"):
        choose_runs(bare, None)


# --- computed


def test_tables_and_key_figures_agree(computed, scenario):
    results, outcome = computed
    assert (outcome.complete, results.run["status"], results.run["study"]) == (True, "complete", "six, journey")
    assert results.run["voltage_v"] == 3000.0
    assert results.run["input_hash"] == scenario.input_hash
    trains = results.table("trains")
    assert results.run["steps"] == len(trains)
    for name, rows in trains.groupby("train", observed=True):
        place = f"train {name}"
        assert results.key_figure("length_km", place) == pytest.approx(5.5)
        net = results.key_figure("energy_taken_kwh", place) - results.key_figure("energy_returned_kwh", place)
        assert net == pytest.approx(rows["power_kw"].sum() / 3600.0, rel=1e-5)
        assert results.key_figure("highest_current_a", place) == pytest.approx(rows["current_a"].max(), rel=1e-6)
        assert results.key_figure("highest_speed_kmh", place) == pytest.approx(rows["speed_kmh"].max(), rel=1e-6)
        hours = results.key_figure("running_time_s", place) / 3600.0
        assert results.key_figure("mean_speed_kmh", place) == pytest.approx(5.5 / hours)
        assert rows["voltage_v"].unique().tolist() == [3000.0]
    up, down = (trains[trains["train"] == name] for name in ("11", "EC 2/1"))
    assert (up["track"].unique().tolist(), down["track"].unique().tolist()) == (["1"], ["2"])
    np.testing.assert_allclose(up["position_km"], 0.5 + up["distance_m"] / 1000.0)
    np.testing.assert_allclose(down["position_km"], 6.0 - down["distance_m"] / 1000.0)


def test_computed_calls_are_held_against_the_timetable(computed):
    results, _ = computed
    calls = results.table("calls").set_index(["station", "kind"])
    arrival, departure = calls.loc[("B", "arrival")], calls.loc[("B", "departure")]
    assert departure["actual_s"] >= max(departure["planned_s"], arrival["actual_s"] + 20.0) - 1e-6
    assert departure["dwell_s"] == pytest.approx(departure["actual_s"] - arrival["actual_s"], abs=1e-3)
    assert arrival["late_s"] == pytest.approx(arrival["actual_s"] - (START + 180.0), abs=1e-3)
    end = calls.loc[("C", "arrival")]
    stood = results.key_figure("journey_time_s", "train 11") - results.key_figure("running_time_s", "train 11")
    assert stood == pytest.approx(departure["dwell_s"], abs=1e-3)
    assert results.key_figure("journey_time_s", "train 11") == pytest.approx(end["actual_s"] - START)
    passing = calls.loc[("P", "pass")]
    rows = results.table("trains")
    rows = rows[rows["train"] == "11"]
    assert passing["actual_s"] == pytest.approx(np.interp(4.0, rows["position_km"], rows["time_s"]), abs=0.2)


def test_both_forms_agree(scenario, computed):
    memory = MemoryWriter()
    over_speed = compute_journeys(scenario, memory, form="speed")
    results = Results(over_speed.run, over_speed.key_figures, memory.tables())
    assert results.run["form"] == "speed"
    for name in ("journey_time_s", "energy_taken_kwh"):
        assert results.key_figure(name, "train 11") == pytest.approx(computed[0].key_figure(name, "train 11"), rel=0.01)


def test_voltage_step_and_trains_are_options(scenario, computed):
    memory = MemoryWriter()
    outcome = compute_journeys(scenario, memory, voltage_v=2400.0, step_s=0.5, runs=["11"])
    results = Results(outcome.run, outcome.key_figures, memory.tables())
    trains = results.table("trains")
    assert trains["train"].unique().tolist() == ["11"]
    assert trains["time_s"].diff().dropna().unique().tolist() == [0.5]
    assert (results.run["voltage_v"], results.run["step_s"]) == (2400.0, 0.5)
    assert results.key_figure("journey_time_s") > computed[0].key_figure("journey_time_s", "train 11")


def test_a_train_that_cannot_go_on_is_kept_and_told(scenario):
    changes = ["line.gradients[1].permille=90", "vehicles[railcar].drive.starting_effort_kn=80"]
    steep = apply_changes(scenario, changes)
    writer = MemoryWriter()
    outcome = compute_journeys(steep, writer, runs=["11"])
    assert not outcome.complete
    assert outcome.run["status"] == "flagged"
    (note,) = outcome.run["journeys"]
    assert note["status"] == "stuck"
    assert "train 11 is stuck on track 1 at km " in note["message"]
    rows = writer.tables()["trains"].to_pylist()
    assert 4.0 < rows[-1]["position_km"] < 6.0
    figures = {figure["name"]: figure["value"] for figure in outcome.key_figures}
    assert figures["length_km"] == pytest.approx(rows[-1]["distance_m"] / 1000.0)
    assert [row.station for row in outcome.calls["11"] if math.isnan(row.actual_s)] == ["C"]


def test_errors_of_the_inputs_stop_it(scenario):
    with pytest.raises(InputError, match="substations"):
        compute_journeys(apply_changes(scenario, ["supply.substations[S].km=99"]), MemoryWriter())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"form": "place"}, "form 'place': allowed are time and speed"),
        ({"voltage_v": 0.0}, "voltage_v 0.0: allowed are finite numbers above 0 V"),
        ({"voltage_v": math.inf}, "voltage_v inf"),
        ({"voltage_v": "3000"}, "voltage_v '3000'"),
        ({"step_s": 0.01}, "step_s 0.01: allowed are 0.02 to 5 s"),
        ({"step_s": math.nan}, "step_s nan"),
        ({"step_s": True}, "step_s "),
    ],
)
def test_an_option_that_is_not_allowed(scenario, options, words):
    with pytest.raises(UsageError, match=re.escape(words)):
        journeys(scenario, **options)


def test_journeys_in_memory_take_the_same_options(scenario):
    results = journeys(scenario, voltage_v=np.float32(2500.0), step_s=1, form="speed", runs=["11"])
    assert [results.run[name] for name in ("voltage_v", "step_s", "form")] == [2500.0, 1.0, "speed"]
    assert results.run["verdicts"] == []
    assert min(results.run["compile_seconds"], results.run["wall_seconds"]) > 0.0
    assert json.dumps(results.run)
    with pytest.raises(TypeError, match="volts"):
        journeys(scenario, volts=3000.0)

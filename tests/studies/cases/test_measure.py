"""What is measured of a case against the tables and key figures of the whole run of the same scenario."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling
from small_studies import load, make_scenario, run_in_memory

from tractionpower.cosimulation import quiet
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.feasibility.study import feasibility


def figures_of(results):
    return {(figure["name"], figure["place"]): figure["value"] for figure in results.key_figures}


@pytest.mark.parametrize("seed", [0, 2, 3])
def test_figures_are_those_of_the_whole_run(seed):
    scenario = RandomCoupling(seed).scenario
    case, (results, outcome, _) = measure(scenario), run_in_memory(scenario)
    told, known = case.figures, {name: value for (name, _), value in figures_of(results).items()}
    assert told["lowest_voltage_v"] == known["lowest_voltage_v"]
    assert told["highest_voltage_v"] == known["highest_voltage_v"]
    energy = sum(value for (name, place), value in figures_of(results).items() if name == "energy_kwh" and "substation" in place)
    assert told["energy_kwh"] == pytest.approx(energy, rel=1e-12)
    assert told["line_loss_kwh"] == pytest.approx(known["line_loss_kwh"], rel=1e-12)
    assert told["status"] == outcome.run["status"]
    assert told["flagged_steps"] == outcome.run["flagged_steps"]


def test_the_profile_is_that_of_trains_of_the_whole_run(busy_coupling):
    case, (results, _, _) = measure(busy_coupling), run_in_memory(busy_coupling)
    whole = results.table("profile").query("where == 'pantograph'").set_index(["track", "km"])["lowest_voltage_v"]
    profile = case.tables["case_profile"].to_pandas().set_index(["track", "km"])["lowest_voltage_v"]
    assert dict(zip(whole.index, profile[whole.index], strict=True)) == dict(zip(whole.index, whole, strict=True))
    assert list(profile.index) == sorted(profile.index)


def test_fixed_places_count_where_no_train_came_near(busy_coupling):
    half = busy_coupling.model_copy(update={"clock": busy_coupling.clock.model_copy(update={"end": 300.0})})
    results, _, _ = run_in_memory(half)
    whole = results.table("profile").astype({"track": str, "where": str})
    trains, fixed = whole[whole["where"] == "pantograph"], whole[whole["where"] != "pantograph"]
    kept = [
        (track, km) for track, km in zip(fixed["track"], fixed["km"], strict=True)
        if (np.abs(trains["km"][trains["track"] == track] - km) > 0.5).all()
    ]  # fmt: skip
    profile = measure(half).tables["case_profile"].to_pandas().set_index(["track", "km"])["lowest_voltage_v"]
    assert 0 < len(set(kept)) < len(set(zip(fixed["track"], fixed["km"], strict=True)))
    assert set(profile.index) == {*kept, *zip(trains["track"], trains["km"], strict=True)}
    for track, km in kept:
        assert profile[track, km] == fixed["lowest_voltage_v"][(fixed["track"] == track) & (fixed["km"] == km)].min()


@pytest.fixture(scope="module")
def busy_coupling():
    warm = {"warm_up": 100.0}
    runs = [run("1", time=0.0), run("2", "series_motors", "2", 20.0, 0.0, time=30.0), run("3", "table", time=200.0)]
    leaky = [{"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.02, "leakage_s_per_km": 0.1}]
    return couple(*runs, end_s=600.0, return_circuit=leaky).model_copy(
        update={"clock": couple(*runs, end_s=600.0).clock.model_copy(update=warm)}
    )


def test_rail_potentials_and_useful_voltages_are_those_of_the_whole_run(busy_coupling):
    case, (results, _, _) = measure(busy_coupling), run_in_memory(busy_coupling)
    figures = figures_of(results)
    lowest = min(value for (name, _), value in figures.items() if name == "lowest_rail_potential_v")
    highest = max(value for (name, _), value in figures.items() if name == "highest_rail_potential_v")
    assert case.figures["rail_potential_v"] == pytest.approx(max(-lowest, highest), rel=1e-12)
    rails = case.tables["case_rails"].to_pandas()
    assert rails["lowest_potential_v"].min() == pytest.approx(lowest, rel=1e-6)
    assert rails["highest_potential_v"].max() == pytest.approx(highest, rel=1e-6)
    useful = {place: value for (name, place), value in figures.items() if name == "mean_useful_voltage_current_weighted_v"}
    trains = {place: value for place, value in useful.items() if place.startswith("train ")}
    assert case.figures["useful_train_v"] == pytest.approx(min(trains.values()), rel=1e-12)
    assert f"train {case.figures['useful_train']}" == min(trains, key=lambda place: trains[place])
    means = {place: value for (name, place), value in figures.items() if name == "mean_useful_voltage_time_mean_v"}
    of_zones = {place: value for place, value in means.items() if place.startswith("zone ")}
    of_trains = {place: value for place, value in means.items() if place.startswith("train ")}
    for kind, known in (("zone", of_zones), ("train", of_trains)):
        assert case.figures[f"useful_{kind}_time_mean_v"] == pytest.approx(min(known.values()), rel=1e-12)
        assert f"{kind} {case.figures[f'useful_{kind}_time_mean']}" == min(known, key=lambda place: known[place])
    assert case.figures["useful_train_time_mean_v"] != case.figures["useful_train_v"]


@pytest.fixture(scope="module")
def quarters():
    """A quarter of an hour whose ends steps of 3.5 s straddle; ten substations of two supply points, one with changing units."""
    plants = [
        {"id": f"S{k}", "km": 20.0 * k / 9, "no_load_voltage_v": 3600.0 + k, "internal_resistance_ohm": 0.1, "units": 2,
         "dissipative_resistance_ohm": 0.013, "supply_point": "PQ"[k % 2]}
        for k in range(10)
    ]  # fmt: skip
    plants[3] |= {"rated_current_a": 300.0, "reserve_units": 1, "reserve_after_s": 600.0, "reserve_overload_percent": 50.0}
    runs = [run("1", time=0.0), run("2", "series_motors", "2", 20.0, 0.0, time=30.0), run("3", "table", time=200.0)]
    events = [{"device": "S3", "time": time, "units_in_service": k} for time, k in ((350.0, 1), (650.0, 2))]
    scenario = couple(*runs, substations=plants, switch_events=events)
    clock = scenario.clock.model_copy(update={"end": 2000.0, "step_s": 3.5, "warm_up": 60.0})
    return scenario.model_copy(update={"clock": clock})


@pytest.mark.parametrize("block", [1, 37])
@pytest.mark.parametrize("case", ["busy_coupling", "quarters"])
def test_nothing_depends_on_the_blocks(block, case, monkeypatch, request):
    scenario = request.getfixturevalue(case)
    whole = measure(scenario)
    assert np.isfinite(whole.figures["highest_demand_kw"]) == (case == "quarters")
    monkeypatch.setattr(quiet, "STEPS", block)
    pieces = measure(scenario)
    np.testing.assert_equal(pieces.figures, whole.figures)
    for name, table in whole.tables.items():
        assert pieces.tables[name].equals(table), name


def test_a_study_without_trains_and_a_run_shorter_than_any_window():
    case = measure(make_scenario(load("x", 5.0)))
    assert case.figures["lowest_voltage_v"] < 3600.0
    assert (case.figures["lowest_voltage_track"], case.figures["lowest_voltage_km"]) == ("1", 5.0)
    assert case.figures["late_trains"] == case.figures["stuck_trains"] == 0
    assert np.isnan(case.figures["highest_demand_kw"])
    assert case.tables["case_trains"].num_rows == case.tables["case_rails"].num_rows == 0


def test_the_demand_is_that_of_quarters_of_an_hour_and_of_the_points_that_substations_share():
    shared = [
        {"id": name, "km": km, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.1, "supply_point": "grid",
         "dissipative_resistance_ohm": 0.02}
        for name, km in (("A", 0.0), ("B", 20.0))
    ]  # fmt: skip
    scenario = make_scenario(load("x", 7.0), substations=shared, clock={"end": 900.0, "step_s": 5.0})
    case, (results, _, _) = measure(scenario), run_in_memory(scenario)
    rows = results.table("substations")
    assert case.figures["highest_demand_kw"] == pytest.approx((rows["power_kw"] + rows["loss_kw"]).sum() / 180, rel=1e-6)


def test_a_train_that_never_comes_is_late_by_the_time_left_and_one_without_voltage_is_stuck():
    dead = {"device": "A", "time": 60.0, "state": "open"}
    more = [{"device": "B", "time": 60.0, "state": "open"}]
    scenario = couple(run("x", calls=[{"station": "P", "arrival": 300.0}]), end_s=600.0, switch_events=[dead, *more])
    case = measure(scenario)
    assert case.figures["worst_late_s"] == 300.0
    assert (case.figures["late_trains"], case.figures["stuck_trains"]) == (1, 1)
    rows = case.tables["case_trains"].to_pylist()
    assert [(row["train"], row["late_s"], row["status"]) for row in rows] == [("x", 300.0, "stuck")]
    judged = feasibility(scenario)
    assert judged.run["feasibility"]["late_trains"] == 1


def test_a_stuck_train_of_which_no_call_was_due_has_no_lateness():
    """Stuck behind P, where it was in time, and before B, where it is not due yet."""
    dead = [{"device": name, "time": 500.0, "state": "open"} for name in "AB"]
    runs = [
        run("x", calls=[{"station": "P", "arrival": 900.0}, {"station": "B", "arrival": 1900.0}]),
        run("y", track="2", time=1200.0),
    ]
    case = measure(couple(*runs, end_s=600.0, switch_events=dead))
    row = next(row for row in case.tables["case_trains"].to_pylist() if row["train"] == "x")
    assert (row["late_s"], row["status"]) == (None, "stuck")

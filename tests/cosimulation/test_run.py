"""A run of a study: its tables, its clock, and the sums that must agree."""

import numpy as np
import pandas as pd
import pytest
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.cosimulation.run import Run
from tractionpower.errors import InputError
from tractionpower.results.store import MemoryWriter

CONTRACT = {
    "substations": {
        "time_s": "float64", "substation": "category", "voltage_v": "float32", "current_a": "float32",
        "power_kw": "float32", "regulation_kw": "float32", "loss_kw": "float32", "blocked": "bool",
    },
    "feeders": {
        "time_s": "float64", "substation": "category", "track": "category", "side": "category", "current_a": "float32",
    },
    "cabins": {
        "time_s": "float64", "section_cabin": "category", "track": "category", "side": "category", "current_a": "float32",
    },
    "loads": {
        "time_s": "float64", "load": "category", "voltage_v": "float32", "current_a": "float32", "power_kw": "float32",
    },
    "profile": {
        "km": "float64", "track": "category", "lowest_voltage_v": "float32", "mean_voltage_v": "float32",
        "highest_voltage_v": "float32", "count": "int32", "where": "category",
    },
    "events": {
        "time_s": "float64", "kind": "category", "subject": "category", "track": "category", "position_km": "float64",
        "value": "float64", "limit": "float64", "message": "category",
    },
}  # fmt: skip


def switched(name="x", low=3.0, high=6.0, **more):
    return load(name, **{"from": low, "to": high}, **more)


def tables_of(scenario):
    results, _, _ = run_in_memory(scenario)
    return {name: results.table(name) for name in results.tables}


# --- tables


@pytest.mark.parametrize("table", CONTRACT)
def test_columns_and_types_are_those_of_the_contract(table):
    found = tables_of(make_scenario(load("x")))[table]
    assert {name: str(dtype) for name, dtype in found.dtypes.items()} == CONTRACT[table]
    assert list(found.columns) == list(CONTRACT[table])


def test_one_row_for_every_step_and_device():
    tables = tables_of(make_scenario(load("x"), load("y", 15.0), load("z", 7.0, "2"), clock={"end": 12.0, "step_s": 0.5}))
    devices = {"substations": ["substation"], "feeders": ["substation", "track", "side"], "loads": ["load"]}
    for name, keys in devices.items():
        table = tables[name]
        times = np.arange(0.0, 12.0, 0.5)
        groups = table.groupby(keys, observed=True)
        assert len(table) == len(times) * groups.ngroups
        for _, rows in groups:
            np.testing.assert_array_equal(rows["time_s"], times)
    assert list(tables["loads"]["load"].cat.categories) == ["x", "y", "z"]
    assert sorted(tables["feeders"].groupby(["substation", "track", "side"], observed=True).groups) == [
        ("A", "1", "high_km"), ("A", "2", "high_km"), ("B", "1", "low_km"), ("B", "2", "low_km"),
    ]  # fmt: skip


def test_time_is_seconds_after_midnight_and_ends_a_step_before_the_end():
    clock = {"start": "23:59:50", "end": "24:00:10", "step_s": 2.0}
    times = tables_of(make_scenario(load("x"), clock=clock))["loads"]["time_s"]
    np.testing.assert_array_equal(times, np.arange(86390.0, 86410.0, 2.0))


def test_a_last_step_that_reaches_beyond_the_end_is_run():
    results, _, run = run_in_memory(make_scenario(load("x"), clock={"end": 10.0, "step_s": 3.0}))
    assert list(results.table("loads")["time_s"]) == [0.0, 3.0, 6.0, 9.0]
    assert run.steps == results.run["steps"] == 4


@pytest.mark.parametrize("step_s", [0.02, 0.05, 0.1, 0.3, 0.7, 1.1])
def test_rounding_makes_no_step_more_or_less(step_s):
    for steps in (7, 90, 600):
        scenario = make_scenario(load("x"), clock={"start": 1000.1, "end": 1000.1 + steps * step_s, "step_s": step_s})
        assert Run(scenario, MemoryWriter()).steps == steps


@pytest.mark.parametrize(("every", "kept"), [(None, 20), (1.0, 10), (2.5, 4), (10.0, 1)])
def test_rows_are_written_every_so_often_from_the_first_on(every, kept):
    clock = {"end": 10.0, "step_s": 0.5}
    results, _, _ = run_in_memory(make_scenario(switched(), clock=clock, output={"every_s": every}))
    times = results.table("loads")["time_s"]
    np.testing.assert_allclose(times, np.arange(kept) * (every or 0.5))
    assert results.key_figure("load_energy_kwh") == pytest.approx(3000.0 * 3.0 / 3600.0)  # every step counts
    assert results.table("profile")["count"].unique() == [20]


def test_before_the_first_load_comes_on_none_takes_anything():
    results, _, _ = run_in_memory(make_scenario(switched(), switched("y", 4.0, 5.0)))
    early = results.table("substations").query("time_s < 3")
    np.testing.assert_allclose(early["current_a"], 0.0, atol=1e-3)


def test_only_the_wanted_tables_are_written():
    assert set(tables_of(make_scenario(load("x"), output={"tables": ["loads", "events"]}))) == {"loads", "events"}
    assert set(tables_of(make_scenario(load("x"), output={"tables": []}))) == set()
    assert set(tables_of(make_scenario(load("x")))) == set(CONTRACT)


def test_a_network_without_loads_stands_at_the_no_load_voltage():
    tables = tables_of(make_scenario())
    assert "loads" not in tables
    np.testing.assert_allclose(tables["substations"]["voltage_v"], 3600.0)
    np.testing.assert_allclose(tables["substations"]["current_a"], 0.0, atol=1e-3)


# --- loads by time of day


def test_a_load_takes_from_its_first_to_the_step_before_its_last_time():
    tables = tables_of(make_scenario(switched(low=3.0, high=6.0)))
    loads = tables["loads"].set_index("time_s")
    assert list(loads.index[loads["current_a"] > 0]) == [3.0, 4.0, 5.0]
    np.testing.assert_allclose(loads.loc[[3.0, 4.0, 5.0], "power_kw"], 3000.0, rtol=1e-6)
    off = loads.loc[[0.0, 2.0, 6.0, 9.0]]
    np.testing.assert_array_equal(off[["current_a", "power_kw"]], 0.0)
    np.testing.assert_allclose(off["voltage_v"], 3600.0)  # a load that is off still has a voltage


@pytest.mark.parametrize(("more", "on"), [({"from": 4.0}, range(4, 10)), ({"to": 4.0}, range(4)), ({}, range(10))])
def test_a_load_may_have_one_time_or_none(more, on):
    loads = tables_of(make_scenario(load("x", **more)))["loads"]
    assert list(loads.loc[loads["current_a"] > 0, "time_s"]) == list(on)


@pytest.mark.parametrize("start", [0.0, 0.7, 25200.0])
@pytest.mark.parametrize("step_s", [0.02, 0.1, 0.3, 0.7])
def test_a_load_switches_in_the_step_that_starts_at_its_time(start, step_s):
    steps = 40
    for first in range(1, steps - 1):
        begin, end = round(start + first * step_s, 6), round(start + (first + 1) * step_s, 6)
        scenario = make_scenario(
            switched(low=begin, high=end), clock={"start": start, "end": start + steps * step_s, "step_s": step_s}
        )
        run = Run(scenario, writer := MemoryWriter())
        run.execute()
        current = writer.tables()["loads"]["current_a"].to_numpy()
        assert list(np.flatnonzero(current)) == [first], begin


# --- sums


def test_what_the_feeders_carry_is_what_the_rectifiers_feed():
    tables = tables_of(make_scenario(load("x"), load("y", 12.0, "2", power_kw=2000.0), switched("z", km=17.0)))
    feeders = tables["feeders"].groupby(["time_s", "substation"], observed=True)["current_a"].sum()
    fed = tables["substations"].set_index(["time_s", "substation"])["current_a"]
    pd.testing.assert_series_equal(feeders, fed, check_index_type=False, check_categorical=False, rtol=1e-5)


def test_what_the_rectifiers_feed_is_what_the_loads_take():
    tables = tables_of(make_scenario(load("x"), load("y", 12.0, "2", power_kw=-800.0), switched("z", km=17.0)))
    taken = tables["loads"].groupby("time_s")["current_a"].sum()
    fed = tables["substations"].groupby("time_s")["current_a"].sum()
    np.testing.assert_allclose(fed, taken, rtol=1e-5)


@pytest.mark.parametrize("step_s", [1.0, 0.25])
def test_energy_is_the_sum_of_power_times_step(step_s):
    results, _, _ = run_in_memory(make_scenario(load("x", 6.0), switched("y", km=15.0), clock={"step_s": step_s}))
    hours = step_s / 3600.0
    substations, loads = results.table("substations"), results.table("loads")
    for name, rows in substations.groupby("substation", observed=True):
        energy = results.key_figure("energy_kwh", f"substation {name}")
        assert energy == pytest.approx(rows["power_kw"].sum() * hours, rel=1e-6)
        assert results.key_figure("mean_current_a", f"substation {name}") == pytest.approx(rows["current_a"].mean(), rel=1e-6)
        rms = np.sqrt((rows["current_a"].astype(float) ** 2).mean())
        assert results.key_figure("rms_current_a", f"substation {name}") == pytest.approx(rms, rel=1e-6)
    for name, rows in loads.groupby("load", observed=True):
        energy = results.key_figure("load_energy_kwh", f"load {name}")
        assert energy == pytest.approx(rows["power_kw"].sum() * hours, rel=1e-6)


def test_the_electric_ledger_closes():
    stations = [station("A", 0.0, feeder_resistance_ohm=0.01, return_resistance_ohm=0.02), station("B", 20.0)]
    scenario = make_scenario(load("x"), load("y", 12.0, "2", power_kw=-2000.0), switched("z", km=17.0), substations=stations)
    results, outcome, _ = run_in_memory(scenario)
    ledger = results.run["ledgers"]["electric"]
    assert ledger["closes"] is True
    assert ledger["worst_gap_w"] < 0.01
    total = ledger["regulation_kwh"] + ledger["load_kwh"] + ledger["conductor_kwh"]
    assert ledger["source_kwh"] == pytest.approx(total, rel=1e-9)
    substations, loads = results.table("substations"), results.table("loads")
    assert ledger["load_kwh"] == pytest.approx(loads["power_kw"].sum() / 3600.0, rel=1e-6)
    assert ledger["regulation_kwh"] == pytest.approx(substations["regulation_kw"].sum() / 3600.0, rel=1e-6)
    assert ledger["conductor_kwh"] == pytest.approx(results.key_figure("line_loss_kwh"))
    assert outcome.run["status"] == "complete"


def test_regulation_is_the_internal_drop_times_the_current():
    stations = [station("A", 0.0, grid_voltage_pu=1.02), station("B", 20.0)]
    rows = tables_of(make_scenario(load("x"), substations=stations))["substations"]
    no_load = rows["substation"].map({"A": 3672.0, "B": 3600.0}).astype(float)
    np.testing.assert_allclose(rows["regulation_kw"], (no_load - rows["voltage_v"]) * rows["current_a"] / 1000.0, rtol=1e-4)
    np.testing.assert_allclose(rows["regulation_kw"], 0.12 * rows["current_a"] ** 2 / 1000.0, rtol=1e-4)
    np.testing.assert_allclose(rows["power_kw"], rows["voltage_v"] * rows["current_a"] / 1000.0, rtol=1e-6)


def test_loss_is_heat_in_the_dissipative_resistance_and_empty_where_none_is_given():
    stations = [station("A", 0.0, dissipative_resistance_ohm=0.03), station("B", 20.0)]
    tables = tables_of(make_scenario(load("x"), substations=stations))
    rows = tables["substations"].set_index("substation")
    np.testing.assert_allclose(rows.loc["A", "loss_kw"], 0.03 * rows.loc["A", "current_a"] ** 2 / 1000.0, rtol=1e-5)
    assert (rows.loc["A", "loss_kw"] > 1.0).all()
    assert rows.loc["B", "loss_kw"].isna().all()


# --- states


@pytest.mark.parametrize("state", ["rectifiers_out", "bypassed", "open"])
def test_a_substation_that_does_not_feed(state):
    stations = [station("A", 0.0), station("B", 20.0), station("M", 8.0, state=state)]
    results, outcome, _ = run_in_memory(make_scenario(load("x"), load("y", 14.0, "2"), substations=stations))
    rows = results.table("substations").set_index("substation").loc["M"]
    np.testing.assert_array_equal(rows[["current_a", "power_kw", "regulation_kw"]], 0.0)
    assert not rows["blocked"].any()
    if state == "rectifiers_out":  # its busbar still ties the tracks
        assert rows["voltage_v"].between(3000.0, 3600.0).all()
    else:
        assert rows["voltage_v"].isna().all()
    feeders = results.table("feeders").set_index("substation").loc["M", "current_a"]  # rows in every state, it may change
    assert len(feeders) == 4 * len(rows)
    assert (feeders.abs() > 10.0).any() == (state == "rectifiers_out")
    assert state == "rectifiers_out" or (feeders == 0.0).all()
    assert results.key_figure("energy_kwh", "substation M") == 0.0
    assert outcome.run["status"] == "complete"
    assert all(np.isfinite(figure["value"]) for figure in results.key_figures)


def test_a_rectifier_blocks_when_the_line_is_above_its_no_load_voltage():
    rows = tables_of(make_scenario(load("x", 1.0, power_kw=-4000.0), load("y", 19.0, power_kw=2000.0)))["substations"]
    blocked = rows.set_index("substation")["blocked"]
    assert blocked["A"].all()
    assert (rows["voltage_v"] > 3600.0).eq(rows["blocked"]).all()
    np.testing.assert_allclose(rows.loc[rows["blocked"], "current_a"], 0.0, atol=1e-3)


# --- warm-up


def test_the_warm_up_is_simulated_and_written_but_left_out_of_the_key_figures():
    heavy = load("heavy", 5.0, power_kw=6000.0, to=4.0)
    light = load("light", 5.0, power_kw=1000.0)
    figures = {}
    for warm_up in (None, 4.0):
        results, outcome, _ = run_in_memory(make_scenario(heavy, light, clock={"warm_up": warm_up}))
        assert len(results.table("loads")) == 20
        figures[warm_up] = results
        assert outcome.run["steps"] == 10
    rows = figures[4.0].table("loads")
    late = rows[rows["time_s"] >= 4.0]
    assert figures[4.0].key_figure("load_energy_kwh", "load heavy") == 0.0
    assert figures[4.0].key_figure("load_energy_kwh", "load light") == pytest.approx(1000.0 * 6.0 / 3600.0)
    assert figures[4.0].key_figure("lowest_voltage_v") == pytest.approx(late["voltage_v"].min(), rel=1e-6)
    assert figures[None].key_figure("lowest_voltage_v") == pytest.approx(rows["voltage_v"].min(), rel=1e-6)
    assert list(figures[4.0].table("profile")["count"].unique()) == [6]


# --- what does not matter


def test_the_order_of_devices_in_the_input_does_not_matter():
    loads = [load("x", 3.0), load("y", 12.0, "2", power_kw=-900.0), switched("z", km=12.0), load("w", 17.0, current_a=500.0)]
    stations = [station("A", 0.0), station("B", 20.0), station("M", 8.0, feeder_resistance_ohm=0.01)]
    forward, _, _ = run_in_memory(make_scenario(*loads, substations=stations))
    for order in ([3, 1, 0, 2], [3, 2, 1, 0]):
        other, _, _ = run_in_memory(make_scenario(*[loads[k] for k in order], substations=stations[::-1]))
        for name in forward.tables:
            pd.testing.assert_frame_equal(other.table(name), forward.table(name), check_exact=True)
        assert other.key_figures == forward.key_figures
        assert other.run["ledgers"] == forward.run["ledgers"]


def test_two_runs_of_one_scenario_are_the_same():
    scenario = make_scenario(load("x"), switched("y", km=12.0))
    first, second = (run_in_memory(scenario)[0] for _ in range(2))
    assert first.key_figures == second.key_figures
    for name in first.tables:
        pd.testing.assert_frame_equal(first.table(name), second.table(name), check_exact=True)


# --- the run itself


def test_progress_is_told_up_to_the_last_step():
    told = []
    Run(make_scenario(load("x"), clock={"end": 1000.0}), MemoryWriter()).execute(lambda done, total: told.append((done, total)))
    done = [pair[0] for pair in told]
    assert told[-1] == (1000, 1000)
    assert done == sorted(set(done))
    assert len(told) > 1  # the first block is short


def test_run_json_says_what_the_solution_is_worth():
    scenario = make_scenario(load("x"), name="Name", seed=7)
    _, outcome, _ = run_in_memory(scenario)
    run = outcome.run
    assert (run["format"], run["study"], run["name"], run["seed"], run["steps"]) == (1, "test", "Name", 7, 10)
    assert run["input_hash"] == scenario.input_hash
    assert {"tractionpower", "numba", "numpy"} <= set(run["versions"])
    assert 0.0 <= run["worst_residual_a"] <= run["residual_limit_a"]
    assert run["flagged_steps"] == 0
    assert run["mean_iterations"] > 0
    assert run["wall_seconds"] > 0
    assert run["compile_seconds"] > 0
    assert not outcome.flagged


def test_verdicts_name_limit_place_and_source():
    _, outcome, _ = run_in_memory(make_scenario(load("x", 9.0, power_kw=8000.0)))
    lowest, highest = outcome.run["verdicts"]
    assert (lowest["limit"], lowest["limit_value"], lowest["met"]) == ("u_min2", 2000.0, True)
    assert (lowest["place"], lowest["time"]) == ("load x, track 1, km 9", "00:00:00")
    assert (highest["limit"], highest["limit_value"], highest["met"]) == ("u_max2", 3900.0, True)
    assert lowest["source"]
    assert lowest["status"] in {"verified", "secondary", "recalled"}


def test_a_violated_limit_is_no_flag():
    _, outcome, _ = run_in_memory(make_scenario(load("x", 10.0, current_a=9000.0)))
    lowest, _ = outcome.run["verdicts"]
    assert not lowest["met"]
    assert outcome.run["status"] == "complete"


def test_a_scenario_with_errors_is_not_run():
    with pytest.raises(InputError) as caught:
        Run(make_scenario(load("x", 99.0), load("y", track="7")), MemoryWriter())
    assert {problem.path for problem in caught.value.problems} == {"supply.loads[x].km", "supply.loads[y].track"}

"""What the recorder sums up of substations and of the run as a whole, against the tables looked at anew."""

import numpy as np
import pytest
from coupled import MIXED, couple, run
from small_studies import load, make_scenario, run_in_memory

from tractionpower.model.base import parse_time

WINDOWS_S = {"10_s": 10, "15_s": 15, "1_min": 60, "5_min": 300, "15_min": 900}


def series(results, substation, column):
    rows = results.table("substations")
    return rows[rows["substation"] == substation].set_index("time_s")[column].astype(float)


@pytest.mark.parametrize("name", ["A", "M", "B"])
@pytest.mark.parametrize(("label", "rows"), WINDOWS_S.items())
def test_highest_sliding_means(busy, name, label, rows):
    place = f"substation {name}"
    means = series(busy.results, name, "power_kw").rolling(rows).mean()
    found = busy.noted(f"highest_mean_power_{label}_kw", place)
    assert found["value"] == pytest.approx(means.max(), rel=1e-5)
    begins = parse_time(found["time"])
    assert means[begins + rows - 1.0] == pytest.approx(means.max(), rel=1e-6)
    squares = (series(busy.results, name, "current_a") ** 2).rolling(rows).mean()
    found = busy.noted(f"highest_rms_current_{label}_a", place)
    assert found["value"] == pytest.approx(np.sqrt(squares.max()), rel=1e-5)
    assert squares[parse_time(found["time"]) + rows - 1.0] == pytest.approx(squares.max(), rel=1e-6)


def test_windows_longer_than_the_run_are_absent(busy):
    names = {each["name"] for each in busy.results.key_figures}
    assert "highest_mean_power_15_min_kw" in names
    assert not names & {f"highest_mean_power_{label}_kw" for label in ("30_min", "60_min", "120_min", "180_min")}


@pytest.mark.parametrize("start", [0.0, 25000.0])
def test_demand_is_billed_by_the_quarters_of_the_clock(start):
    loads = [load("x", 5.0, **{"from": start + 850.0, "to": start + 1750.0})]
    results, _, _ = run_in_memory(make_scenario(*loads, clock={"start": start, "end": start + 2900.0, "step_s": 2.0}))
    power = series(results, "A", "power_kw")
    quarters = power.groupby(np.floor(power.index / 900.0)).agg(["mean", "count"])
    complete = quarters[quarters["count"] == 450]["mean"]
    assert len(complete) >= 2
    (found,) = [
        each
        for each in results.key_figures
        if each["name"] == "highest_clock_15_min_power_kw" and each["place"] == "substation A"
    ]
    assert found["value"] == pytest.approx(complete.max(), rel=1e-5)
    assert parse_time(found["time"]) == complete.idxmax() * 900.0


@pytest.mark.parametrize("name", ["A", "M", "B"])
def test_figures_of_a_substation(busy, name):
    place, current = f"substation {name}", series(busy.results, name, "current_a")
    power = series(busy.results, name, "power_kw")
    assert busy.figure("highest_current_a", place) == pytest.approx(current.max(), rel=1e-6)
    assert parse_time(busy.noted("highest_current_a", place)["time"]) == current.idxmax()
    assert busy.figure("mean_current_a", place) == pytest.approx(current.mean(), rel=1e-5)
    assert busy.figure("rms_current_a", place) == pytest.approx(np.sqrt((current**2).mean()), rel=1e-5)
    assert busy.figure("highest_power_kw", place) == pytest.approx(power.max(), rel=1e-6)
    assert busy.figure("energy_kwh", place) == pytest.approx(power.sum() / 3600.0, rel=1e-5)


@pytest.mark.parametrize("name", ["A", "M", "B"])
def test_what_the_plant_of_a_substation_keeps(busy, name):
    place, volts = f"substation {name}", series(busy.results, name, "voltage_v")
    assert busy.figure("lowest_busbar_voltage_v", place) == pytest.approx(volts.min(), rel=1e-6)
    assert parse_time(busy.noted("lowest_busbar_voltage_v", place)["time"]) == volts.idxmin()
    assert busy.figure("mean_busbar_voltage_v", place) == pytest.approx(volts.mean(), rel=1e-6)
    regulation = series(busy.results, name, "regulation_kw").sum() / 3600.0
    assert busy.figure("plant_regulation_kwh", place) == pytest.approx(regulation, rel=1e-5, abs=1e-6)


def test_the_substations_together_regulate_what_the_ledger_says(busy):
    parts = [busy.figure("plant_regulation_kwh", f"substation {name}") for name in "AMB"]
    assert sum(parts) == pytest.approx(busy.figure("regulation_energy_kwh"), rel=1e-9)


def test_heat_and_energy_fed_back_of_a_plant():
    plant = {"conducts": "both", "dissipative_resistance_ohm": 0.03}
    stations = [{"id": "A", "km": 0.0, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12, **plant}]
    stations.append({"id": "B", "km": 20.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12})
    results, *_ = run_in_memory(make_scenario(load("late", 3.0, **{"from": 5.0}), substations=stations))
    figures = {each["name"]: each["value"] for each in results.key_figures if each["place"] == "substation A"}
    power, current = series(results, "A", "power_kw"), series(results, "A", "current_a")
    assert power.min() < -1.0 < 1.0 < power.max()
    assert figures["energy_fed_back_kwh"] == pytest.approx(-power.clip(upper=0.0).sum() / 3600.0, rel=1e-5)
    assert figures["plant_heat_kwh"] == pytest.approx(0.03 * (current**2).sum() / 3.6e6, rel=1e-5)
    assert not [each for each in results.key_figures if "fed_back" in each["name"] and each["place"] == "substation B"]


def test_what_substations_feed_is_what_trains_loads_and_lines_take(busy):
    ledger = busy.results.run["ledgers"]["electric"]
    fed = sum(busy.figure("energy_kwh", f"substation {name}") for name in "AMB")
    assert fed == pytest.approx(ledger["source_kwh"] - ledger["regulation_kwh"], rel=1e-9)
    loads = sum(busy.figure("load_energy_kwh", f"load {name}") for name in ("heavy", "feeds"))
    trains = busy.trains["power_kw"].sum() / 3600.0
    assert fed == pytest.approx(loads + trains + busy.figure("line_loss_kwh"), rel=1e-5)
    currents = busy.results.table("substations").groupby("time_s")["current_a"].sum()
    taken = busy.trains.groupby("time_s")["current_a"].sum()
    taken = taken.add(busy.results.table("loads").groupby("time_s")["current_a"].sum(), fill_value=0.0)
    np.testing.assert_allclose(currents, taken.reindex(currents.index, fill_value=0.0), atol=0.01)


def test_cross_sections_of_the_profile_count_every_step(busy):
    profile = busy.results.table("profile").query("where == 'cross_section'")
    assert set(profile["count"]) == {1000}
    at_a = profile[profile["km"] == 0.0]
    volts = series(busy.results, "A", "voltage_v")
    for column, value in (
        ("lowest_voltage_v", volts.min()),
        ("mean_voltage_v", volts.mean()),
        ("highest_voltage_v", volts.max()),
    ):
        np.testing.assert_allclose(at_a[column], value, rtol=1e-6)


def test_the_profile_counts_steps_with_a_voltage():
    """Half of the line is dead from the sixth step on, a piece of it always."""
    points = [{"id": f"X{km:g}", "track": "1", "km": km, "state": state} for km, state in ((8.0, "open"), (6.0, "closed"))]
    scenario = make_scenario(
        load("x", 12.0), load("y", 3.0, power_kw=500.0), tracks=("1",), section_points=points,
        switch_events=[{"time": "00:00:06", "device": "A", "state": "rectifiers_out"}],
    )  # fmt: skip
    results, _, _ = run_in_memory(scenario)
    profile = results.table("profile").set_index("km")
    assert profile["count"].to_dict() == {0.0: 6, 3.0: 6, 6.0: 6, 8.0: 10, 12.0: 10, 20.0: 10}
    loads = results.table("loads").query("load == 'y'")["voltage_v"]
    assert loads.iloc[6:].tolist() == [0.0] * 4
    assert profile.loc[3.0, "mean_voltage_v"] == pytest.approx(loads.iloc[:6].mean(), rel=1e-6)
    assert profile.loc[3.0, "lowest_voltage_v"] == pytest.approx(loads.iloc[:6].min(), rel=1e-6)
    before = run_in_memory(scenario.model_copy(update={"clock": scenario.clock.model_copy(update={"end": 6.0})}))[0]
    volts = [run.table("profile").set_index("km").loc[8.0, "mean_voltage_v"] for run in (before, results)]
    other = run_in_memory(make_scenario(load("x", 12.0), tracks=("1",), section_points=points[:1]))[0]
    far = other.table("profile").set_index("km").loc[12.0, "mean_voltage_v"]  # beyond the cut it is that of the load
    assert far == pytest.approx(profile.loc[12.0, "mean_voltage_v"], rel=1e-6)
    near = 2.0 * volts[0] - far
    assert volts[1] == pytest.approx((6 * near + 10 * far) / 16, rel=1e-5)  # both sides, each with its steps


def test_places_that_never_have_a_voltage_have_no_row():
    points = [{"id": f"X{km:g}", "track": "1", "km": km, "state": "open"} for km in (6.0, 8.0)]
    results, _, _ = run_in_memory(make_scenario(load("x", 3.0), load("z", 7.0), tracks=("1",), section_points=points))
    profile = results.table("profile")
    assert profile["km"].tolist() == [0.0, 3.0, 6.0, 8.0, 20.0]
    assert set(profile["count"]) == {10}
    assert np.isfinite(profile["lowest_voltage_v"]).all()


# --- verdicts


def verdicts(results):
    return {each["name"]: each for each in results.run["verdicts"]}


def test_verdicts_hold_figures_against_limits(busy):
    found = verdicts(busy.results)
    assert found["lowest voltage"]["value"] == busy.figure("lowest_voltage_v", found["lowest voltage"]["place"])
    assert (found["lowest voltage"]["limit_value"], found["lowest voltage"]["met"]) == (2000.0, False)
    assert (found["highest voltage"]["limit_value"], found["highest voltage"]["met"]) == (3900.0, False)
    spell = busy.noted("longest_spell_above_u_max1_s")
    told = found["longest spell above U_max1"]
    assert (told["value"], told["place"], told["time"]) == (spell["value"], spell["place"], spell["time"])
    assert told["met"] == (spell["value"] <= told["limit_value"])


@pytest.mark.parametrize("who", ["train", "zone"])
@pytest.mark.parametrize(
    ("title", "figure"),
    [
        ("current-weighted", "mean_useful_voltage_current_weighted_v"),
        ("time mean", "mean_useful_voltage_time_mean_v"),
    ],
)
def test_the_lowest_mean_useful_voltage_is_judged(busy, who, title, figure):
    values = {
        each["place"]: each["value"]
        for each in busy.results.key_figures
        if each["name"] == figure and each["place"].startswith(who)
    }
    told = verdicts(busy.results)[f"mean useful voltage of {who}s, {title}"]
    assert len(values) == (8 if who == "train" else 2)
    assert told["place"] == min(values, key=values.get)
    assert told["value"] == min(values.values())
    assert told["met"] == (told["value"] >= told["limit_value"] - 0.1)


def test_what_is_violated_is_an_event(busy):
    events = busy.results.table("events").query("kind == 'limit_violated'")
    missed = [each for each in busy.results.run["verdicts"] if not each["met"]]
    assert sorted(events["subject"]) == sorted(each["name"] for each in missed)
    assert len(missed) >= 2


def test_a_run_without_trains_judges_no_trains():
    results, _, _ = run_in_memory(make_scenario(load("x")))
    assert list(verdicts(results)) == ["lowest voltage", "highest voltage"]
    assert not [each for each in results.key_figures if each["place"].startswith(("train", "zone"))]


# --- what a run says


def test_a_run_at_constant_voltage_says_what_it_leaves_out():
    results, _, _ = run_in_memory(couple(*MIXED, coupling="constant_voltage", coupling_voltage_v=2900.0, end_s=500.0))
    rows = results.table("trains")
    told = results.run["ledgers"]["pantograph_to_wheel"]
    assert results.run["coupling"] == "constant_voltage"
    assert told["closes"]
    reckoned = results.table("trains")["current_a"].astype(float) * 2900.0
    assert (rows["voltage_v"] < 3600.0).mean() > 0.95  # where the line folds nothing back, the currents are those reckoned
    left_out = (rows["voltage_v"].astype(float) * rows["current_a"] - reckoned).sum() / 3.6e6
    assert told["coupling_kwh"] == pytest.approx(left_out, rel=2e-3)
    assert abs(left_out) > 1.0
    assert told["line_kwh"] == pytest.approx((rows["voltage_v"].astype(float) * rows["current_a"]).sum() / 3.6e6, rel=1e-5)


def test_a_ledger_that_does_not_close_flags_the_run():
    scenario = couple(run("E"), end_s=60.0)
    _, outcome, made = run_in_memory(scenario)
    assert outcome.run["status"] == "complete"
    made.recorder.trains._pantograph[0, 0] *= 1.0001
    assert made.outcome().run["status"] == "flagged"
    assert not made.outcome().run["ledgers"]["pantograph_to_wheel"]["closes"]

"""What the recorder sums up of trains as rows come, against the table of all rows looked at anew."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from coupled import LENGTH_KM, MIXED, couple, run
from small_studies import run_in_memory

from tractionpower.model.base import parse_time

NAMES = ("E1", "E2", "E3", "M1", "M2", "S1", "S2", "T1")
U_MAX1, U_MAX2, U_MIN2 = 3600.0, 3900.0, 2000.0
TOLERANCE_V = 0.1
BOUNDS_KM = (("A–M", 0.0, 9.0), ("M–B", 9.0, 20.0))


def kwh(power_kw, step_s=1.0):
    return float(power_kw.sum()) * step_s / 3600.0


# --- energies


@pytest.mark.parametrize("name", NAMES)
def test_energies_are_sums_of_the_rows(busy, name):
    rows, place = busy.rows(name), f"train {name}"
    expected = {
        "energy_taken_kwh": rows["power_kw"].clip(lower=0.0),
        "energy_returned_kwh": -rows["power_kw"].clip(upper=0.0),
        "auxiliary_energy_kwh": rows["auxiliary_power_kw"],
        "drive_loss_kwh": rows["drive_loss_kw"],
        "starting_resistor_energy_kwh": rows["starting_resistor_kw"],
        "refused_energy_kwh": rows["refused_regeneration_kw"],
    }
    for figure, power in expected.items():
        assert busy.figure(figure, place) == pytest.approx(kwh(power), rel=1e-6, abs=1e-5), figure


@pytest.mark.parametrize("name", NAMES)
def test_mean_useful_voltages_are_quotients_of_the_sums(busy, name):
    rows, place = busy.rows(name), f"train {name}"
    volts, amps = rows["voltage_v"].astype(float), rows["current_a"].astype(float).abs()
    energy, charge = busy.figure("useful_energy_kwh", place), busy.figure("useful_charge_ah", place)
    assert energy == pytest.approx((volts * amps).sum() / 3.6e6, rel=1e-5)
    assert charge == pytest.approx(amps.sum() / 3600.0, rel=1e-5)
    assert 1000.0 * energy / charge == pytest.approx(busy.figure("mean_useful_voltage_current_weighted_v", place), rel=1e-12)
    volt_seconds, seconds = (
        busy.figure(f"{what}_of_useful_steps_{unit}", place) for what, unit in (("voltage", "vs"), ("time", "s"))
    )
    assert seconds == (rows["tractive_force_kn"] > 0.0).sum()
    assert volt_seconds / seconds == pytest.approx(busy.figure("mean_useful_voltage_time_mean_v", place), rel=1e-12)


@pytest.mark.parametrize("zone", ["A–M", "M–B"])
def test_mean_useful_voltages_of_zones_are_quotients_of_the_sums(busy, zone):
    place = f"zone {zone}"
    quotient = 1000.0 * busy.figure("useful_power_kw", place) / busy.figure("useful_current_a", place)
    assert quotient == pytest.approx(busy.figure("mean_useful_voltage_current_weighted_v", place), rel=1e-12)
    quotient = busy.figure("voltage_of_useful_steps_vs", place) / busy.figure("time_of_useful_steps_s", place)
    assert quotient == pytest.approx(busy.figure("mean_useful_voltage_time_mean_v", place), rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_voltages_of_a_train_and_where_the_lowest_is(busy, name):
    rows, place = busy.rows(name), f"train {name}"
    highest = busy.noted("highest_pantograph_voltage_v", place)
    assert highest["value"] == pytest.approx(rows["voltage_v"].max(), rel=1e-6)
    assert busy.figure("mean_pantograph_voltage_v", place) == pytest.approx(rows["voltage_v"].astype(float).mean(), rel=1e-6)
    worst = rows.loc[rows["voltage_v"].idxmin()]
    told = next(each for each in busy.results.run["trains"] if each["train"] == name)
    assert told["lowest_voltage_track"] == worst["track"]
    assert told["lowest_voltage_km"] == pytest.approx(worst["position_km"], abs=1e-9)


def test_there_is_something_of_every_energy(busy):
    for name in ("energy_returned_kwh", "refused_energy_kwh", "drive_loss_kwh", "auxiliary_energy_kwh"):
        assert busy.figure(name, "train E2") > 1.0
    assert busy.figure("starting_resistor_energy_kwh", "train M1") > 1.0


def test_ledgers_hold_the_energies_of_all_rows(busy):
    ledgers, rows = busy.results.run["ledgers"], busy.trains
    assert ledgers["electric"]["train_kwh"] == pytest.approx(kwh(rows["power_kw"]), rel=1e-6)
    told = ledgers["pantograph_to_wheel"]
    expected = {
        "line_kwh": rows["voltage_v"] * rows["current_a"] / 1e3,
        "wheel_kwh": rows["wheel_power_kw"],
        "auxiliaries_kwh": rows["auxiliary_power_kw"],
        "starting_resistors_kwh": rows["starting_resistor_kw"],
        "drive_loss_kwh": rows["drive_loss_kw"],
    }
    for name, power in expected.items():
        assert told[name] == pytest.approx(kwh(power), rel=1e-6), name
    for ledger in ledgers.values():
        assert ledger["closes"] is True


def test_the_mechanical_ledger_is_that_of_positions_and_speeds(busy):
    told = busy.results.run["ledgers"]["mechanical"]
    masses = {"E": 180e3, "M": 180e3, "S": 400e3, "T": 180e3}
    kinetic = 0.0
    for planned in busy.scenario.timetable.trains:
        rows = busy.rows(planned.id)
        mass = 400e3 if planned.train == "strong" else masses[planned.id[0]]
        first, last = rows.iloc[0], rows.iloc[-1]
        end = last["speed_kmh"] / 3.6 + last["acceleration_mps2"]
        kinetic += 0.5 * mass * (end**2 - (first["speed_kmh"] / 3.6) ** 2)
    assert told["kinetic_kwh"] == pytest.approx(kinetic / 3.6e6, rel=1e-4)
    assert told["potential_kwh"] == 0.0  # the line is level
    spent = told["kinetic_kwh"] + told["potential_kwh"] + told["resistance_kwh"] + told["brakes_kwh"]
    assert told["wheel_kwh"] == pytest.approx(spent, rel=1e-3)


# --- extremes and windows


@pytest.mark.parametrize("name", NAMES)
def test_extremes_are_those_of_the_rows(busy, name):
    rows, place = busy.rows(name), f"train {name}"
    for figure, column, worst in (
        ("lowest_pantograph_voltage_v", "voltage_v", rows["voltage_v"].idxmin()),
        ("highest_current_a", "current_a", rows["current_a"].idxmax()),
        ("highest_speed_kmh", "speed_kmh", rows["speed_kmh"].idxmax()),
    ):
        found = busy.noted(figure, place)
        assert found["value"] == pytest.approx(rows[column][worst], rel=1e-6)
        near = rows[np.isclose(rows[column], rows[column][worst], rtol=2e-7)]["time_s"]  # equal in 32 bits
        assert parse_time(found["time"]) in near.tolist()


def test_the_lowest_voltage_of_the_run_says_where_and_when(busy):
    every = busy.results.table("loads")[["voltage_v", "time_s"]].assign(place="load")
    trains = busy.trains[["voltage_v", "time_s"]].assign(place=busy.trains["train"])
    lowest = pd.concat([every, trains]).nsmallest(1, "voltage_v").iloc[0]
    found = busy.noted("lowest_voltage_v")
    assert found["value"] == pytest.approx(lowest["voltage_v"], rel=1e-6)
    assert parse_time(found["time"]) == lowest["time_s"]
    assert lowest["place"] == "load"
    assert found["place"].startswith("load heavy")


def test_where_a_train_has_the_lowest_voltage_it_is_named_with_track_and_kilometre():
    results, _, _ = run_in_memory(couple(*MIXED, end_s=400.0))
    rows = results.table("trains")
    worst = rows.loc[rows["voltage_v"].idxmin()]
    (found,) = [each for each in results.key_figures if each["name"] == "lowest_voltage_v"]
    assert found["place"] == f"train {worst['train']}, track {worst['track']}, km {worst['position_km']:.2f}"
    assert parse_time(found["time"]) == worst["time_s"]


@pytest.mark.parametrize("name", NAMES)
def test_the_lowest_mean_over_ten_seconds(busy, name):
    volts = busy.rows(name)["voltage_v"]
    means = volts.rolling(10).mean().dropna()
    found = busy.noted("lowest_10_s_mean_voltage_v", f"train {name}")
    assert found["value"] == pytest.approx(means.min(), rel=1e-6)
    assert parse_time(found["time"]) == busy.rows(name)["time_s"][means.idxmin() - 9]


# --- mean useful voltage


@pytest.mark.parametrize("name", NAMES)
def test_mean_useful_voltage_of_a_train(busy, name):
    rows, place = busy.rows(name), f"train {name}"
    current = rows["current_a"].abs()
    weighted = (rows["voltage_v"] * current).sum() / current.sum()
    assert busy.figure("mean_useful_voltage_current_weighted_v", place) == pytest.approx(weighted, rel=1e-6)
    mean = rows.loc[rows["tractive_force_kn"] > 0.0, "voltage_v"].mean()
    assert busy.figure("mean_useful_voltage_time_mean_v", place) == pytest.approx(mean, rel=1e-6)
    assert abs(weighted - mean) > 1.0  # two definitions, two values


@pytest.mark.parametrize(("zone", "low", "high"), BOUNDS_KM)
def test_mean_useful_voltage_of_a_zone(busy, zone, low, high):
    km = busy.trains["position_km"]
    inside = busy.trains[(km >= low) & ((km < high) | ((km == 20.0) & (high == 20.0)))]
    energy = charge = 0.0
    for _, rows in inside.groupby("train"):
        energy += (rows["voltage_v"] * rows["current_a"].abs()).mean()
        charge += rows["current_a"].abs().mean()
    place = f"zone {zone}"
    assert busy.figure("mean_useful_voltage_current_weighted_v", place) == pytest.approx(energy / charge, rel=1e-6)
    assert busy.figure("mean_useful_voltage_time_mean_v", place) == pytest.approx(inside["voltage_v"].mean(), rel=1e-6)


# --- spells


def longest_spell(rows, beyond):
    """Return length and start of the longest spell, found row by row."""
    best, began, length = (0.0, np.nan), np.nan, 0.0
    for time_s, inside in zip(rows["time_s"], beyond, strict=True):
        began = time_s if inside and length == 0.0 else began
        length = length + 1.0 if inside else 0.0
        best = (length, began) if length > best[0] else best
    return best


@pytest.mark.parametrize(
    ("figure", "limit", "above"),
    [
        ("longest_spell_above_u_max1_s", U_MAX1, True),
        ("longest_spell_above_u_max2_s", U_MAX2, True),
        ("longest_spell_below_u_min2_s", U_MIN2, False),
    ],
)
def test_longest_spells(busy, figure, limit, above):
    spells = {}
    for name in NAMES:
        rows = busy.rows(name)
        excess = (rows["voltage_v"] - limit) * (1.0 if above else -1.0)
        spells[name] = longest_spell(rows, excess > TOLERANCE_V)
    worst = max(NAMES, key=lambda name: spells[name][0])
    found = busy.noted(figure)
    assert found["value"] == spells[worst][0] > 5.0
    assert found["place"] == f"train {worst}"
    assert parse_time(found["time"]) == spells[worst][1]


# --- along the line


def test_the_profile_at_pantographs_is_that_of_the_rows(busy):
    profile = busy.results.table("profile").query("where == 'pantograph'")
    bins = (np.floor(busy.trains["position_km"] / 0.5) * 0.5 + 0.25).clip(upper=LENGTH_KM)  # none lies beyond the track
    expected = busy.trains.groupby(["track", bins])["voltage_v"].agg(["min", "mean", "max", "count"])
    found = profile.astype({"track": str}).set_index(["track", "km"]).sort_index()
    assert list(found.index) == list(expected.index)
    for column, name in (
        ("lowest_voltage_v", "min"),
        ("mean_voltage_v", "mean"),
        ("highest_voltage_v", "max"),
        ("count", "count"),
    ):
        np.testing.assert_allclose(found[column], expected[name], rtol=1e-6)
    assert found["count"].sum() == len(busy.trains)


# --- times


def test_calls_are_where_the_rows_stand_still(busy):
    calls = busy.results.table("calls").set_index(["train", "station", "kind"])["actual_s"]
    for train, station, at_m in (("E1", "P", 6000.0), ("E2", "Q", 7000.0)):
        rows = busy.rows(train)
        stands = rows[np.isclose(rows["distance_m"], at_m, atol=0.11) & (rows["speed_kmh"] < 0.01)]["time_s"]
        assert 0.0 <= stands.min() - calls[train, station, "arrival"] < 1.0 + 1e-6
        assert 0.0 <= calls[train, station, "departure"] - stands.max() < 1.0 + 1e-6
    assert calls["E1", "P", "departure"] == 320.0  # not before its planned departure


def test_dwell_and_lateness(busy):
    calls = busy.results.table("calls").set_index(["train", "station", "kind"])
    times = calls["actual_s"]
    for train, station in (("E1", "P"), ("E2", "Q"), ("M1", "P")):
        dwell = times[train, station, "departure"] - times[train, station, "arrival"]
        assert calls["dwell_s"][train, station, "departure"] == pytest.approx(dwell, rel=1e-6)
    planned = calls["planned_s"].dropna()
    np.testing.assert_allclose(calls["late_s"].dropna(), times[planned.index] - planned, atol=1e-4)
    assert busy.figure("late_at_end_s", "train E1") == pytest.approx(times["E1", "B", "arrival"] - 800.0)
    assert busy.figure("late_at_end_s", "train E2") == pytest.approx(times["E2", "A", "arrival"] - 700.0)
    late = {each["place"] for each in busy.results.key_figures if each["name"] == "late_at_end_s"}
    assert late == {"train E1", "train E2"}


def test_journey_and_running_times(busy):
    times = busy.results.table("calls").set_index(["train", "station", "kind"])["actual_s"]
    said = {each["train"]: each for each in busy.results.run["trains"]}
    for planned in busy.scenario.timetable.trains:
        name, place = planned.id, f"train {planned.id}"
        journey = said[name]["finished_s"] - planned.start.time
        assert busy.figure("journey_time_s", place) == pytest.approx(journey)
        stood = sum(
            times[name, call.station, "departure"] - times[name, call.station, "arrival"]
            for call in planned.calls
            if (name, call.station, "departure") in times.index
        )
        assert busy.figure("running_time_s", place) == pytest.approx(journey - stood, abs=1e-6)
        length = abs(planned.route[0].to_km - planned.route[0].from_km)
        assert busy.figure("length_km", place) == pytest.approx(length, abs=1e-6)
        assert busy.figure("mean_speed_kmh", place) == pytest.approx(length * 3600.0 / (journey - stood), rel=1e-6)


def test_what_became_of_each_train(busy):
    said = {each["train"]: each for each in busy.results.run["trains"]}
    assert [said[name]["status"] for name in NAMES] == ["left", "stays", "left", "left", "left", "left", "left", "left"]
    for name in NAMES:
        rows = busy.rows(name)
        assert rows["time_s"].iloc[0] == np.floor(said[name]["entered_s"])
        if said[name]["status"] == "left":
            assert rows["time_s"].iloc[-1] == np.ceil(said[name]["finished_s"]) - 1.0
        else:
            assert rows["time_s"].iloc[-1] == 999.0
        assert (np.diff(rows["time_s"]) == 1.0).all()


@pytest.mark.parametrize(("end_s", "status"), [(20.0, "outside"), (60.0, "on_line"), (1000.0, "left")])
def test_status_at_the_end_of_the_clock(end_s, status):
    results, _, _ = run_in_memory(couple(run("E", time=30.0), end_s=end_s))
    (said,) = results.run["trains"]
    assert said["status"] == status
    assert (said["entered_s"] is None) == (status == "outside")
    assert (said["finished_s"] is None) == (status != "left")
    has_figures = any(each["place"] == "train E" for each in results.key_figures)
    assert has_figures == (status != "outside")


# --- warm-up


def test_the_warm_up_is_in_the_table_and_the_ledgers_but_not_in_the_figures():
    scenario = couple(*MIXED, end_s=300.0)
    clock = scenario.clock.model_copy(update={"warm_up": 100.0})
    warm, _, _ = run_in_memory(scenario.model_copy(update={"clock": clock}))
    whole, _, _ = run_in_memory(scenario)
    pd.testing.assert_frame_equal(warm.table("trains"), whole.table("trains"))
    assert warm.run["ledgers"] == whole.run["ledgers"]
    rows = whole.table("trains")
    late = rows[rows["time_s"] >= 100.0]
    for name in ("E1", "E2", "M2"):
        mine, place = late[late["train"] == name], f"train {name}"
        assert warm.key_figure("energy_taken_kwh", place) == pytest.approx(kwh(mine["power_kw"].clip(lower=0.0)), rel=1e-5)
        assert warm.key_figure("lowest_pantograph_voltage_v", place) == pytest.approx(mine["voltage_v"].min(), rel=1e-6)
        ten = mine["voltage_v"].rolling(10).mean().min()
        assert warm.key_figure("lowest_10_s_mean_voltage_v", place) == pytest.approx(ten, rel=1e-6)
    count = warm.table("profile").query("where == 'pantograph'")["count"].sum()
    assert count == len(late)


def test_a_train_that_left_during_the_warm_up_has_no_figures():
    scenario = couple(run("E", high=2.0), run("F"), end_s=400.0)
    clock = scenario.clock.model_copy(update={"warm_up": 300.0})
    results, _, _ = run_in_memory(scenario.model_copy(update={"clock": clock}))
    places = {each["place"] for each in results.key_figures}
    assert "train F" in places
    assert "train E" not in places
    assert set(results.table("trains")["train"]) == {"E", "F"}


def test_sums_come_to_the_same_in_any_pieces(busy):
    """Rows in uneven pieces give the figures of one piece, bit by bit."""
    bounds = [0, 1, 2, 16, 333, 334, 700, 1000]
    assert sum(b - a for a, b in pairwise(bounds)) == 1000
    found = pieces_of(busy.scenario, bounds)
    assert found == pieces_of(busy.scenario, [0, 1000])


def pieces_of(scenario, bounds):
    from tractionpower.cosimulation.run import Run  # noqa: PLC0415
    from tractionpower.kernels.block import advance  # noqa: PLC0415
    from tractionpower.kernels.block_tables import new_buffers  # noqa: PLC0415
    from tractionpower.results.store import MemoryWriter  # noqa: PLC0415

    made = Run(scenario, MemoryWriter())
    for first, end in pairwise(bounds):
        buffers = new_buffers(made.compiled.block, end - first)
        advance(made.compiled.block, made.state, buffers, end)
        made.recorder.add(first, end - first, buffers, made.compiled.supply)
    made.recorder.close()
    return made.recorder.key_figures(), made.recorder.summary()

"""Runs off the beaten track: dead lines, no room, one step, no step, all blocked, too much asked."""

import numpy as np
import pandas as pd
import pytest
from coupled import MIXED, advanced, couple, run, vehicle
from small_studies import run_in_memory
from small_trains import BRAKE, INVERTER

import tractionpower.cosimulation.run as run_module
from tractionpower.cosimulation.check import check_scenario

PLANT = {"no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12}
AT_B = [PLANT | {"id": "B", "km": 20.0}]


def cut(track, km):
    return {"id": f"X{track}", "track": track, "km": km, "state": "open"}


def tables_of(scenario):
    results, _, _ = run_in_memory(scenario)
    table = results.table("trains").astype({"train": str, "track": str, "phase": str, "limited_by": str})
    return results, table


def with_clock(scenario, **more):
    return scenario.model_copy(update={"clock": scenario.clock.model_copy(update=more)})


def close(results):
    return all(ledger["closes"] for ledger in results.run["ledgers"].values())


# --- where the line is dead


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_trains_on_a_network_without_a_source_stand_still(kind):
    out = [PLANT | {"id": name, "km": km, "state": "rectifiers_out"} for name, km in (("A", 0.0), ("B", 20.0))]
    scenario = couple(run("E", kind), run("F", kind, track="2"), substations=out, end_s=200.0)
    assert {(problem.code, problem.severity) for problem in check_scenario(scenario)} == {("no_source", "warning")}
    results, rows = tables_of(scenario)
    assert results.run["status"] == "complete"
    assert [each["status"] for each in results.run["trains"]] == ["stuck", "stuck"]
    np.testing.assert_array_equal(rows[["voltage_v", "current_a", "speed_kmh", "tractive_force_kn"]], 0.0)
    lost = results.table("events").query("kind == 'voltage_lost'")
    assert list(lost["subject"]) == ["E", "F"]
    assert results.run["verdicts"] == []  # nowhere is there a voltage to judge
    assert any("without voltage for up to 200 s: trains E, F" in note for note in results.run["notes"])
    assert close(results)


def test_a_train_enters_a_dead_stretch_and_is_stuck_while_another_runs():
    scenario = couple(
        run("E"), run("F", track="2"), section_points=[cut("1", 5.0)], substations=AT_B, section_cabins=[], end_s=200.0
    )
    assert [problem.code for problem in check_scenario(scenario)] == ["dead_stretch"]
    results, rows = tables_of(scenario)
    dead = rows[rows["train"] == "E"]
    assert (dead["voltage_v"] < 1.0).all()
    np.testing.assert_allclose(dead[["current_a", "power_kw", "distance_m"]], 0.0, atol=1e-3)
    assert set(dead["limited_by"]) == {"voltage"}
    assert rows[rows["train"] == "F"]["distance_m"].max() > 2000.0
    assert [each["status"] for each in results.run["trains"]] == ["stuck", "on_line"]
    assert close(results)


def test_a_train_coasts_through_a_dead_stretch():
    points = [cut("1", 14.0), cut("1", 12.0) | {"id": "Y"}]
    plants = [PLANT | {"id": name, "km": km} for name, km in (("A", 0.0), ("B", 20.0))]
    scenario = couple(
        run("E", low=20.0, high=0.0, speed_kmh=110.0), section_points=points, substations=plants, section_cabins=[], end_s=900.0
    )
    results, rows = tables_of(scenario)
    inside = rows[(rows["position_km"] < 13.999) & (rows["position_km"] > 12.05)]
    outside = rows[(rows["position_km"] > 14.01) | (rows["position_km"] < 11.9)]
    assert len(inside) > 50
    assert (np.diff(inside["speed_kmh"]) < 0.0).all()
    assert (inside["tractive_force_kn"] == 0.0).all()
    assert outside["voltage_v"].min() > 2500.0
    (low,) = results.table("events").query("kind == 'voltage_lost'").to_dict("records")
    assert "stopped_without_voltage" not in set(results.table("events")["kind"])
    assert low["position_km"] == pytest.approx(14.0, abs=0.05)
    assert results.run["trains"][0]["status"] == "left"
    assert close(results)


# --- nobody takes what is fed back


@pytest.mark.parametrize("rheostat_kw", [0.0, 600.0, 5000.0])
def test_when_all_rectifiers_block_others_brake(rheostat_kw):
    weak = vehicle("inverter", brake=BRAKE | {"rheostat_kw": rheostat_kw}, auxiliaries={"power_kw": 60.0})
    brakes = run("E", speed_kmh=110.0, low=5.0, high=6.0, calls=[{"station": "P"}])
    results, rows = tables_of(couple(brakes, vehicles=[weak], end_s=150.0))
    slows = rows[(rows["phase"] == "braking") & (rows["speed_kmh"] > 20.0)]
    assert len(slows) > 20
    np.testing.assert_allclose(slows["voltage_v"], 3900.0, atol=0.5)  # the top of the fold-back
    assert results.table("substations").groupby("time_s")["blocked"].all()[slows["time_s"]].all()
    assert results.table("events").query("kind == 'substation_blocked'")["subject"].tolist() == ["A", "B"]
    assert (slows["refused_regeneration_kw"] > 100.0).all()
    heat = slows["braking_resistor_kw"]
    np.testing.assert_allclose(heat, np.minimum(slows["refused_regeneration_kw"], rheostat_kw), rtol=1e-5, atol=1e-3)
    if rheostat_kw == 0.0:
        assert (slows["friction_brake_force_kn"] > 50.0).all()
    assert close(results)


def test_who_takes_what_is_refused_does_not_change_the_motion():
    moves = []
    for rheostat_kw in (0.0, 5000.0):
        each = vehicle("inverter", brake=BRAKE | {"rheostat_kw": rheostat_kw})
        brakes = run("E", speed_kmh=110.0, low=5.0, high=6.0, calls=[{"station": "P"}])
        moves.append(advanced(couple(brakes, vehicles=[each], end_s=150.0)).rows("E"))
    for name in ("s_m", "v_mps", "voltage_v", "current_a"):
        np.testing.assert_array_equal(moves[0][name], moves[1][name])
    assert (moves[0]["friction_brake_n"] > moves[1]["friction_brake_n"]).any()


def test_a_train_that_pulls_takes_what_one_that_brakes_gives():
    pulls = run("F", track="2", low=5.0, high=20.0)
    brakes = run("E", speed_kmh=110.0, low=5.0, high=6.0, calls=[{"station": "P"}])
    alone, _ = tables_of(couple(brakes, end_s=60.0))
    both, _ = tables_of(couple(brakes, pulls, end_s=60.0))
    for name, sign in (("energy_returned_kwh", 1.0), ("refused_energy_kwh", -1.0)):
        assert sign * (both.key_figure(name, "train E") - alone.key_figure(name, "train E")) > 1.0


# --- one place, one step, no room


def test_trains_at_the_same_place_share_alike():
    results, rows = tables_of(couple(run("E"), run("F"), run("G"), end_s=300.0))
    one, two, three = (rows[rows["train"] == name].drop(columns="train").reset_index(drop=True) for name in "EFG")
    pd.testing.assert_frame_equal(one, two, rtol=1e-6)
    pd.testing.assert_frame_equal(one, three, rtol=1e-6)
    assert results.run["overlaps"]["count"] == 3
    assert close(results)


def test_three_trains_at_one_place_are_as_one_three_times_as_strong():
    plain = {"drive": INVERTER | {"max_current_a": 900.0}}
    heavy = vehicle("heavy", mass_t=540.0, **plain) | {
        "drive": INVERTER | {"max_current_a": 2700.0, "starting_effort_kn": 600.0, "power_kw": 9000.0},
        "brake": BRAKE | {"electric_effort_kn": 300.0, "electric_power_kw": 6000.0},
        "resistance": {"a_n": 7500.0, "b_n_per_kmh": 60.0, "c_n_per_kmh2": 1.8},
        "auxiliaries": {"power_kw": 180.0, "heating_kw": 120.0},
    }
    vehicles = [vehicle("inverter", **plain), heavy]
    three = advanced(couple(run("E"), run("F"), run("G"), vehicles=vehicles, end_s=400.0)).rows("E")
    one = advanced(couple(run("H", "heavy"), vehicles=vehicles, end_s=400.0)).rows("H")
    for name, share in (("s_m", 1.0), ("v_mps", 1.0), ("voltage_v", 1.0), ("current_a", 3.0), ("wheel_w", 3.0)):
        np.testing.assert_allclose(share * three[name], one[name], rtol=1e-6, atol=1e-4, err_msg=name)


@pytest.mark.parametrize("others", [(), (run("F"),)])
def test_a_train_enters_and_leaves_within_one_step(others):
    brief = run("E", low=5.0, high=5.01, speed_kmh=100.0, time=10.2)
    results, rows = tables_of(couple(brief, *others, end_s=50.0))
    (row,) = rows[rows["train"] == "E"].to_dict("records")
    assert (row["time_s"], row["distance_m"]) == (10.0, 0.0)
    (said,) = [each for each in results.run["trains"] if each["train"] == "E"]
    assert said["status"] == "left"
    assert said["finished_s"] == pytest.approx(10.2 + 0.36, abs=0.01)
    assert results.key_figure("length_km", "train E") == pytest.approx(0.01)
    assert results.table("events").query("subject == 'E'")["kind"].tolist() == ["train_entered", "train_left"]
    assert close(results)


def test_more_trains_than_fit_the_buffers(monkeypatch):
    scenario = couple(*MIXED, end_s=500.0)
    whole, _, _ = run_in_memory(scenario)
    monkeypatch.setattr(run_module, "BUFFER_BYTES", 1)  # room for one step of trains, and for sixteen without
    tight, _, made = run_in_memory(scenario)
    assert made._new_buffers().trains.shape == (5,)
    for name in whole.tables:
        pd.testing.assert_frame_equal(tight.table(name), whole.table(name), check_exact=True)
    assert tight.key_figures == whole.key_figures
    assert tight.run["ledgers"] == whole.run["ledgers"]


# --- the clock


def test_an_hour_without_a_train():
    results, rows = tables_of(couple(run("E", high=2.0), run("F", time=4000.0, high=2.0), end_s=4200.0))
    assert rows["time_s"].between(200.0, 3999.0).sum() == 0
    quiet = results.table("substations").query("time_s > 200 and time_s < 3999")
    assert len(quiet) == 2 * 3798
    np.testing.assert_allclose(quiet["voltage_v"], 3500.0, atol=1e-3)
    np.testing.assert_allclose(quiet["current_a"], 0.0, atol=1e-3)
    first, second = (rows[rows["train"] == name].reset_index(drop=True) for name in "EF")
    np.testing.assert_allclose(second["distance_m"], first["distance_m"], atol=1e-6)
    np.testing.assert_allclose(second["voltage_v"], first["voltage_v"], rtol=1e-6)
    assert close(results)


def test_no_train_at_all_within_the_clock():
    results, _, _ = run_in_memory(couple(run("E", time=100.0), end_s=60.0))
    assert "trains" not in results.tables
    assert results.run["trains"][0]["status"] == "outside"
    assert results.run["status"] == "complete"
    assert results.table("profile").query("where == 'pantograph'").empty


def test_the_clock_goes_on_beyond_midnight():
    plain = couple(run("E", calls=[{"station": "P", "departure": 300.0}]), end_s=400.0)
    shifted = couple(run("E", time=86300.0, calls=[{"station": "P", "departure": 86600.0}]), end_s=86700.0)
    early, late = tables_of(plain), tables_of(with_clock(shifted, start=86300.0))
    columns = ["distance_m", "speed_kmh", "voltage_v", "current_a"]
    np.testing.assert_array_equal(late[1]["time_s"], early[1]["time_s"] + 86300.0)
    np.testing.assert_allclose(late[1][columns], early[1][columns], rtol=1e-5, atol=1e-4)
    calls = [each[0].table("calls")["actual_s"].to_numpy() for each in (early, late)]
    np.testing.assert_allclose(calls[1], calls[0] + 86300.0, atol=1e-6)
    (stop,) = late[0].table("events").query("kind == 'stop'").to_dict("records")
    assert stop["time_s"] > 86400.0
    low = next(each for each in late[0].key_figures if each["name"] == "lowest_pantograph_voltage_v")
    assert low["time"].startswith(("23:", "24:"))


@pytest.mark.parametrize("step_s", [0.02, 0.1, 5.0])
def test_the_shortest_and_the_longest_step(step_s):
    end_s = 60.0 if step_s == 0.02 else 900.0
    results, rows = tables_of(
        couple(run("E", calls=[{"station": "P"}]), run("F", "series_motors", track="2"), step_s=step_s, end_s=end_s)
    )
    assert results.run["status"] == "complete"
    steps = rows[rows["train"] == "E"]["time_s"].diff().dropna()
    np.testing.assert_allclose(steps, step_s, rtol=1e-6)
    energy = rows[rows["train"] == "E"]["power_kw"].clip(lower=0.0).sum() * step_s / 3600.0
    assert results.key_figure("energy_taken_kwh", "train E") == pytest.approx(energy, rel=1e-5)


# --- what is written


def test_rows_are_written_every_so_often_and_every_step_counts():
    whole, all_rows = tables_of(couple(*MIXED, end_s=300.0))
    sparse, some_rows = tables_of(couple(*MIXED, end_s=300.0, output={"every_s": 7.0}))
    expected = all_rows[all_rows["time_s"] % 7.0 == 0.0].reset_index(drop=True)
    pd.testing.assert_frame_equal(some_rows, expected)
    assert sparse.key_figures == whole.key_figures
    assert sparse.run["ledgers"] == whole.run["ledgers"]
    for name in ("calls", "events", "profile"):
        pd.testing.assert_frame_equal(sparse.table(name), whole.table(name))


@pytest.mark.parametrize("wanted", [["trains"], ["calls", "profile"], []])
def test_only_the_wanted_tables_are_written(wanted):
    results, _, _ = run_in_memory(couple(*MIXED, end_s=300.0, output={"tables": wanted}))
    whole, _, _ = run_in_memory(couple(*MIXED, end_s=300.0))
    assert sorted(results.tables) == sorted(wanted)
    assert results.key_figures == whole.key_figures


# --- plain trains


def test_a_train_without_auxiliaries_takes_nothing_at_a_stop():
    bare = vehicle("inverter", auxiliaries={})
    results, rows = tables_of(couple(run("E", calls=[{"station": "P", "min_dwell_s": 60.0}]), vehicles=[bare], end_s=400.0))
    stands = rows[rows["phase"] == "dwelling"]
    assert len(stands) >= 58
    np.testing.assert_array_equal(stands["current_a"].iloc[1:-1], 0.0)
    assert results.key_figure("auxiliary_energy_kwh", "train E") == 0.0
    assert close(results)


def test_a_train_that_stays_goes_on_taking_its_auxiliaries():
    calls = [{"station": "P"}]
    results, rows = tables_of(couple(run("E", high=6.0, calls=calls, end="stay"), run("F", time=500.0, track="2"), end_s=800.0))
    mine = rows[rows["train"] == "E"]
    assert len(mine) == 800
    stays = mine[mine["time_s"] > 350.0]
    expected = 60.0 + 40.0 * (stays["voltage_v"] / 3000.0) ** 2
    np.testing.assert_allclose(stays["power_kw"], expected, rtol=1e-5)
    np.testing.assert_allclose(stays["position_km"], 6.0, atol=1e-6)
    assert stays["voltage_v"].min() < 3450.0  # it feels the other train
    assert results.run["trains"][0]["status"] == "stays"


def test_falling_kilometres_and_two_legs():
    """A train that changes the track draws its current from the other one from then on."""
    switch = [{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 8.0}}]
    route = [{"track": "2", "from_km": 14.0, "to_km": 8.0}, {"track": "1", "from_km": 8.0, "to_km": 3.0}]
    points = [{"id": "P", "track": "1", "km": 8.0}]  # without it the contact lines of both tracks were tied there
    scenario = couple(run("E", route=route), connections=switch, section_cabins=[], section_points=points, end_s=700.0)
    results, rows = tables_of(scenario)
    assert (np.diff(rows["position_km"]) <= 0.0).all()
    np.testing.assert_allclose(rows["position_km"], 14.0 - rows["distance_m"] / 1000.0, atol=1e-6)
    np.testing.assert_array_equal(rows["track"], np.where(rows["position_km"] > 8.0, "2", "1"))
    feeders = results.table("feeders").astype({"track": str}).groupby(["time_s", "track"])["current_a"].sum().unstack()
    mine = rows.set_index("time_s")
    for track in "12":
        here = mine[mine["track"] == track]
        assert len(here) > 50
        np.testing.assert_allclose(feeders.loc[here.index, track], here["current_a"], rtol=1e-3, atol=0.05)
    assert close(results)


# --- where trains may not pull


def out(begin, end):
    """Return events that take both substations out of service for a time."""
    return [
        {"time": time, "device": name, "state": state}
        for name in "AB"
        for time, state in ((begin, "rectifiers_out"), (end, "in_service"))
    ]


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
def test_a_train_loses_its_voltage_and_gets_it_back(kind):
    braked = vehicle(kind, kind, brake={"service_rate_mps2": 0.5})
    calls = [{"station": "Q"}, {"station": "B"}]
    results, rows = tables_of(
        couple(
            run("E", kind, low=2.0, calls=calls),
            vehicles=[braked],
            switch_events=out(200.0, 400.0),
            coast_without_voltage_s=60.0,
            end_s=1400.0,
        )
    )
    dark = rows[(rows["time_s"] >= 200.0) & (rows["time_s"] < 400.0)]
    for name in ("voltage_v", "current_a", "power_kw", "auxiliary_power_kw", "tractive_force_kn"):
        np.testing.assert_array_equal(dark[name], 0.0)
    braking = dark[dark["phase"] == "braking"]
    assert braking["time_s"].iloc[0] == 260.0
    stands = dark[dark["speed_kmh"] == 0.0]
    assert len(stands) > 50
    assert set(stands["phase"]) == {"unpowered"}
    assert set(stands["limited_by"]) == {"voltage"}
    after = rows[rows["time_s"] >= 400.0]
    assert after["speed_kmh"].iloc[10] > 5.0
    assert after["voltage_v"].min() > 2000.0
    told = results.table("events").query("subject == 'E'")
    (lost,) = told.query("kind == 'voltage_lost'").to_dict("records")
    (back,) = told.query("kind == 'voltage_back'").to_dict("records")
    assert (lost["time_s"], back["time_s"], back["value"]) == (200.0, 400.0, 200.0)
    (stopped,) = told.query("kind == 'stopped_without_voltage'").to_dict("records")
    first = stands.iloc[0]
    assert (stopped["time_s"], stopped["value"]) == (first["time_s"], first["time_s"] - 200.0)
    assert stopped["position_km"] == pytest.approx(first["position_km"])
    assert f"stand on track 1, km {first['position_km']:.2f}" in stopped["message"]
    assert (lost["track"], lost["position_km"]) == ("1", pytest.approx(dark["position_km"].iloc[0]))
    assert told.query("kind == 'stop'")["message"].tolist() == ["stops at Q", "stops at B"]  # the forced stand is no call
    assert close(results)
    assert results.run["status"] == "complete"


def test_a_run_with_lost_voltage_and_stretches_without_power_may_be_cut_anywhere(monkeypatch):
    power_off = [{"from_km": 3.0, "to_km": 3.05, "kind": "neutral"}, {"from_km": 8.0, "to_km": 9.0, "kind": "coast"}]
    scenario = couple(*MIXED, power_off=power_off, switch_events=out(150.3, 240.0), coast_without_voltage_s=33.3, end_s=500.0)
    whole, _, _ = run_in_memory(scenario)
    assert whole.table("events")["kind"].isin(["voltage_lost"]).sum() >= 4
    assert whole.table("events")["kind"].isin(["stopped_without_voltage"]).any()
    monkeypatch.setattr(run_module, "BUFFER_BYTES", 1)
    monkeypatch.setattr(run_module, "FIRST_BLOCK", 1)
    pieces, _, _ = run_in_memory(scenario)
    for name in whole.tables:
        pd.testing.assert_frame_equal(pieces.table(name), whole.table(name), check_exact=True)
    assert pieces.key_figures == whole.key_figures


def test_the_table_says_where_the_power_is_off():
    power_off = [{"from_km": 3.0, "to_km": 3.4, "kind": "neutral"}, {"from_km": 5.0, "to_km": 5.03, "kind": "coast"}]
    results, rows = tables_of(couple(run("E"), power_off=power_off, end_s=400.0))
    inside = rows[(rows["position_km"] >= 3.0) & (rows["position_km"] + rows["speed_kmh"] / 3600.0 < 3.4)]
    assert len(inside) > 5
    np.testing.assert_allclose(inside["power_kw"], 0.0, atol=1e-6)
    assert inside["voltage_v"].min() > 3400.0  # of the line
    said = rows[rows["limited_by"] == "power_off"]["position_km"]
    assert said.between(2.96, 3.4).sum() >= len(inside)
    assert said.between(4.96, 5.03).sum() >= 1  # shorter than the way of a step
    np.testing.assert_allclose(rows["voltage_v"] * rows["current_a"] / 1e3, rows["power_kw"], rtol=1e-5, atol=1e-3)
    assert close(results)


def test_a_cut_at_standstill_is_told():
    limit = {"from_km": 0.0, "to_km": 20.0, "max_current_a": 900.0, "standstill_current_a": 20.0}
    calls = [{"station": "P", "min_dwell_s": 60.0}]
    results, rows = tables_of(couple(run("E", calls=calls), train_current_limits=[limit], end_s=450.0))
    stands = rows[rows["phase"] == "dwelling"].iloc[1:-1]
    np.testing.assert_allclose(stands["current_a"], 20.0, rtol=1e-5)
    assert set(stands["limited_by"]) == {"standstill_current"}
    messages = results.table("events").query("kind == 'current_limited'")["message"].tolist()
    assert any("auxiliaries limited by standstill current" in message for message in messages)
    assert any("tractive effort limited by line current" in message for message in messages)

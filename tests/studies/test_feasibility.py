"""Is the timetable feasible: lost seconds beside closed forms, causes one by one, tables beside each other."""

import json
import math

import numpy as np
import pandas as pd
import pytest
from coupled import couple, vehicle
from coupled import run as coupled_run
from small_trains import call, make_run, make_trains, passing

import tractionpower as tp
from tractionpower.errors import InputError, UsageError
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter
from tractionpower.studies.feasibility import Judgement, feasibility, judge, lateness

PARTS = ("knock_on", "timetable", "current_limit", "voltage", "dwell", "driving")
ORIGINS = tuple(f"origin_{name}" for name in PARTS[1:])

AMPS, MASS, V0, LENGTH_M, ETA = 1000.0, 200e3, 30.0, 6000.0, 0.85
LIMITED = {"kind": "inverter", "starting_effort_kn": 500.0, "power_kw": 30000.0, "efficiency": ETA, "max_current_a": AMPS}


def stiff(volts: float, **more) -> Scenario:
    """Return one train of constant current on a line of constant voltage, without resistance, from 30 m/s over 6 km."""
    calls = more.pop("calls", [passing("Z", arrival=more.pop("arrival", 1000.0))])
    fast = {"speed_kmh": V0 * 3.6, "max_speed_kmh": 590.0, "drive": LIMITED, "stations": {"Y": 3.0, "Z": LENGTH_M / 1e3}}
    scenario = make_trains(LENGTH_M / 1e3, calls=calls, **fast | {"clock": {"end": 600.0}} | more)
    whole = {"from_km": -1.0, "to_km": LENGTH_M / 1e3 + 1.0, "resistance_ohm_per_km": 1e-5}
    supply = {
        "substations": [{"id": "S", "km": 0.0, "no_load_voltage_v": volts, "internal_resistance_ohm": 1e-5}],
        "contact_lines": [whole],
        "return_circuit": [whole],
    }
    return Scenario.model_validate(scenario.model_dump() | {"supply": supply})


def time_at(power_w: float, way_m: float = LENGTH_M) -> float:
    """Return the time over a way at constant power from `V0`: M (v1^2 - v0^2) / 2 P, where v1^3 = v0^3 + 3 P s / M [s]."""
    v1 = (V0**3 + 3.0 * power_w * way_m / MASS) ** (1.0 / 3.0)
    return MASS * (v1**2 - V0**2) / (2.0 * power_w)


def delays_of(judged: Judgement, train: str = "x") -> dict[tuple[str, str], dict[str, float]]:
    """Return the parts above 1 ms by station and kind."""
    return {
        (row.station, row.kind): {name: value for name in PARTS if (value := getattr(row, f"{name}_s")) > 1e-3}
        for row in judged.delays
        if row.train == train
    }


# --- closed forms


@pytest.mark.parametrize("volts", [2750.0, 2900.0])
def test_seconds_lost_on_a_constant_voltage(volts):
    judged = judge(stiff(volts))
    (section,), (train,) = judged.sections, judged.trains
    nominal, low = time_at(ETA * 3000.0 * AMPS), time_at(ETA * volts * AMPS)
    assert section.shortest_s == section.limited_s == pytest.approx(nominal, abs=0.01)
    assert section.recorded_s == pytest.approx(low, abs=0.01)
    assert section.lost_voltage_s == pytest.approx(low - nominal, abs=0.01)
    assert train.running_time_ratio == pytest.approx(low / nominal, abs=1e-4)
    assert train.lost_voltage_s == pytest.approx(low - nominal, abs=0.01)
    assert section.lowest_voltage_v == pytest.approx(volts, abs=0.2)
    at = [time_at(ETA * volts * AMPS, x) - time_at(ETA * 3000.0 * AMPS, x) for x in (0.0, 1e3, 2e3, 3e3, 4e3, 5e3, 6e3)]
    assert [row.km for row in judged.lost] == [0.5, 1.5, 2.5, 3.5, 4.5, 5.5]
    np.testing.assert_allclose([row.lost_s for row in judged.lost], np.diff(at), atol=0.01)


def test_a_plan_without_reserve_is_late_by_the_seconds_lost():
    nominal, low = time_at(ETA * 3000.0 * AMPS), time_at(ETA * 2750.0 * AMPS)
    judged = judge(stiff(2750.0, arrival=round(nominal - 5.0, 6)))
    (row,), (train,) = judged.delays, judged.trains
    assert row.delay_s == pytest.approx(low - nominal + 5.0, abs=0.02)
    assert delays_of(judged)["Z", "pass"] == pytest.approx({"timetable": 5.0, "voltage": low - nominal}, abs=0.02)
    assert (judged.verdict, train.verdict, row.cause, train.cause) == ("infeasible", "infeasible", "timetable", "timetable")
    assert train.reserve_left_s == judged.reserve_left_s == pytest.approx(nominal - 5.0 - low, abs=0.02)
    assert train.why.startswith(f"late {row.delay_s:.0f} s at Z: 5 s to a timetable that gives too little time, ")
    assert train.why.endswith("s lost to low voltage between km 0 and 6 (area S)")


def test_higher_than_nominal_voltage_is_reserve():
    nominal, high = time_at(ETA * 3000.0 * AMPS), time_at(ETA * 3500.0 * AMPS)
    judged = judge(stiff(3500.0, arrival=round(nominal, 6)))
    (train,) = judged.trains
    assert train.verdict == "feasible"
    assert train.lost_voltage_s == pytest.approx(high - nominal, abs=0.02)
    assert train.reserve_left_s == pytest.approx(nominal - high, abs=0.02)
    assert judged.outcome.run["feasibility"]["lost_by_area"] == []


@pytest.mark.parametrize("by", ["line", "run"])
def test_seconds_lost_to_current_limits(by):
    limit = {"max_current_a": 800.0}
    more = limit if by == "run" else {"train_current_limits": [{"from_km": -1.0, "to_km": 7.0} | limit]}
    nominal, limited, low = (time_at(ETA * watts) for watts in (3000.0 * AMPS, 3000.0 * 800.0, 2750.0 * 800.0))
    judged = judge(stiff(2750.0, arrival=round(nominal, 6), **more))
    (section,) = judged.sections
    assert section.lost_current_s == pytest.approx(limited - nominal, abs=0.02)
    expected = {"current_limit": limited - nominal, "voltage": low - limited}
    assert delays_of(judged)["Z", "pass"] == pytest.approx(expected, abs=0.02)


# --- causes one by one

TIMED = [passing("Y", arrival=500.0), passing("Z", arrival=1000.0)]


def stopping(calls, **more):
    return stiff(3000.0, calls=calls, speed_kmh=0.0, **more)


def leg_s(**more) -> tuple[float, float]:
    """Return running times start-Y and Y-Z of a train that stops at both."""
    judged = judge(stopping([call("Y", arrival=500.0, min_dwell_s=0.0), call("Z", arrival=550.0)], **more))
    return tuple(section.shortest_s for section in judged.sections)


def test_a_dwell_that_is_planned_too_short():
    first, second = leg_s()
    arrival, spare = float(math.ceil(first)), 8.0 + math.ceil(second) - second
    calls = [call("Y", arrival=arrival, departure=arrival + 10.0, min_dwell_s=30.0)]
    calls += [call("Z", arrival=arrival + 10.0 + 8.0 + math.ceil(second))]
    judged = judge(stopping(calls))
    found = delays_of(judged)
    early = arrival - first
    assert found["Y", "arrival"] == {}
    assert found["Y", "departure"] == pytest.approx({"dwell": 20.0 - early}, abs=0.01)
    assert found["Z", "arrival"] == pytest.approx({"knock_on": 20.0 - early - spare}, abs=0.01)
    last = judged.delays[-1]
    assert (last.cause, last.origin_dwell_s) == ("knock_on", pytest.approx(last.delay_s, abs=0.01))
    assert judged.trains[0].cause == "dwell"
    assert "s at stops" in judged.trains[0].why


def test_a_stop_that_the_timetable_has_no_time_for_takes_its_shortest_dwell():
    first, second = leg_s()
    whole = first + 25.0 + second
    judged = judge(stopping([call("Y", min_dwell_s=25.0), call("Z", arrival=round(whole - 3.0, 6))]))
    assert delays_of(judged) == {("Z", "arrival"): pytest.approx({"timetable": 3.0}, abs=0.01)}
    (section,) = judged.sections
    assert section.planned_s == pytest.approx(first + second - 3.0, abs=0.01)
    assert (section.from_station, section.from_km, section.to_km) == ("", 0.0, 6.0)


def test_driving_that_is_not_flat_out_is_absorbed_first():
    slow = {"kind": "rules", "speed_kmh": 100.0, "late_after_s": 1e6}
    free, planned = (judge(stopping([call("Z", arrival=900.0)], **more)).sections[0] for more in ({}, {"driving": slow}))
    assert planned.recorded_s == pytest.approx(free.recorded_s, abs=0.3)  # flat out on the voltages of the slower run
    lost = planned.actual_s - planned.recorded_s
    assert lost > 20.0
    late = judge(stopping([call("Z", arrival=round(planned.actual_s - 7.0, 6))], driving=slow))
    assert delays_of(late)["Z", "arrival"] == pytest.approx({"driving": 7.0}, abs=0.3)
    assert late.trains[0].cause == "driving"


# --- trains that are not there, and times that do not count


def test_a_train_that_is_stuck_is_not_finished():
    calls = [call("Y", arrival=400.0), call("Z", arrival=450.0)]
    judged = judge(stiff(1950.0, calls=calls, speed_kmh=0.0))  # below U_min2 there is no traction
    (train,) = judged.trains
    assert (judged.verdict, train.verdict) == ("infeasible", "not finished")
    assert train.why.startswith("stuck on track 1 at km 0.0, since effort or power lack: not at Y, planned 00:06:40, 200 s")
    assert [row.cause for row in judged.delays] == ["not_reached"] * 2
    assert all(math.isnan(row.delay_s) for row in judged.delays)
    assert judged.outcome.run["feasibility"]["late_trains"] == 1
    assert judged.outcome.run["feasibility"]["first"]["train"] == "x"
    assert lateness(stiff(1950.0, calls=calls, speed_kmh=0.0)) == {"x": math.inf}


def test_a_train_that_the_clock_cuts_off_is_late_only_where_it_is_due():
    for arrival, verdict in ((900.0, "feasible"), (599.5, "feasible"), (500.0, "not finished")):
        judged = judge(stopping([call("Z", arrival=arrival)], time=550.0 if arrival > 550.0 else 450.0))
        assert judged.trains[0].verdict == verdict
    assert "on track 1 at km" in judged.trains[0].why
    assert lateness(stopping([call("Z", arrival=500.0)], time=450.0)) == {"x": 100.0}
    late = judge(stopping([call("Z", arrival=900.0)], time=550.0)).trains[0]
    assert late.why.endswith("the clock ends before its planned time at Z")
    outside = judge(stopping([call("Z", arrival=900.0)], time=700.0)).trains[0]
    assert outside.verdict == "not judged"


def test_a_train_without_a_timed_call_is_judged_by_its_running_time():
    judged = judge(stiff(2750.0, calls=[passing("Y")]))
    (train,) = judged.trains
    assert (judged.verdict, train.verdict, judged.delays, judged.sections) == ("not judged", "not judged", (), ())
    assert judged.outcome.run["feasibility"]["verdict"] == "not judged"
    assert math.isnan(train.reserve_left_s)
    assert math.isnan(judged.reserve_left_s)
    assert train.shortest_s == pytest.approx(time_at(ETA * 3000.0 * AMPS), abs=0.01)
    assert train.lost_voltage_s == pytest.approx(time_at(ETA * 2750.0 * AMPS) - train.shortest_s, abs=0.02)
    assert train.why.startswith("has no call with a planned time: no verdict on delays; alone at nominal voltage it runs")
    assert [figure["name"] for figure in judged.outcome.key_figures[-2:]] == ["late_trains", "lost_to_low_voltage_s"]


def test_what_lies_in_the_warm_up_or_before_the_clock_does_not_count():
    calls = [passing("Y", arrival=30.0), passing("Z", arrival=1000.0)]
    assert [row.station for row in judge(stiff(2750.0, calls=calls)).delays] == ["Y", "Z"]
    later = judge(stiff(2750.0, calls=calls, clock={"end": 600.0, "warm_up": 80.0}))
    assert [row.station for row in later.delays] == ["Z"]
    assert later.verdict == "feasible"
    before = judge(stiff(2750.0, calls=calls, clock={"start": 85.0, "end": 600.0}))
    assert [row.station for row in before.delays] == ["Z"]
    (section,) = before.sections
    whole = judge(stiff(2750.0, calls=calls)).sections[1]
    assert 0.0 < section.lost_voltage_s < whole.lost_voltage_s + 1e-6  # at nominal voltage until the clock started
    assert section.recorded_s == pytest.approx(section.actual_s, abs=0.05)


def test_a_delay_that_counts_is_told_where_it_arose_even_in_the_warm_up():
    plants = [
        {"id": n, "km": km, "no_load_voltage_v": 3200.0, "internal_resistance_ohm": 1.5} for n, km in (("A", 0.0), ("B", 20.0))
    ]
    calls = [call("A", departure=0.0), call("Q", arrival=430.0)]
    whole = couple(coupled_run("a", high=13.0, calls=calls), end_s=900.0, substations=plants)
    clock = whole.clock.model_copy(update={"warm_up": 200.0})
    judged, later = judge(whole), judge(whole.model_copy(update={"clock": clock}))
    for told in (judged, later):
        (train,) = told.trains
        assert train.why.endswith("8 s lost to low voltage between km 0 and 2 (area A)")
        assert (train.lost_area, told.sections[-1].area) == ("A", "A")
        assert train.lost_voltage_s == pytest.approx(told.delays[-1].voltage_s, abs=0.05)
        assert sum(row.lost_s for row in told.lost) == pytest.approx(train.lost_voltage_s, abs=1e-3)


def test_a_passing_time_with_reserve_before_a_tight_end_is_no_tight_timetable():
    # The end is reached in time at nominal voltage: what is passed early is not lost.
    first, second = (section.shortest_s for section in judge(stiff(3000.0, calls=TIMED)).sections)
    low = time_at(ETA * 2750.0 * AMPS) - first - second
    calls = [passing("Y", arrival=round(first + 20.0, 6)), passing("Z", arrival=round(first + second + 1.0, 6))]
    judged = judge(stiff(2750.0, calls=calls))
    assert judged.trains[0].cause == "voltage"
    assert delays_of(judged) == {("Y", "pass"): {}, ("Z", "pass"): pytest.approx({"voltage": low - 1.0}, abs=0.02)}


# --- whole studies


def busy(*, mirrored: bool = False, weak_ohm: float = 1.2) -> Scenario:
    """Return six trains in both directions on 20 km, of which the far end is fed badly."""
    runs = []
    for n in range(6):
        up = n % 2 == 0
        stations = ["A", "P", "Q", "B"] if up else ["B", "Q", "P", "A"]
        t0 = 40.0 * n
        calls = [
            call(stations[0], departure=t0),
            call(stations[1], arrival=t0 + 260.0, departure=t0 + 290.0, min_dwell_s=20.0),
            passing(stations[2], arrival=t0 + 560.0),
            call(stations[3], arrival=t0 + 840.0),
        ]
        ends = (0.0, 20.0) if up else (20.0, 0.0)
        ends = (20.0 - ends[0], 20.0 - ends[1]) if mirrored else ends
        kind = ("inverter", "series_motors", "table")[n // 2]
        runs.append(coupled_run(f"r{n}", kind, "12"[n % 2], *ends, time=t0, calls=calls))
    places = (("A", 0.0), ("P", 6.0), ("Q", 13.0), ("B", 20.0))
    stations = [{"id": name, "km": 20.0 - km if mirrored else km} for name, km in places]
    plants = [("N", 0.5, 0.2), ("W", 18.5, weak_ohm)]
    substations = [
        {"id": name, "km": 20.0 - km if mirrored else km, "no_load_voltage_v": 3300.0, "internal_resistance_ohm": ohm}
        for name, km, ohm in plants
    ]
    limits = [{"from_km": 2.0, "to_km": 5.0, "max_current_a": 900.0}]
    if mirrored:
        limits = [{"from_km": 15.0, "to_km": 18.0, "max_current_a": 900.0}]
    vehicles = [vehicle(kind, kind) for kind in ("inverter", "series_motors", "table")]
    vehicles[0]["drive"] = vehicles[0]["drive"] | {"max_current_a": 1400.0}
    return couple(*runs, end_s=1500.0, stations=stations, substations=substations, train_current_limits=limits, vehicles=vehicles)


@pytest.fixture(scope="module")
def judged_busy() -> tuple[Judgement, Results]:
    writer, scenario = MemoryWriter(), busy()
    judged = judge(scenario, writer, study="busy")
    return judged, Results(judged.outcome.run, judged.outcome.key_figures, writer.tables(), scenario)


def test_the_tables_agree_with_each_other(judged_busy):
    _, results = judged_busy
    calls, delays, sections, lost = (results.table(name) for name in ("calls", "delays", "sections", "lost_time"))
    assert (delays["cause"] != "").any()
    assert {"voltage", "knock_on"} <= set(delays["cause"])
    key = ["train", "station", "kind"]
    both = delays.merge(calls, on=key, suffixes=("", "_of_calls"))
    assert len(both) == len(delays) == len(calls.dropna(subset=["planned_s"]))
    np.testing.assert_allclose(both["actual_s"], both["actual_s_of_calls"], atol=1e-9)
    np.testing.assert_allclose(delays["delay_s"], np.maximum(delays["actual_s"] - delays["planned_s"], 0.0), atol=1e-3)
    for names in (PARTS, ORIGINS):
        parts = delays[[f"{name}_s" for name in names]]
        assert (parts >= 0.0).all(axis=None)
        np.testing.assert_allclose(parts.sum(axis=1), delays["delay_s"], atol=1e-3)
    np.testing.assert_allclose(sections["reserve_s"], sections["planned_s"] - sections["shortest_s"], atol=1e-3)
    np.testing.assert_allclose(sections["lost_voltage_s"], sections["recorded_s"] - sections["limited_s"], atol=1e-3)
    assert (sections["limited_s"] >= sections["shortest_s"] - 0.05).all()
    by_train = sections.groupby("train", observed=True)["lost_voltage_s"].sum()
    in_bins = lost.groupby("train", observed=True)["lost_s"].sum().reindex(by_train.index, fill_value=0.0)
    np.testing.assert_allclose(in_bins, by_train, atol=0.02)
    by_area = lost[lost["lost_s"] > 0.0].groupby("area", observed=True)["lost_s"].sum()
    told = {row["area"]: row["lost_s"] for row in results.run["feasibility"]["lost_by_area"]}
    assert told == pytest.approx(by_area.to_dict(), rel=1e-5)
    assert (lost["area"] == np.where(lost["km"] < 9.6, "N", "W")).all()


def test_the_verdicts_follow_from_the_tables(judged_busy):
    judged, results = judged_busy
    calls, notes = results.table("calls"), results.run["feasibility"]
    assert json.loads(json.dumps(notes, allow_nan=False)) == notes
    latest = calls.groupby("train", observed=True)["late_s"].max()
    for train in notes["trains"]:
        assert train["verdict"] == ("infeasible" if latest[train["train"]] > 1.0 else "feasible")
        assert train["late_s"] == pytest.approx(latest[train["train"]], abs=1e-3)
    assert notes["verdict"] == "infeasible"
    assert notes["first"]["train"] == latest.idxmax()
    assert notes["late_trains"] == int((latest > 1.0).sum()) == int(results.key_figure("late_trains"))
    assert lateness(results.scenario) == pytest.approx({name: max(s, 0.0) for name, s in latest.items()}, abs=1e-3)
    useful = {figure["place"]: figure["value"] for figure in results.key_figures if "time_mean" in figure["name"]}
    for train in judged.trains:
        assert train.mean_useful_voltage_time_mean_v == useful[f"train {train.train}"]
        assert (train.running_time_ratio > 1.0) == (train.lost_voltage_s > 0.0)
    reserve = min(train.reserve_left_s for train in judged.trains)
    assert results.key_figure("least_reserve_left_s") == judged.reserve_left_s == reserve < 0.0
    assert judge(results.scenario, tolerance_s=10_000.0).verdict == "feasible"


def test_a_train_flat_out_on_its_recorded_voltages_comes_when_it_did(judged_busy):
    judged, _ = judged_busy
    assert max(row.lost_voltage_s for row in judged.sections) > 5.0
    for row in judged.sections:
        assert row.recorded_s == pytest.approx(row.actual_s, abs=0.2)


def test_a_mirrored_line_gives_the_same_parts(judged_busy):
    judged, _ = judged_busy
    mirrored = judge(busy(mirrored=True))
    for mine, other in zip(judged.delays, mirrored.delays, strict=True):
        assert (mine.train, mine.station, mine.kind, mine.cause) == (other.train, other.station, other.kind, other.cause)
        for name in (*PARTS, *ORIGINS):
            assert getattr(mine, f"{name}_s") == pytest.approx(getattr(other, f"{name}_s"), abs=0.01)
    for mine, other in zip(judged.sections, mirrored.sections, strict=True):
        assert mine.area == other.area
        if mine.area:
            assert mine.worst_km == pytest.approx(20.0 - other.worst_km)


def test_a_strong_supply_is_feasible_where_the_weak_one_is_not():
    judged = judge(busy(weak_ohm=0.05))
    lost, weak = (sum(train.lost_voltage_s for train in each.trains) for each in (judged, judge(busy())))
    assert lost < weak


def test_at_a_constant_voltage_of_the_coupling_nothing_is_lost_beyond_it():
    scenario = Scenario.model_validate(busy().model_dump() | {"coupling": "constant_voltage"})
    judged = judge(scenario)
    assert max(abs(row.lost_voltage_s) for row in judged.sections) < 0.05
    assert max(row.voltage_s for row in judged.delays) < 0.1


# --- from Python


def test_results_in_memory_and_in_a_folder(tmp_path):
    scenario = stiff(2750.0, arrival=100.0)
    told = []
    memory = feasibility(scenario)
    disk = tp.feasibility(scenario, tmp_path / "out", progress=lambda done, total: told.append(done))
    assert told[-1] == 600
    assert {"delays", "sections", "lost_time", "trains", "calls"} <= set(memory.tables)
    for name in memory.tables:
        pd.testing.assert_frame_equal(memory.table(name), disk.table(name))
    assert memory.run["feasibility"] == disk.run["feasibility"] == Results.open(tmp_path / "out").run["feasibility"]
    assert memory.run["input_hash"] == judge(scenario).outcome.run["input_hash"] == scenario.input_hash
    assert memory.run["feasibility"]["tolerance_s"] == 1.0


def test_the_tolerance_comes_from_the_study_unless_it_is_given():
    scenario = stiff(2750.0, arrival=round(time_at(ETA * 2750.0 * AMPS) - 3.0, 6))
    assert judge(scenario).verdict == "infeasible"
    assert judge(scenario, tolerance_s=3.5).verdict == "feasible"
    lenient = tp.change(scenario, ["feasibility.tolerance_s=3.5"])
    assert judge(lenient).verdict == "feasible"


def test_a_study_without_trains_or_with_errors_is_refused(tmp_path):
    with pytest.raises(UsageError, match="no trains"):
        judge(couple())
    with pytest.raises(UsageError, match="tolerance"):
        judge(stiff(3000.0), tolerance_s=-1.0)
    wrong = make_trains(6.0, runs=[make_run("x", 60.0)])
    with pytest.raises(InputError):
        feasibility(wrong, tmp_path / "out")
    assert list(tmp_path.iterdir()) == []

"""Delays of random timetables on random supplies: parts add up, are what the run says, and voltages explain running times."""

from typing import Any

import numpy as np
import pytest
from coupled import couple, run, vehicle
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tractionpower.cosimulation.check import check_scenario
from tractionpower.cosimulation.simulate import simulate
from tractionpower.model.scenario import Scenario
from tractionpower.studies.feasibility import judge, lateness
from tractionpower.studies.feasibility.parts import ORIGINS

PLACES = {"A": 0.0, "P": 6.0, "Q": 13.0, "B": 20.0}
SEEDS = st.integers(0, 10_000)
PLANS: tuple[dict[str, Any], ...] = (
    {"kind": "rules", "speed_percent": 75.0},
    {"kind": "rules", "effort_percent": 60.0, "late_after_s": 10.0},
    {"kind": "rules", "coast_before_stops_km": 1.0},
)


def random_timetable(seed: int) -> Scenario:
    """Return up to five trains with stops and passings, planned or not, most of them tightly, on a supply that may be weak."""
    rng = np.random.default_rng((11, seed))
    runs = [_random_run(rng, f"r{n}") for n in range(rng.integers(1, 6))]
    plants = [
        {"id": name, "km": km, "no_load_voltage_v": float(rng.choice([2900.0, 3300.0, 3600.0]))}
        | {"internal_resistance_ohm": float(rng.choice([0.05, 0.3, 1.5]))}
        for name, km in (("S", 1.0), ("T", 17.0))
    ]
    more: dict[str, Any] = {"substations": plants}
    if rng.random() < 0.4:
        more["train_current_limits"] = [{"from_km": 3.0, "to_km": 15.0, "max_current_a": float(rng.uniform(400.0, 1200.0))}]
    vehicles = [vehicle(kind, kind) for kind in ("inverter", "series_motors", "table")]
    vehicles[0]["drive"] = vehicles[0]["drive"] | {"max_current_a": 1300.0}
    start = float(rng.choice([0.0, 0.0, 150.3]))
    scenario = couple(*runs, end_s=1500.0, step_s=float(rng.choice([0.5, 1.0, 2.0])), vehicles=vehicles, **more)
    clock = scenario.clock.model_copy(update={"start": start, "warm_up": float(rng.choice([0.0, 200.0])) or None})
    return scenario.model_copy(update={"clock": clock})


def _random_run(rng: np.random.Generator, name: str) -> dict[str, Any]:
    names = list(PLACES)
    if rng.random() < 0.5:
        names.reverse()
    t0 = round(float(rng.uniform(0.0, 300.0)), 1)
    begins_moving = rng.random() < 0.3
    now, calls = t0, []
    for before, station in zip([None, *names], names, strict=False):
        if before is None:
            if not begins_moving:
                calls.append({"station": station, "departure": t0})
            continue
        now += abs(PLACES[station] - PLACES[before]) * float(rng.uniform(30.0, 55.0))  # 65 to 120 km/h
        arrival = round(now, 1) if rng.random() < 0.7 else None
        if rng.random() < 0.4:
            calls.append({"station": station, "stops": False, "arrival": arrival})
            continue
        dwell = float(rng.choice([0.0, 20.0, 60.0]))
        now += dwell
        departure = round(now, 1) if rng.random() < 0.6 and station != names[-1] else None
        least = float(rng.choice([0.0, 20.0, 35.0]))
        calls.append({"station": station, "arrival": arrival, "departure": departure, "min_dwell_s": least})
    caps = {"max_current_a": float(rng.uniform(500.0, 1000.0))} if rng.random() < 0.2 else {}
    driving = {"driving": dict(rng.choice(np.array(PLANS, object)))} if rng.random() < 0.3 else {}
    kind = str(rng.choice(["inverter", "inverter", "series_motors", "table"]))
    speed = 60.0 if begins_moving else 0.0
    ends = (PLACES[names[0]], PLACES[names[-1]])
    return run(name, kind, str(rng.choice(["1", "2"])), *ends, time=t0, speed_kmh=speed, calls=calls, **caps, **driving)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(SEEDS)
def test_parts_add_up_and_are_what_the_run_says(seed):
    scenario = random_timetable(seed)
    assert [problem for problem in check_scenario(scenario) if problem.severity == "error"] == []
    judged = judge(scenario)
    known = {(row.train, row.station, row.kind): row for row in judged.delays}
    from_s = scenario.clock.start + (scenario.clock.warm_up or 0.0)
    for row in simulate(scenario).table("calls").dropna(subset=["planned_s"]).itertuples():
        if row.actual_s < from_s - 1e-6:
            assert (row.train, row.station, row.kind) not in known
            continue
        delay = known.pop((row.train, row.station, row.kind))
        if np.isnan(row.actual_s):
            assert np.isnan(delay.delay_s)
            continue
        late = max(row.actual_s - row.planned_s, 0.0)
        assert delay.delay_s == pytest.approx(late, abs=1e-6)
        for names in (("knock_on", *ORIGINS), tuple(f"origin_{name}" for name in ORIGINS)):
            parts = [getattr(delay, f"{name}_s") for name in names]
            assert min(parts) >= 0.0
            assert sum(parts) == pytest.approx(late, abs=0.1)
    assert not known


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(SEEDS)
def test_recorded_voltages_explain_running_times(seed):
    scenario = random_timetable(seed)
    judged = judge(scenario)
    plain = {each.id for each in scenario.runs if each.driving is None}
    for row in judged.sections:
        if not np.isfinite(row.actual_s):
            continue
        if row.train in plain:
            stood = row.lowest_voltage_v < 2000.0  # may have stood without traction, and started anywhere in a step
            assert row.recorded_s == pytest.approx(row.actual_s, abs=0.2 + 0.5 * scenario.clock.step_s * stood)
        else:
            assert row.recorded_s <= row.actual_s + 0.5
    for row in judged.delays:
        if row.train in plain and np.isfinite(row.delay_s):
            assert row.driving_s == row.origin_driving_s == 0.0
    late = lateness(scenario)
    for train in judged.trains:
        if train.verdict == "infeasible":
            assert late[train.train] == pytest.approx(train.late_s, abs=1e-6)
        elif train.verdict == "feasible":
            assert late[train.train] <= judged.tolerance_s
        else:
            assert train.verdict in ("not finished", "not judged")
    lost = {train.train: train.lost_voltage_s for train in judged.trains}
    for name, seconds in lost.items():
        assert sum(row.lost_s for row in judged.lost if row.train == name) == pytest.approx(seconds, abs=1e-3)

"""The trains of a scenario with their plans: compiled flat out, planned, and each plan run alone to know when it is where."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import POINT
from tractionpower.model.driving import Driving, Eco, FlatOut, Rules
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.movement.compile import Movement, PlannedRun, compile_trains
from tractionpower.movement.driving.dues import dues_of
from tractionpower.movement.driving.optimal import Planner, PlanRows, Saving, SavingPlan, Voltage
from tractionpower.movement.driving.plan import Plan, lay_plans
from tractionpower.movement.driving.plan_runs import AlonePlan, PlanRuns
from tractionpower.movement.driving.rules import hold_floor, rule_plan
from tractionpower.movement.formation import KMH

log = logging.getLogger(__name__)

Floats = NDArray[np.float64]

PLAN_STEP_S = 1.0
"""Step in which a plan is run alone [s]; that of the clock if it is longer."""

MISSED_S = 0.2
"""A plan that misses a time by more than this is corrected [s]."""

CORRECTIONS = 2
"""So often."""

M_PER_KM = 1000.0


def compile_driven(scenario: Scenario, runs: Sequence[str] | None = None, voltage: Voltage | None = None) -> Movement:
    """Return the trains of a scenario with the plans by which they are driven while they are on time.

    A plan that does not bring its train to its end is given up: the train is driven flat out, and that is logged.

    Parameters
    ----------
    scenario
        The scenario, of which `check_movement` has found no errors.
    runs
        Identifiers of the runs to take; left out: all.
    voltage
        Voltage for which plans are made that name none themselves, by which they come to their calls on time: a number [V], or
        points (distance of the front from the start of the route [m], voltage [V]); left out: the nominal one.
    """
    movement = compile_trains(scenario, runs)
    driving = {k: driving_of(item.run, scenario) for k, item in enumerate(movement.runs)}
    chosen = {k: how for k, how in driving.items() if not isinstance(how, FlatOut)}
    if not chosen:
        return movement
    others: Voltage = movement.voltages.u_n if voltage is None else voltage
    voltages = {k: others if how.voltage_v is None else how.voltage_v for k, how in chosen.items()}
    plan_runs = PlanRuns(movement, max(PLAN_STEP_S, scenario.clock.step_s), voltages)
    rules = {k: how for k, how in chosen.items() if isinstance(how, Rules)}
    saving = {k: how for k, how in chosen.items() if not isinstance(how, Rules)}
    plans = _by_rules(movement, rules, plan_runs) | _saving(movement, saving, voltages, plan_runs)
    for k, alone in plan_runs.run(plans, list(plans)).items():
        item = movement.runs[k]
        if not np.isfinite(alone.finished_s):
            _tell_given_up(item, alone)
            del plans[k]
        elif not isinstance(chosen[k], Eco) and _has_times(item):
            plans[k] = replace(plans[k], dues=dues_of(alone.rows, item.calls, alone.arrived_s, alone.left_s))
    return lay_plans(movement, plans)


def driving_of(run: TrainRun, scenario: Scenario) -> Driving:
    """Return how a run is driven while it is on time."""
    if run.driving is not None:
        return run.driving
    return scenario.timetable.driving if scenario.timetable.driving is not None else FlatOut(kind="flat_out")


def _by_rules(movement: Movement, rules: dict[int, Rules], plan_runs: PlanRuns) -> dict[int, Plan]:
    """Return the plans of trains that are driven by rules."""
    plans = {k: _plan(rule_plan(movement.runs[k], how), how) for k, how in rules.items()}
    floors = {k: how.coast_down_to_kmh / KMH for k, how in rules.items() if how.coast_down_to_kmh > 0.0}
    for k, alone in plan_runs.run(plans, floors).items():
        plans[k] = _plan(hold_floor(plans[k], alone.rows, floors[k]), rules[k])
    return plans


def _saving(movement: Movement, saving: dict[int, Saving], voltages: dict[int, Voltage], plan_runs: PlanRuns) -> dict[int, Plan]:
    """Return the plans of trains that use spare time, corrected by the times that they take when they are run alone."""
    planners: dict[object, Planner] = {}
    for voltage in voltages.values():
        if _hashable(voltage) not in planners:
            planners[_hashable(voltage)] = Planner(movement, voltage)
    own = {k: planners[_hashable(voltages[k])] for k in saving}
    first = {k: own[k].plan(k, how) for k, how in saving.items()}
    best = {k: (np.inf, plan) for k, plan in first.items()}
    late = {k: np.zeros(plan.parts) for k, plan in first.items()}
    tried = dict(first)
    for n in range(CORRECTIONS + 1):
        found = plan_runs.run({k: _plan(plan.rows, saving[k]) for k, plan in tried.items()}, list(tried))
        again = {}
        for k, alone in found.items():
            missed = _missed(first[k], [plan_runs.seconds(k, alone, stretch) for stretch in first[k].stretches], n > 0)
            worst = float(np.abs(missed).max(initial=0.0))
            if worst < best[k][0]:
                best[k] = worst, tried[k]
            if worst > MISSED_S and n < CORRECTIONS:
                late[k] += missed
                again[k] = own[k].plan(k, saving[k], tuple(np.round(late[k], 3).tolist()))
        tried = again
    return {k: _plan(plan.rows, saving[k]) for k, (_, plan) in best.items()}


def _missed(plan: SavingPlan, taken_s: Sequence[float], later: bool) -> Floats:
    """Return by how much the parts of a plan take longer than is expected of them [s].

    What has no time to spare stays late: it is told at the first time only, for the next ones to make up for it.
    """
    missed = np.zeros(plan.parts)
    for stretch, seconds in zip(plan.stretches, taken_s, strict=True):
        if np.isfinite(seconds) and not (later and stretch.is_shortest):
            missed[stretch.part] = seconds - stretch.seconds
    return missed


def _plan(rows: PlanRows, how: Rules | Saving) -> Plan:
    return Plan(*rows, np.zeros(0, POINT), how.late_after_s)


def _hashable(voltage: Voltage) -> object:
    return voltage if isinstance(voltage, int | float) else tuple(map(tuple, voltage))


def _has_times(item: PlannedRun) -> bool:
    return any(planned.call.arrival is not None or planned.call.departure is not None for planned in item.calls)


def _tell_given_up(item: PlannedRun, alone: AlonePlan) -> None:
    at = float(alone.rows["s_m"][-1]) / M_PER_KM
    log.warning("Train %s is driven flat out: by its plan it comes no further than km %.3f of its route.", item.run.id, at)

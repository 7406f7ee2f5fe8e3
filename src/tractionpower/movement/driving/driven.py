"""The trains of a scenario with their plans: compiled flat out, planned, and each plan run alone to know when it is where."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tractionpower.kernels.journey import OUT_OF_ROWS, run_journey
from tractionpower.kernels.train_tables import POINT, TRAIN_ROW, new_train_state
from tractionpower.model.driving import Driving, Eco, FlatOut, Rules
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.movement.compile import Movement, PlannedRun, compile_trains
from tractionpower.movement.driving.dues import Times, dues_of
from tractionpower.movement.driving.optimal import Saving, Voltage, optimal_plans
from tractionpower.movement.driving.plan import Plan, Rows, lay_plans
from tractionpower.movement.driving.rules import hold_floor, rule_plan
from tractionpower.movement.formation import KMH

PLAN_STEP_S = 1.0
"""Step in which a plan is run alone [s]."""

LONGEST_S = 48 * 3600.0

_BLOCK = 4096


def compile_driven(scenario: Scenario, runs: Sequence[str] | None = None, voltage: Voltage | None = None) -> Movement:
    """Return the trains of a scenario with the plans by which they are driven while they are on time.

    Parameters
    ----------
    scenario
        The scenario, of which `check_movement` has found no errors.
    runs
        Identifiers of the runs to take; left out: all.
    voltage
        Voltage for which plans are made, by which they come to their calls on time: a number [V], or points (distance of the
        front from the start of the route [m], voltage [V]); left out: the nominal one.
    """
    movement = compile_trains(scenario, runs)
    driving = {k: driving_of(item.run, scenario) for k, item in enumerate(movement.runs)}
    chosen = {k: how for k, how in driving.items() if not isinstance(how, FlatOut)}
    if not chosen:
        return movement
    volts: Voltage = movement.voltages.u_n if voltage is None else voltage
    rows = _rows(movement, chosen, volts)
    plans = {k: Plan(*rows[k], np.zeros(0, POINT), how.late_after_s) for k, how in chosen.items()}
    floors = {k: how.coast_down_to_kmh / KMH for k, how in chosen.items() if isinstance(how, Rules)}
    floors = {k: floor for k, floor in floors.items() if floor > 0.0}
    for k, alone in _run_alone(lay_plans(movement, plans), floors, volts):
        pieces, caps = hold_floor(plans[k], alone.rows, floors[k])
        plans[k] = replace(plans[k], pieces=pieces, caps=caps)
    timed = [k for k in plans if not isinstance(chosen[k], Eco) and _has_times(movement.runs[k])]
    for k, alone in _run_alone(lay_plans(movement, plans), timed, volts):
        plans[k] = replace(plans[k], dues=dues_of(alone.rows, movement.runs[k].calls, alone.arrived_s, alone.left_s))
    return lay_plans(movement, plans)


def driving_of(run: TrainRun, scenario: Scenario) -> Driving:
    """Return how a run is driven while it is on time."""
    if run.driving is not None:
        return run.driving
    return scenario.timetable.driving if scenario.timetable.driving is not None else FlatOut(kind="flat_out")


def _rows(movement: Movement, chosen: Mapping[int, Rules | Saving], volts: Voltage) -> dict[int, tuple[Rows, Rows]]:
    """Return ceiling and caps of the plans."""
    rules = {k: rule_plan(movement.runs[k], how) for k, how in chosen.items() if isinstance(how, Rules)}
    saving = [(k, how) for k, how in chosen.items() if not isinstance(how, Rules)]
    return rules | (optimal_plans(movement, saving, volts) if saving else {})


def _has_times(item: PlannedRun) -> bool:
    return any(planned.call.arrival is not None or planned.call.departure is not None for planned in item.calls)


@dataclass(frozen=True, slots=True, eq=False)
class _Alone:
    # A plan run alone: its steps, and when it is at its calls.
    rows: Rows
    arrived_s: Times
    left_s: Times


def _run_alone(movement: Movement, chosen: Iterable[int], volts: Voltage) -> Iterator[tuple[int, _Alone]]:
    """Run the trains of some numbers alone by their plans, which have no dues."""
    state = new_train_state(movement.tables)
    voltage = np.array([(0.0, volts)] if isinstance(volts, int | float) else list(volts), POINT)
    for k in chosen:
        item, train = movement.runs[k], movement.tables.trains[k]
        blocks, end, start = [], OUT_OF_ROWS, item.start_s
        while end == OUT_OF_ROWS and start - item.start_s < LONGEST_S:
            rows = np.zeros(_BLOCK, TRAIN_ROW)
            count, end, start = run_journey(movement.tables, state, k, (start, PLAN_STEP_S), voltage, rows)
            blocks.append(rows[:count])
        calls = slice(int(train["first_stop"]), int(train["first_stop"] + train["stops"]))
        yield k, _Alone(np.concatenate(blocks), state.arrived_s[calls].copy(), state.left_s[calls].copy())

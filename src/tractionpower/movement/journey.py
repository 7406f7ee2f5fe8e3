"""Theoretical journeys (PT): trains alone at a given voltage, without the network, in both forms of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.kernels.journey import ARRIVED, OUT_OF_ROWS, STUCK, run_journey
from tractionpower.kernels.speed_form import run_over_speed
from tractionpower.kernels.train_tables import POINT, TrainState, new_train_state
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.movement.blocks_of_rows import blocks_of_rows
from tractionpower.movement.compile import Movement, PlannedRun
from tractionpower.movement.driving.driven import compile_driven
from tractionpower.movement.formation import Formation
from tractionpower.movement.ledgers import TrainLedger, mechanical_ledger, pantograph_ledger

Form = Literal["time", "speed"]
Status = Literal["complete", "stuck", "unfinished"]
Voltage = float | Sequence[tuple[float, float]]
"""A voltage [V], or points (distance of the front from the start of the route [m], voltage [V])."""

_STATUS: dict[int, Status] = {ARRIVED: "complete", STUCK: "stuck", OUT_OF_ROWS: "unfinished"}


@dataclass(frozen=True, slots=True)
class JourneyCall:
    """A call of a journey: planned and computed times after midnight [s]; NaN where the train has not come."""

    station: str
    kind: Literal["stop", "pass"]
    planned_arrival_s: float | None
    planned_departure_s: float | None
    arrival_s: float
    departure_s: float
    at_m: float


@dataclass(frozen=True, eq=False)
class Journey:
    """A theoretical journey.

    Attributes
    ----------
    run, path
        The run and its route.
    rows
        Steps, records of `TRAIN_ROW` in SI.
    calls
        Its calls.
    status
        complete; stuck: it cannot go on; unfinished: it takes longer than two days.
    start_s, finished_s
        Start, and end of the last row with the train on the line [s after midnight].
    formation
        The train as one mass.
    end_s, end_m, end_mps
        Time, place and speed of the front at the end of the last row [s, m, m/s].
    ceiling
        Its speed ceiling, records of `PIECE`.
    """

    run: TrainRun
    path: RoutePath
    rows: NDArray[np.void]
    calls: tuple[JourneyCall, ...]
    status: Status
    start_s: float
    finished_s: float
    formation: Formation
    end_s: float
    end_m: float
    end_mps: float
    ceiling: NDArray[np.void]

    @property
    def seconds(self) -> NDArray[np.float64]:
        """Time for which each row holds [s]."""
        return np.diff(self.rows["time_s"], append=self.end_s)

    def ledgers(self) -> dict[str, TrainLedger]:
        """Return the mechanical ledger and that from pantograph to wheel."""
        mechanical = mechanical_ledger(self.rows, self.seconds, self.end_mps, self.formation, self.path)
        return {"mechanical": mechanical, "pantograph_to_wheel": pantograph_ledger(self.rows, self.seconds)}


def theoretical_journeys(
    scenario: Scenario,
    *,
    voltage_v: Voltage | Mapping[str, Voltage] | None = None,
    step_s: float | None = None,
    form: Form = "time",
    runs: Sequence[str] | None = None,
    plan_voltage: Voltage | None = None,
) -> list[Journey]:
    """Return the theoretical journeys of the trains of a scenario, by identifier (Krzysztozek 2019, eq. 1 to 4).

    Parameters
    ----------
    scenario
        The scenario; its supply counts with its nominal voltage only.
    voltage_v
        Voltage at the pantograph, or that of each run by its identifier; left out, or not told of a run: the nominal one.
    step_s
        Time step [s]; left out: that of the clock.
    form
        ``time``: eq. 1 and 2 in time steps; ``speed``: eq. 3 and 4 integrated over the speed.
    runs
        Identifiers of the runs; left out: all.
    plan_voltage
        Voltage for which driving plans are made that name none themselves; left out: the nominal one.
    """
    movement = compile_driven(scenario, runs, plan_voltage)
    nominal = movement.voltages.u_n
    own = voltage_v if isinstance(voltage_v, Mapping) else dict.fromkeys(movement.names, voltage_v)
    voltages = [_points(nominal if (given := own.get(name)) is None else given) for name in movement.names]
    step = scenario.clock.step_s if step_s is None else step_s
    state = new_train_state(movement.tables)
    return [_run(movement, state, k, voltage, step, form) for k, voltage in enumerate(voltages)]


def _points(voltage_v: Voltage) -> NDArray[np.void]:
    """Return a voltage as points over the distance of the front."""
    return np.array([(0.0, voltage_v)] if isinstance(voltage_v, int | float) else list(voltage_v), POINT)


def _run(movement: Movement, state: TrainState, k: int, voltage: NDArray[np.void], step: float, form: Form) -> Journey:
    planned = movement.runs[k]
    run = run_journey if form == "time" else run_over_speed
    blocks = list(blocks_of_rows(run, (movement.tables, state, k), (planned.start_s, step), voltage))
    _, end, start = blocks[-1]
    train = movement.tables.trains[k]
    pieces = movement.tables.pieces[train["first_piece"] : train["first_piece"] + train["pieces"]]
    return Journey(
        run=planned.run,
        path=planned.path,
        rows=np.concatenate([rows for rows, _, _ in blocks]),
        calls=calls_of(planned, state, int(train["first_stop"])),
        status=_STATUS[end],
        start_s=planned.start_s,
        finished_s=float(state.movers[k]["finished_s"]) if end == ARRIVED else start,
        formation=planned.formation,
        end_s=start,
        end_m=float(state.movers[k]["s_m"]),
        end_mps=float(state.movers[k]["v_mps"]),
        ceiling=pieces,
    )


def calls_of(planned: PlannedRun, state: TrainState, first: int) -> tuple[JourneyCall, ...]:
    """Return the calls of a run with the times of `state`, in which those of the run begin at row `first`."""
    return tuple(
        JourneyCall(
            station=item.call.station,
            kind="stop" if item.call.stops else "pass",
            planned_arrival_s=item.call.arrival,
            planned_departure_s=item.call.departure,
            arrival_s=float(state.arrived_s[row]),
            departure_s=float(state.left_s[row]),
            at_m=item.at_m,
        )
        for row, item in enumerate(planned.calls, start=first)
    )

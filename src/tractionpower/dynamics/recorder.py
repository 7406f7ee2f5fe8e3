"""Rows of a run of a train as many vehicles, on their way to tables, key figures and ``run.json``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.statistics import RainflowCounter, relative_damage
from tractionpower.errors import UsageError
from tractionpower.kernels.chain_state import MARK, ChainState
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.results.dynamics_figures import (
    coupling_figures,
    energy_figures,
    force_verdicts,
    motion_figures,
    stop_figures,
)
from tractionpower.results.dynamics_ledger import EnergyLedger, closing_note
from tractionpower.results.dynamics_tables import (
    controls_table,
    coupling_extremes_table,
    couplings_table,
    distributions_table,
    kinetic_j,
    rainflow_table,
    vehicles_table,
)
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.outcome import Writer
from tractionpower.results.stops import Stop, braking_spells, find_stops

Array = NDArray[Any]

STEPS_DEFINITION = "steps of the method; where a vehicle comes to a stand a step is cut, which counts as two"


class ChainRecorder:
    """Writes what a train records, and sums it up.

    Parameters
    ----------
    scenario
        The case.
    names
        Vehicles, and couplings.
    inertia_kg
        Inertia of the vehicles with rotating parts.
    state
        State at the start; it is read, not kept.
    writer
        Takes the rows.
    """

    def __init__(
        self,
        scenario: DynamicsScenario,
        names: tuple[Sequence[str], Sequence[str]],
        inertia_kg: Array,
        state: ChainState,
        writer: Writer,
    ) -> None:
        self.scenario, self.writer = scenario, writer
        self.vehicles, self.couplings = names
        self._inertia_kg = np.array(inertia_kg, float)
        self._kinetic_start_j = float(kinetic_j(state.movers["v_mps"], self._inertia_kg))
        self._start_m = state.movers["s_m"].copy()
        self._start = float(state.movers[0]["s_m"]), float(state.movers[0]["v_mps"])
        self.notes: list[str] = []
        self._marks: list[Array] = []
        self._is_closed = False
        self.cycles: RainflowCounter | None = None
        try:
            self.cycles = RainflowCounter(len(self.couplings))
        except UsageError as error:
            self.notes.append(f"no cycles are counted: {error}")

    def add(self, chain: Array, vehicles: Array, links: Array, turns: Array, marks: Array) -> None:
        """Take recorded rows: records of `CHAIN_ROW`, `VEHICLE_ROW`, `LINK_ROW`, `TURN` and `MARK`, those in use."""
        self._marks.append(marks)
        if len(chain):
            time_s = chain["time_s"]
            self.writer.append("controls", controls_table(chain, kinetic_j(vehicles["v_mps"], self._inertia_kg)))
            self.writer.append("vehicles", vehicles_table(time_s, self.vehicles, vehicles, self._start_m))
            if len(self.couplings):
                self.writer.append("couplings", couplings_table(time_s, self.couplings, links))
        if self.cycles is not None and len(turns):
            self.cycles.add(turns)

    def close(self, state: ChainState, bins: Array) -> None:
        """Write what is known at the end only: extremes, distributions, cycles; `bins` are records of `HISTOGRAM`.

        Once: what is interrupted at its very end may come here again.
        """
        if self._is_closed:
            return
        self._is_closed = True
        if len(self.couplings):
            damage = None if self.cycles is None else relative_damage(self.cycles.damage(state.links["turn_n"]))
            self.writer.append("coupling_extremes", coupling_extremes_table(self.couplings, state.links, damage))
            if self.cycles is not None:
                self.writer.append("rainflow", rainflow_table(self.couplings, self.cycles.cycles(state.links["turn_n"])))
        self.writer.append("distributions", distributions_table(self._times(state), bins))

    def _times(self, state: ChainState) -> dict[str, Array]:
        force = state.force if len(self.couplings) else np.zeros_like(state.force)
        return {
            "drive_speed": state.drive_speed,
            "brake_speed": state.brake_speed,
            "coupler_force": force,
            "acceleration": state.acceleration,
        }

    def ledger(self, state: ChainState) -> EnergyLedger:
        """Return where the energy has gone up to a state."""
        return EnergyLedger.of(state.ledger[0], self._kinetic_start_j, float(kinetic_j(state.movers["v_mps"], self._inertia_kg)))

    def stops(self, state: ChainState) -> list[Stop]:
        """Return the stops up to a state."""
        pipe = state.pipe[: int(state.ledger[0]["pipe_rows"])]
        controls = state.controls[: int(state.ledger[0]["control_row"]) + 1]
        marks = np.concatenate([np.zeros(0, MARK), *self._marks])
        return find_stops(marks, self._start, braking_spells(controls, pipe))

    def key_figures(self, state: ChainState) -> list[dict[str, Any]]:
        """Return what ``key_figures.json`` holds."""
        ledger = state.ledger[0]
        steps = KeyFigure("steps", float(ledger["steps"]), definition=STEPS_DEFINITION)
        figures = [
            *coupling_figures(self.couplings, state.links),
            *motion_figures(state.movers, self.vehicles),
            *stop_figures(self.stops(state)),
            *energy_figures(self.ledger(state)),
            steps,
        ]
        return [figure.as_dict() for figure in figures if np.isfinite(figure.value)]

    def verdicts(self, state: ChainState) -> list[dict[str, Any]]:
        """Return verdicts on the endurable forces of the couplings."""
        parts = self.scenario.parts[: len(self.couplings)]
        kinds = [self.scenario.coupling(part.coupling) for part in parts if part.coupling is not None]
        return list(force_verdicts(self.couplings, kinds, state.links)) if len(kinds) == len(self.couplings) else []

    def summary(self, state: ChainState) -> dict[str, Any]:
        """Return what ``run.json`` says of the train: vehicles, couplings, stops, ledger, verdicts, notes."""
        ledger, setup, energy = state.ledger[0], self.scenario.case.run, self.ledger(state)
        note = closing_note(energy.gap_share, setup.method, setup.step_s, setup.tolerance)
        return {
            "end_s": float(ledger["time_s"]),
            "method": setup.method,
            "step_s": setup.step_s,
            "steps": int(ledger["steps"]),
            "cut_steps": int(ledger["splits"]),
            "rejected_steps": int(ledger["rejected"]),
            "recorded_rows": int(ledger["recorded"]),
            "flagged_steps": 0,
            "vehicles": list(self.vehicles),
            "couplings": list(self.couplings),
            "stops": [stop.as_dict() for stop in self.stops(state)],
            "ledgers": {"energy": energy.as_dict(setup.method)},
            "verdicts": self.verdicts(state),
            "notes": [*self.notes, *([note] if note else [])],
        }

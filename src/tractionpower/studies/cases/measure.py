"""What one case comes to: a run of which nothing is recorded, watched for voltages, devices, trains and energies.

Outages, sweeps and the search for equipment all measure their cases by the one function `measure`, so that their figures mean
the same and can be held against each other.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.cosimulation.device_recorder import DeviceRecorder
from tractionpower.cosimulation.lateness import TrainLateness, lateness_of
from tractionpower.cosimulation.places import Places
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.cosimulation.useful_voltage_recorder import UsefulVoltageRecorder
from tractionpower.kernels.block_tables import Buffers, take_rows
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.studies.cases.devices import device_figures, device_uses, devices_table
from tractionpower.studies.cases.energy import EnergyWatch
from tractionpower.studies.cases.grants import GrantWatch
from tractionpower.studies.cases.judgement import checks_of, failures
from tractionpower.studies.cases.rails import RailWatch
from tractionpower.studies.cases.served import ServiceWatch
from tractionpower.studies.cases.voltages import VoltageWatch, case_table, coded
from tractionpower.studies.runner.case import CaseResult
from tractionpower.supply.compile import SupplyTables

Floats = NDArray[np.float64]

NAN = float("nan")


def measure(scenario: Scenario) -> CaseResult:
    """Run a scenario and return the key figures and tables of a case; its warm-up does not count.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """
    run = QuietRun(scenario)
    watch = CaseWatch(run)
    devices = DeviceRecorder(scenario, run.compiled.supply, windows_s=())
    grants = GrantWatch(scenario, run.compiled.supply)
    run.watches += [watch, devices, *grants.watches]
    run.execute()
    late = lateness_of(run)
    figures = {**_status(run, watch), **watch.figures(), **_train_figures(late, scenario.feasibility.tolerance_s)}
    figures |= {"trips": _trips(run), "flagged_steps": run.flagged_steps, **grants.figures()}
    used = device_uses(scenario, devices)
    figures |= device_figures(used)
    figures["fails"] = ", ".join(failures(checks_of(scenario), figures))
    tables = {
        "case_devices": devices_table(used, devices),
        "case_profile": watch.voltages.profile(),
        "case_rails": watch.rails.profile(),
    }
    tables["case_trains"] = trains_table(late, scenario.feasibility.tolerance_s)
    return CaseResult(figures, tables)


class CaseWatch:
    """Watches a run for all but its devices.

    Parameters
    ----------
    run
        What is watched; put this among its watches before it is executed.

    Attributes
    ----------
    voltages, rails, energy, served
        What was found of each.
    """

    def __init__(self, run: QuietRun) -> None:
        scenario, supply = run.scenario, run.compiled.supply
        clock = scenario.clock
        self._from_s = clock.counts_from_s
        self._places = Places(scenario, run.movement)
        self.voltages = VoltageWatch(supply, self._places, clock, len(run.movement.runs))
        self.rails = RailWatch(supply, self._places)
        self.energy, self.served = EnergyWatch(clock.step_s), ServiceWatch(run)
        self._useful = UsefulVoltageRecorder(scenario, run.movement, self._places, whole_run_only=True)

    def __call__(self, time_s: Floats, rows: Buffers, supply: SupplyTables) -> None:
        """Take the rows of some steps."""
        counted = time_s >= self._from_s - ROUNDING_S
        if not counted.any():
            return
        time_s, rows = time_s[counted], take_rows(rows, counted)
        trains = rows.trains
        placed = self._places.place(trains["train"], trains["s_m"])
        self.voltages.add(time_s, rows, supply, placed)
        self.rails.add(rows, placed)
        self.energy.add(rows)
        self.served.add(time_s, rows, supply)
        self._useful.add(trains, placed)

    def figures(self) -> dict[str, Any]:
        """Return the key figures of voltages, rail potentials and energies."""
        lowest, greatest = self.voltages.lowest, self.rails.greatest
        return {
            "lowest_voltage_v": lowest[0],
            "lowest_voltage_track": lowest[1],
            "lowest_voltage_km": lowest[2],
            "lowest_voltage_s": lowest[3],
            "highest_voltage_v": float(self.voltages.highest_v),
            **self._useful_voltages(),
            "above_u_max1_s": self.voltages.above_u_max1_s,
            "rail_potential_v": greatest[0],
            "rail_potential_km": greatest[1],
            "energy_kwh": self.energy.busbar_kwh,
            "line_loss_kwh": self.energy.line_loss_kwh,
            **self.served.figures(),
        }

    def _useful_voltages(self) -> dict[str, Any]:
        """Return the lowest mean useful voltage of zones and of trains by both definitions, and of which it is."""
        means = self._useful.means()[0]
        found: dict[str, Any] = {}
        for more, definition in (("", "current_weighted_v"), ("_time_mean", "time_mean_v")):
            for kind in ("zone", "train"):
                lowest = self._useful.lowest(kind, definition, means)
                found |= {f"useful_{kind}{more}_v": lowest.value_v, f"useful_{kind}{more}": lowest.subject}
        return found


def _status(run: QuietRun, watch: CaseWatch) -> dict[str, str]:
    """Return whether all steps were solved, as a run says it, and if not, why."""
    reasons = []
    if run.flagged_steps:
        reasons.append(f"{run.flagged_steps} steps did not converge or could not be served")
    if not watch.energy.ledger.closes:
        reasons.append("the electric ledger does not close")
    return {"status": "flagged" if reasons else "complete", "reason": "; ".join(reasons)}


def _trips(run: QuietRun) -> int:
    clock = run.scenario.clock
    from_s = clock.counts_from_s
    return sum(row["kind"] == "tripped" and row["time_s"] >= from_s - ROUNDING_S for row in run.events)


def _train_figures(late: dict[str, TrainLateness], tolerance_s: float) -> dict[str, Any]:
    timed = {train: each.late_s for train, each in late.items() if np.isfinite(each.late_s)}
    worst = max(timed, key=lambda train: timed[train], default="")
    return {
        "late_trains": sum(seconds > tolerance_s for seconds in timed.values()),
        "worst_late_s": timed.get(worst, NAN),
        "worst_late_train": worst if timed.get(worst, 0.0) > 0.0 else "",
        "stuck_trains": sum(each.holds or each.dark for each in late.values()),
    }


def trains_table(late: dict[str, TrainLateness], tolerance_s: float) -> pa.Table:
    """Return table ``case_trains`` without the column case; what is added to the base case is not known yet."""
    names = sorted(late)
    status = ["stuck" if late[k].holds or late[k].dark else "late" if late[k].late_s > tolerance_s else "on time" for k in names]
    return case_table(
        "case_trains",
        {
            "train": coded(names),
            "late_s": [late[k].late_s for k in names],
            "added_late_s": np.full(len(names), NAN),
            "finished_s": [late[k].finished_s for k in names],
            "status": coded(status),
        },
    )

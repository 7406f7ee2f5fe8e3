"""Cases of a small study and what measures them without a run, so that what hands them out is tested alone."""

import os
import time
from pathlib import Path

import pyarrow as pa

from tractionpower.errors import InputError, Problem
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.studies.runner.case import Case, CaseResult

LIBRARY = Library()


def loads_of(count, **more):
    """Return cases with the load of 1, 2, ... kW."""
    return [Case(f"case {k}", (f"supply.loads[depot].power_kw={k + 1}",), subject=f"{k + 1} kW", **more) for k in range(count)]


def power_kw(scenario: Scenario) -> float:
    return scenario.supply.loads[0].power_kw


def measure_load(scenario: Scenario, rows: int = 3) -> CaseResult:
    """Return figures and rows that follow from the load."""
    power = power_kw(scenario)
    profile = pa.table(
        {
            "track": ["1"] * rows,
            "km": [float(k) for k in range(rows)],
            "lowest_voltage_v": [power / (k + 3.0) for k in range(rows)],
        }
    )
    trains = pa.table(
        {
            "train": ["a", "b"],
            "late_s": [power, None],
            "added_late_s": pa.array([None, None], pa.float32()),
            "finished_s": pa.array([600.0, None], pa.float64()),
            "status": ["late", "on time"],
        }
    )
    figures = {
        "lowest_voltage_v": power / 7.0,
        "late_trains": int(power),
        "useful_zone": f"zone {power:g}",
        "energy_kwh": float("nan"),
    }
    return CaseResult(figures, {"case_profile": profile, "case_trains": trains})


def measure_and_note(scenario: Scenario, folder: str, pause_s: float = 0.0) -> CaseResult:
    """Measure, and leave a mark for each time that it was done."""
    time.sleep(pause_s)
    mark = Path(folder) / f"{power_kw(scenario):g}-{os.getpid()}-{time.monotonic_ns()}"
    mark.touch()
    return measure_load(scenario)


def measure_with_trouble(scenario: Scenario) -> CaseResult:
    """Refuse the second case and fail in the third."""
    if power_kw(scenario) == 2:
        raise InputError([Problem("a", "supply.loads[depot]", "too small", "more"), Problem("b", "clock", "too short")])
    if power_kw(scenario) == 3:
        raise ZeroDivisionError("by nothing")
    return measure_load(scenario)


def measure_or_die(scenario: Scenario, folder: str, of: float, times: int) -> CaseResult:
    """Let the process die during the case with the load `of`, that many times."""
    marks = Path(folder)
    died = len(list(marks.glob("died-*")))
    if power_kw(scenario) == of and died < times:
        (marks / f"died-{died}").touch()
        os._exit(9)
    return measure_and_note(scenario, folder)


def marks_in(folder: Path) -> list[str]:
    """Return the load of each time that a case was measured."""
    return sorted(path.name.split("-")[0] for path in folder.iterdir() if not path.name.startswith("died"))


def run_load(scenario: Scenario) -> CaseResult:
    """Return figures and rows of a run."""
    from tractionpower.cosimulation.simulate import simulate  # noqa: PLC0415 - other workers start faster without it

    results = simulate(scenario)
    profile = results.table("profile")
    rows = {
        "track": list(profile["track"]),
        "km": profile["km"].to_numpy(),
        "lowest_voltage_v": profile["lowest_voltage_v"].to_numpy(),
    }
    return CaseResult({"lowest_voltage_v": profile["lowest_voltage_v"].min()}, {"case_profile": pa.table(rows)})

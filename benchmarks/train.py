"""Time of one step of one train on a line with much on it, and of whole journeys of all trains that ship."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cases import shipped_voltages
from report import goal, table
from timing import Times, take_turns
from tractionpower.io.rolling_stock import load_train, load_vehicle, shipped_trains
from tractionpower.kernels.journey import run_journey
from tractionpower.kernels.train_tables import (
    BY_LINE_CURRENT,
    BY_TRAIN_CURRENT,
    BY_VOLTAGE,
    POINT,
    TRAIN_ROW,
    new_train_state,
)
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import compile_trains
from tractionpower.movement.journey import theoretical_journeys

LENGTH_KM, BEHIND_KM = 200.0, 2.0
STEP_S = 1.0
GRADIENTS, CURVES, LIMITS = 400, 300, 100
"""Rows of the line; each is half to one and a half times as long as their mean."""

STEEPEST, TIGHTEST_M = 6.0, 500.0
SPEEDS_KMH = (80.0, 100.0, 120.0, 140.0, 160.0)
NOMINAL_V, LOW_V = 3000.0, 2400.0
INVERTER_TRAIN, SERIES_TRAIN = "vectron-9-coaches", "ep09-10-coaches"
DRIVES = {"inverter": INVERTER_TRAIN, "effort tables": "tables", "series motors": SERIES_TRAIN}
GOALS_US = {"effort tables": 0.3}
FORMS: tuple[Literal["time", "speed"], ...] = ("time", "speed")
US, MS = 1e6, 1e3


@dataclass(frozen=True)
class StepResult:
    """One drive at one voltage: time of a step, steps of the journey, share of them that voltage or current limits."""

    drive: str
    voltage_v: float
    times: Times
    steps: int
    limited: float


@dataclass(frozen=True)
class JourneyResult:
    """All shipped trains in one form: time of all journeys, rows, mean running time of a train [s]."""

    form: str
    times: Times
    rows: int
    mean_s: float


def measure(rounds: int) -> tuple[list[StepResult], list[JourneyResult], Times]:
    """Time steps and journeys, and the preparation of the latter alone; all of them take turns."""
    study = _study(list(DRIVES.values()))
    runs = {(drive, volts): _Run(study, name, volts) for drive, name in DRIVES.items() for volts in (NOMINAL_V, LOW_V)}
    times = take_turns({str(key): run for key, run in runs.items()}, rounds)
    steps = [
        StepResult(*key, times[str(key)].each(run.steps), run.steps, run.limited) for key, run in runs.items()
    ]  # fmt: skip
    every = _study(shipped_trains())
    found = {form: theoretical_journeys(every, form=form) for form in FORMS}
    late = [journey.run.id for form in FORMS for journey in found[form] if journey.status != "complete"]
    if late:
        raise RuntimeError(f"trains do not arrive: {', '.join(late)}")
    whole = take_turns({"prepare": lambda: _nothing(compile_trains(every))} | {form: _journeys(every, form) for form in FORMS},
                       max(3, rounds // 3))  # fmt: skip
    journeys = [
        JourneyResult(
            form,
            whole[form],
            sum(len(journey.rows) for journey in found[form]),
            float(np.mean([journey.finished_s - journey.start_s for journey in found[form]])),
        )
        for form in FORMS
    ]
    return steps, journeys, whole["prepare"]


class _Run:
    """The whole journey of one train in the kernel alone."""

    def __init__(self, study: Scenario, name: str, voltage_v: float) -> None:
        self._tables = compile_trains(study, [name]).tables
        self._fresh, self._state = new_train_state(self._tables), new_train_state(self._tables)
        self._voltage = np.array([(0.0, voltage_v)], POINT)
        self._rows = np.zeros(20000, TRAIN_ROW)
        self.steps = 0
        self()
        phases = self._rows["limited_by"][: self.steps]
        self.limited = float(np.isin(phases, (BY_LINE_CURRENT, BY_TRAIN_CURRENT, BY_VOLTAGE)).mean())

    def __call__(self) -> None:
        for ours, fresh in zip(self._state, self._fresh, strict=True):
            ours[:] = fresh
        self.steps, end, _ = run_journey(self._tables, self._state, 0, (0.0, STEP_S), self._voltage, self._rows)
        if end:
            raise RuntimeError("the train does not arrive")


def _journeys(study: Scenario, form: Literal["time", "speed"]):
    def action() -> None:
        theoretical_journeys(study, form=form)

    return action


def _nothing(_: object) -> None:
    """Take a result and return none: what an action returns would count as its time."""


def _study(names: list[str]) -> Scenario:
    """Return trains, each alone on the whole line and always the same line."""
    trains, vehicles = [], {}
    for name in names:
        train, its = _tables_train() if name == "tables" else load_train(name)
        trains.append(train)
        vehicles |= {vehicle.id: vehicle for vehicle in its}
    whole = {"from_km": -BEHIND_KM, "to_km": LENGTH_KM}
    route = [{"track": "1", "from_km": 0.0, "to_km": LENGTH_KM}]
    return Scenario.model_validate(
        {
            "line": _line(whole),
            "supply": {
                "substations": [{"id": "S", "km": 0.0, "no_load_voltage_v": 3300.0, "internal_resistance_ohm": 0.1}],
                "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
                "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
            },
            "clock": {"start": 0.0, "end": 3600.0, "step_s": STEP_S},
            "timetable": {"trains": [{"id": t.id, "train": t.id, "route": route, "start": {"time": 0.0}} for t in trains]},
            "trains": sorted(trains, key=lambda train: train.id),
            "vehicles": [vehicles[name] for name in sorted(vehicles)],
            "limits": shipped_voltages(),
        }
    )


def _line(whole: dict[str, float]) -> dict[str, Any]:
    rng = np.random.default_rng(1)
    gradients = [at | {"permille": round(float(rng.uniform(-STEEPEST, STEEPEST)), 1)} for at in _rows(rng, GRADIENTS)]
    curves = [at | {"radius_m": round(float(rng.uniform(TIGHTEST_M, 3000.0)))} for at in _rows(rng, CURVES)[::2]]
    limits = [at | {"kmh": float(rng.choice(SPEEDS_KMH))} for at in _rows(rng, LIMITS)]
    return {"tracks": [whole | {"id": "1"}], "gradients": gradients, "curves": curves, "speed_limits": limits}


def _rows(rng: np.random.Generator, count: int) -> list[dict[str, float]]:
    """Return `count` stretches that fill the line."""
    length = rng.uniform(0.5, 1.5, count)
    ends: NDArray[np.float64] = np.concatenate(([0.0], np.cumsum(length) / length.sum()))
    kms = np.round(-BEHIND_KM + (LENGTH_KM + BEHIND_KM) * ends, 3).tolist()
    return [{"from_km": low, "to_km": high} for low, high in pairwise(kms)]


def _tables_train() -> tuple[Any, tuple[Any, ...]]:
    """Return the inverter train with its drive as tables: every 5 km/h at three voltages."""
    train, vehicles = load_train(INVERTER_TRAIN)
    engine = load_vehicle("vectron-dc")
    inverter: Any = engine.drive
    efforts, currents = [], []
    for volts, share in ((2000.0, 0.4), (NOMINAL_V, 1.0), (3600.0, 1.0)):
        for kmh in np.arange(0.0, engine.max_speed_kmh + 1.0, 5.0).tolist():
            effort = min(inverter.starting_effort_kn, share * inverter.power_kw / max(kmh / 3.6, 1e-9))
            current = 1e3 * (effort * kmh / 3.6 / 0.85 + 50.0) / volts
            efforts.append({"speed_kmh": kmh, "voltage_v": volts, "effort_kn": effort})
            currents.append({"speed_kmh": kmh, "voltage_v": volts, "current_a": current})
    drive = {"kind": "table", "effort": efforts, "current": currents, "max_current_a": 2000.0, "knee_factor": 0.9}
    own = type(engine).model_validate(engine.model_dump() | {"id": "tables-engine", "drive": drive})
    parts = [part.model_dump() | ({"id": own.id} if part.id == engine.id else {}) for part in train.vehicles]
    renamed = type(train).model_validate(train.model_dump() | {"id": "tables", "vehicles": parts})
    return renamed, (own, *(vehicle for vehicle in vehicles if vehicle.id != engine.id))


def describe(results: tuple[list[StepResult], list[JourneyResult], Times]) -> str:
    """Return the results as markdown."""
    steps, journeys, prepare = results
    rows = []
    for r in steps:
        limit = GOALS_US.get(r.drive)
        verdict = f"{limit:g}: {goal(r.times.least * US, limit)}" if limit is not None else ""
        rows.append([f"{r.drive}, {r.voltage_v:g} V", f"{r.times.least * US:.3f}", f"{r.times.median * US:.3f}",
                     r.steps, f"{100 * r.limited:.0f} %", verdict])  # fmt: skip
    headings = ["drive, voltage", "µs a step, least", "median", "steps", "limited by voltage or current", "goal [µs]"]
    text = f"### One step of one train ({LENGTH_KM:g} km, step {STEP_S:g} s)\n\n{table(headings, rows)}"
    number = len(shipped_trains())
    rows = [[f"all, {r.form} form", f"{r.times.least * MS:.1f}", f"{r.times.median * MS:.1f}", r.rows, f"{r.mean_s:.1f}"]
            for r in journeys]  # fmt: skip
    rows.append(["preparation alone", f"{prepare.least * MS:.1f}", f"{prepare.median * MS:.1f}", "", ""])
    headings = ["journeys", "ms, least", "median", "rows", "mean running time [s]"]
    return f"{text}\n\n### Whole journeys of the {number} trains that ship ({LENGTH_KM:g} km)\n\n{table(headings, rows)}"

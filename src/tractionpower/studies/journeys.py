"""Theoretical journeys (PT) of a study beside its timetable (RJ): tables, key figures, and what ``run.json`` says.

Krzysztozek 2019 calls the journey at a given voltage, without the network, *przejazd teoretyczny* (PT), and the
scheduled timetable *rozklad jazdy* (RJ).
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, Literal, get_args

import numpy as np

from tractionpower.alignment.routes import stop_distance
from tractionpower.cosimulation.calls import call_rows, time_at_stops
from tractionpower.cosimulation.check import check_scenario
from tractionpower.errors import Problem, UsageError, raise_errors
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.kernels.train_tables import HOLDING, LIMITED_BY
from tractionpower.model.base import format_time
from tractionpower.model.limits import system_voltages
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import Journey, theoretical_journeys
from tractionpower.movement.ledgers import told_kwh
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.outcome import Writer
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter
from tractionpower.results.trains import CallRow, calls_table, sum_up, train_figures, trains_table
from tractionpower.results.versions import versions

Form = Literal["time", "speed"]

LEAST_STEP_S, MOST_STEP_S = 0.02, 5.0
"""Steps that are allowed [s]."""


@dataclass(frozen=True, slots=True)
class JourneyOutcome:
    """Theoretical journeys of a study.

    Attributes
    ----------
    journeys
        One for each train, in the order of their identifiers.
    voltage_v
        Voltage at the pantograph [V].
    calls
        Rows of table ``calls`` by train.
    key_figures
        What ``key_figures.json`` holds.
    run
        What ``run.json`` says, without the files.
    warnings
        Warnings of the checks.
    """

    journeys: tuple[Journey, ...]
    voltage_v: float
    calls: dict[str, list[CallRow]] = field(default_factory=dict)
    key_figures: list[dict[str, Any]] = field(default_factory=list)
    run: dict[str, Any] = field(default_factory=dict)
    warnings: tuple[Problem, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether every train reached the end of its route, and every ledger closes."""
        return bool(self.run["status"] == "complete")


def compute_journeys(
    scenario: Scenario,
    writer: Writer,
    study: str = "",
    *,
    voltage_v: float | None = None,
    step_s: float | None = None,
    form: Form = "time",
    runs: Sequence[str] | None = None,
) -> JourneyOutcome:
    """Compute theoretical journeys and give their tables ``trains`` and ``calls`` to a writer.

    Parameters
    ----------
    scenario
        The study.
    writer
        Takes the rows.
    study
        Identifier for ``run.json``.
    voltage_v
        Voltage at the pantograph [V]; left out: the nominal voltage of the system.
    step_s
        Step [s]; left out: that of the clock.
    form
        ``time`` integrates in time steps, ``speed`` over speed (Krzysztozek 2019, equations 3 and 4).
    runs
        Trains of the timetable; left out: all.

    Raises
    ------
    InputError
        If the study has errors; all of them are told.
    UsageError
        If an option is not allowed, or the study has no trains, or not those that are asked for.
    """
    started = time.perf_counter()
    _check_options(voltage_v, step_s, form)
    wanted = choose_runs(scenario, runs)
    problems = check_scenario(scenario)
    raise_errors(problems)
    voltage = system_voltages(scenario.limits, scenario.supply.system).u_n if voltage_v is None else float(voltage_v)
    step = scenario.clock.step_s if step_s is None else float(step_s)
    prepared = time.perf_counter()
    journeys = tuple(theoretical_journeys(scenario, voltage_v=voltage, step_s=step, form=form, runs=wanted))
    calls = {journey.run.id: call_rows(journey.run.id, journey.calls, route_end(journey)) for journey in journeys}
    for journey in journeys:
        writer.append("trains", _trains_table(journey))
    every_call = [row for rows in calls.values() for row in rows]
    if every_call:
        writer.append("calls", calls_table(every_call))
    figures = [figure.as_dict() for journey in journeys for figure in _figures(journey)]
    how = {"voltage_v": voltage, "step_s": step, "form": form}
    times = {"wall_seconds": time.perf_counter() - prepared, "compile_seconds": prepared - started}
    run = _summary(scenario, study, journeys) | times | how
    return JourneyOutcome(journeys, voltage, calls, figures, run, tuple(problems))


def journeys(
    scenario: Scenario,
    *,
    voltage_v: float | None = None,
    step_s: float | None = None,
    form: Form = "time",
    runs: Sequence[str] | None = None,
) -> Results:
    """Return the theoretical journeys of a study as results in memory.

    Parameters
    ----------
    scenario
        The study.
    voltage_v
        Voltage at the pantograph [V]; left out: the nominal voltage of the system.
    step_s
        Step [s], 0.02 to 5; left out: that of the clock.
    form
        ``time`` integrates in time steps, ``speed`` over speed.
    runs
        Trains of the timetable; left out: all.

    Raises
    ------
    InputError
        If the study has errors; all of them are told.
    UsageError
        If an option is not allowed, or the study has no trains, or not those that are asked for.
    """
    writer = MemoryWriter()
    outcome = compute_journeys(scenario, writer, voltage_v=voltage_v, step_s=step_s, form=form, runs=runs)
    return Results(outcome.run, outcome.key_figures, writer.tables(), scenario)


def _check_options(voltage_v: Any, step_s: Any, form: Any) -> None:
    if form not in get_args(Form):
        raise UsageError(f"form {shown(form)}: allowed are {' and '.join(get_args(Form))}")
    if voltage_v is not None and not (_is_finite(voltage_v) and voltage_v > 0.0):
        raise UsageError(f"voltage_v {shown(voltage_v)}: allowed are finite numbers above 0 V")
    if step_s is not None and not (_is_finite(step_s) and LEAST_STEP_S <= step_s <= MOST_STEP_S):
        raise UsageError(f"step_s {shown(step_s)}: allowed are {LEAST_STEP_S:g} to {MOST_STEP_S:g} s")


def _is_finite(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _summary(scenario: Scenario, study: str, journeys: Sequence[Journey]) -> dict[str, Any]:
    ledgers = _ledgers(journeys)
    complete = all(journey.status == "complete" for journey in journeys)
    complete = complete and all(ledger["closes"] for ledger in ledgers.values())
    return {
        "format": 1,
        "status": "complete" if complete else "flagged",
        "study": study,
        "name": scenario.name,
        "input_hash": scenario.input_hash,
        "seed": scenario.seed,
        "versions": versions(),
        "steps": sum(len(journey.rows) for journey in journeys),
        "ledgers": ledgers,
        "verdicts": [],
        "journeys": [_note(journey) for journey in journeys],
    }


def _ledgers(journeys: Sequence[Journey]) -> dict[str, dict[str, Any]]:
    """Return for each kind of ledger whether it closes for every train, and the train with the greatest gap."""
    found: dict[str, dict[str, Any]] = {}
    for journey in journeys:
        for name, ledger in journey.ledgers().items():
            entry = found.setdefault(name, {"closes": True, "worst_gap_share": -1.0, "train": ""})
            entry["closes"] = entry["closes"] and ledger.closes
            if ledger.gap_share > entry["worst_gap_share"]:
                entry |= {"worst_gap_share": ledger.gap_share, "train": journey.run.id}
            for part, kwh in told_kwh(name, ledger.energy_j).items():
                entry[part] = entry.get(part, 0.0) + kwh
    return found


def choose_runs(scenario: Scenario, named: Sequence[str] | None) -> list[str]:
    """Return the identifiers of the trains to run, sorted.

    Raises
    ------
    UsageError
        If there are no trains at all, or a name is unknown.
    """
    known = sorted(run.id for run in scenario.runs)
    if not known:
        remedy = "name a timetable with trains in study.yaml; `tractionpower run` computes the network alone"
        raise UsageError(f"the study has no trains; {remedy}")
    unknown = [name for name in dict.fromkeys(named or ()) if name not in known]
    if unknown:
        parts = [f"no train {shown(name)}{_hint(name, known)}" for name in unknown]
        raise UsageError("; ".join([*parts, f"trains of the timetable: {_listed(known)}"]))
    return known if named is None else sorted(set(named))


def stations_on(journey: Journey, line: Line) -> list[tuple[float, str]]:
    """Return distance [m] and name of every station that the route passes, in its order."""
    places = [(stop_distance(journey.path, station), station.name or station.id) for station in line.stations]
    return sorted((place, name) for place, name in places if place is not None)


def route_in_words(journey: Journey, line: Line) -> str:
    """Return the route of a train: the stations at its ends, or else track and kilometre."""
    named = {round(place): name for place, name in stations_on(journey, line)}
    ends = []
    for place in (0.0, route_end(journey)):
        track, km = journey.path.place(place)
        ends.append(named.get(round(place), f"track {track}, km {km:.1f}"))
    return " – ".join(ends)


def route_end(journey: Journey) -> float:
    """Return where the run ends [m]."""
    return float(journey.ceiling["from_m"][-1])


def end_of(journey: Journey) -> float:
    """Return the distance of the front at the end of a journey [m]."""
    return route_end(journey) if journey.status == "complete" else float(journey.rows["s_m"][-1])


def why_not_complete(journey: Journey) -> str:
    """Return in a sentence where and why a train did not reach the end of its route."""
    last = journey.rows[-1]
    track, km = journey.path.place(float(last["s_m"]))
    where = f"train {journey.run.id} is {'stuck' if journey.status == 'stuck' else 'not at its end'}"
    where += f" on track {track} at km {km:.3f}, {format_time(round(float(journey.finished_s)))}"
    if journey.status != "stuck":
        return f"{where}: the computation ended before its run"
    by = LIMITED_BY[last["limited_by"]].replace("_", " ")
    limit = "" if by == "nothing" else f", limited by {by},"
    # A row in which it stands has no forces, and that in which it comes to a stand has those of a part of the step.
    moving = journey.rows[journey.rows["phase"] != HOLDING][-2:]
    before = max(moving, key=lambda row: float(row["resistance_n"]), default=last)
    effort, resistance = float(before["traction_n"]) / 1000.0, float(before["resistance_n"]) / 1000.0
    if resistance <= effort:  # it has not moved at all
        return f"{where}: its tractive effort{limit} does not overcome the resistance"
    return f"{where}: its tractive effort of {effort:.1f} kN{limit} does not overcome the resistance of {resistance:.1f} kN"


def _note(journey: Journey) -> dict[str, Any]:
    note = {"train": journey.run.id, "status": journey.status, "finished_s": float(journey.finished_s)}
    return note if journey.status == "complete" else note | {"message": why_not_complete(journey)}


def _trains_table(journey: Journey) -> Any:
    leg, km = journey.path.places(journey.rows["s_m"])
    names = [leg.axis.track for leg in journey.path.legs]
    known = sorted(set(names))
    code = np.array([known.index(name) for name in names])
    train = (np.zeros(len(journey.rows), int), [journey.run.id])
    return trains_table(journey.rows, train, (code[leg], known), km)


def _figures(journey: Journey) -> Iterator[KeyFigure]:
    whole = journey.finished_s - journey.start_s
    stood = time_at_stops(journey.calls, journey.start_s, journey.finished_s)
    length_m, running_s = end_of(journey), whole - stood
    rows, seconds = journey.rows, journey.seconds
    return train_figures(sum_up(journey.run.id, rows, seconds, length_m=length_m, journey_s=whole, running_s=running_s))


def _hint(name: str, known: Sequence[str]) -> str:
    hint = did_you_mean(name, known)
    return f", {hint}" if hint else ""


def _listed(names: Sequence[str], most: int = 12) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")

"""Is the timetable feasible on this supply? Every train alone and with the network, and what the difference is due to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.cosimulation.lateness import STUCK_S, lateness_of
from tractionpower.cosimulation.quiet import run_quietly
from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.simulate import Prepared, computed
from tractionpower.errors import Problem, UsageError
from tractionpower.kernels.train_tables import OUTSIDE
from tractionpower.model.scenario import Output, Scenario
from tractionpower.movement.compile import Movement
from tractionpower.movement.journey import calls_of
from tractionpower.movement.turns import Link, links_of
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.studies.feasibility.alone import AloneTimes, run_all_alone
from tractionpower.studies.feasibility.areas import Areas
from tractionpower.studies.feasibility.chain import Before, Chain, TrainFacts, chain_of
from tractionpower.studies.feasibility.judgement import FEASIBLE, INFEASIBLE, NAN, NOT_JUDGED, Judgement
from tractionpower.studies.feasibility.recording import Recording
from tractionpower.studies.feasibility.tables import feasibility_notes, key_figures, write_tables
from tractionpower.studies.feasibility.verdicts import Judged, Span, judge_train

KIND = "feasibility"
"""What results are, as ``run.json`` says it."""

USEFUL = ("mean_useful_voltage_current_weighted_v", "mean_useful_voltage_time_mean_v")


class _Nowhere:
    """A writer that keeps nothing."""

    def append(self, table: str, rows: pa.Table) -> None:
        """Take rows and forget them."""


def judge(
    scenario: Scenario,
    writer: Writer | None = None,
    *,
    study: str = "",
    tolerance_s: float | None = None,
    progress: Progress | None = None,
) -> Judgement:
    """Run a timetable with the network and each train alone, split the delays, and judge.

    Parameters
    ----------
    scenario
        What to judge.
    writer
        Takes the tables of the run, and ``delays``, ``sections`` and ``lost_time``; left out: only what is returned is kept.
    study
        Identifier of the study, for ``run.json``.
    tolerance_s
        A train is late if it is later than this [s]; left out: as the study says.
    progress
        Called now and then with the steps done and the steps in all.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    UsageError
        If it has no trains, or the tolerance is not allowed.
    """
    return Judging(scenario, writer, study=study, tolerance_s=tolerance_s).execute(progress)


class Judging:
    """A judgement in the making: parameters and exceptions are those of `judge`.

    Attributes
    ----------
    run
        The run with the network.
    """

    def __init__(
        self, scenario: Scenario, writer: Writer | None = None, *, study: str = "", tolerance_s: float | None = None
    ) -> None:
        self.tolerance_s = scenario.feasibility.tolerance_s if tolerance_s is None else float(tolerance_s)
        _refuse(scenario, self.tolerance_s)
        self.scenario, self._recording = scenario, Recording()
        calls_alone: dict[str, Any] = {"output": Output(tables=("calls",))}
        self._writer: Writer = _Nowhere() if writer is None else writer
        what = scenario.model_copy(update=calls_alone) if writer is None else scenario
        self.run = Run(what, self._writer, study, [self._recording])

    def execute(self, progress: Progress | None = None) -> Judgement:
        """Run to the end of the clock, and judge."""
        outcome = self.run.execute(progress)
        return judge_outcome(self.scenario, self.run, (outcome, self._recording), self._writer, self.tolerance_s)

    def keep_unfinished(self, writer: RunWriter) -> Path:
        """Keep what an interrupted run has computed, with a note that there is no verdict; return where it is."""
        unfinished = self.run.outcome()
        note = unfinished.run | {"status": "interrupted", "input_hash": self.scenario.input_hash}
        return writer.keep_unfinished(note, unfinished.key_figures)


def judge_outcome(scenario: Scenario, run: Run, done: tuple[Outcome, Recording], writer: Writer, tolerance_s: float) -> Judgement:
    """Judge a run that has been executed, with the recording of its trains."""
    outcome, recording = done
    facts = _facts(scenario, run, recording)
    chains = _chains(_links(scenario, run.compiled.movement), facts)
    clock = scenario.clock
    span = Span(clock.counts_from_s, float(outcome.run["end_s"]), tolerance_s)
    areas, useful = Areas(scenario), _useful_voltages(outcome)
    judged = [judge_train(train, chains[train.name], areas, span, useful.get(train.name, (NAN, NAN))) for train in facts]
    return _put_together(scenario, (outcome, judged), writer, tolerance_s, _warnings(facts))


def _refuse(scenario: Scenario, tolerance_s: float) -> None:
    if not scenario.runs:
        remedy = "name a timetable with trains in study.yaml; `tractionpower run` computes the network alone"
        raise UsageError(f"the study has no trains; {remedy}")
    if not (np.isfinite(tolerance_s) and tolerance_s >= 0.0):
        raise UsageError(f"tolerance {tolerance_s:g} s: allowed are finite numbers from 0 s")


def _put_together(
    scenario: Scenario, done: tuple[Outcome, Sequence[Judged]], writer: Writer, tolerance_s: float, warnings: tuple[Problem, ...]
) -> Judgement:
    outcome, judged = done
    trains = tuple(item.verdict for item in judged)
    delays = tuple(row for item in judged for row in item.delays)
    sections = tuple(row for item in judged for row in item.sections)
    lost = tuple(row for item in judged for row in item.lost)
    write_tables(writer, delays, sections, lost)
    reserve = min((train.reserve_left_s for train in trains if np.isfinite(train.reserve_left_s)), default=NAN)
    holds = all(train.holds for train in trains)
    is_judged = any(np.isfinite(row.delay_s) for row in delays)
    verdict: Any = INFEASIBLE if not holds else FEASIBLE if is_judged else NOT_JUDGED
    overall = {"verdict": verdict, "reserve_left_s": reserve, "tolerance_s": tolerance_s}
    figures = [*outcome.key_figures, *key_figures(trains, lost, reserve)]
    notes = {"kind": KIND, "feasibility": feasibility_notes(trains, lost, overall)}
    said = {**outcome.run, "input_hash": scenario.input_hash, **notes}
    outcome = replace(outcome, run=said, key_figures=figures, warnings=(*outcome.warnings, *warnings))
    return Judgement(outcome, trains, delays, sections, lost, verdict, reserve, tolerance_s, outcome.warnings)


def _facts(scenario: Scenario, run: Run, recording: Recording) -> list[TrainFacts]:
    """Return what the run, and those alone, tell of every train."""
    movement, state = run.compiled.movement, run.state.trains
    table = movement.tables.trains
    traces = recording.traces(len(movement.runs), scenario.clock.step_s)
    entered = np.where(state.movers["status"] == OUTSIDE, NAN, state.entered_s)
    turn_s = {link.then: link.turn_s for link in sorted(_links(scenario, movement), key=lambda link: link.turn_s)}
    alone = run_all_alone(scenario, entered, state.left_s, traces)
    return [
        TrainFacts(
            planned=planned,
            calls=calls_of(planned, state, int(table[k]["first_stop"])),
            entered_s=float(entered[k]),
            due_s=planned.start_s - (turn_s[planned.run.id] if table[k]["takes_over"] else 0.0),
            reached_m=float(state.movers[k]["s_m"]),
            finished_s=float(state.movers[k]["finished_s"]),
            is_stuck=bool(state.movers[k]["held_s"] >= STUCK_S),
            trace=traces[k],
            alone=alone[k],
            has_plan=bool(table[k]["plans"] or table[k]["caps"]),
        )
        for k, planned in enumerate(movement.runs)
    ]


def _links(scenario: Scenario, movement: Movement) -> list[Link]:
    """Return which runs of a scenario become which."""
    return links_of(scenario.timetable, movement.names)


def _chains(links: Sequence[Link], facts: Sequence[TrainFacts]) -> dict[str, Chain]:
    """Return the chains of all trains by name; a run that becomes another one hands its chains on."""
    known, chains = {train.name: train for train in facts}, dict[str, Chain]()
    ordered = sorted(links, key=lambda link: (np.nan_to_num(known[link.first].finished_s), link.first))
    before: dict[str, list[Link]] = {}
    for link in ordered:
        before.setdefault(link.then, []).append(link)

    def find(name: str) -> Chain:
        if name not in chains:
            earlier = [Before(known[link.first], find(link.first), link.turn_s) for link in before.get(name, ())]
            chains[name] = chain_of(known[name], earlier)
        return chains[name]

    return {train.name: find(train.name) for train in facts}


def _useful_voltages(outcome: Outcome) -> dict[str, tuple[float, float]]:
    """Return the mean useful voltage of every train by both definitions [V]."""
    found: dict[str, dict[str, float]] = {}
    for figure in outcome.key_figures:
        if figure["name"] in USEFUL and figure["place"].startswith("train "):
            found.setdefault(figure["place"].removeprefix("train "), {})[figure["name"]] = figure["value"]
    return {train: (values.get(USEFUL[0], NAN), values.get(USEFUL[1], NAN)) for train, values in found.items()}


def _warnings(facts: Sequence[TrainFacts]) -> tuple[Problem, ...]:
    return tuple(_stuck_alone(train) for train in facts if not _arrives(train.alone, train))


def _arrives(alone: AloneTimes, train: TrainFacts) -> bool:
    return bool(alone.limited.at_m[-1] >= min(train.reached_m, train.planned.route_m) - 1.0)


def _stuck_alone(train: TrainFacts) -> Problem:
    track, km = train.planned.path.place(float(train.alone.limited.at_m[-1]))
    found = f"train {train.name} alone at nominal voltage does not get beyond km {km:.1f} of track {track}"
    remedy = "correct its effort or current limits; what it lost to low voltage is not known from there on"
    return Problem("stuck_alone", f"timetable.trains[{train.name}]", found, "a train that reaches its end", remedy, "warning")


def lateness(scenario: Scenario) -> dict[str, float]:
    """Return the greatest lateness of each train over its timed calls in the run with the network [s].

    A train that has not come to a call that is due counts with the time until the end of the run, one that is stuck as
    infinitely late. Without a timed call it is never late. The time that counts is that of `judge`.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """
    found = lateness_of(run_quietly(scenario))
    return {train: float("inf") if each.holds else float(np.nan_to_num(each.late_s)) for train, each in found.items()}


def feasibility(
    scenario: Scenario,
    folder: str | Path | None = None,
    *,
    tolerance_s: float | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Results:
    """Judge whether a timetable is feasible on its supply, and return the results of the run with the verdict.

    ``results.run["feasibility"]`` has the verdict, tables ``delays``, ``sections`` and ``lost_time`` what it stands on.

    Parameters
    ----------
    scenario
        What to judge.
    folder
        Where to write the results; left out, they stay in memory.
    tolerance_s
        A train is late if it is later than this [s]; left out: as the study says.
    force
        Write even where results of another study are.
    progress
        Called now and then with the steps done and the steps in all.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    UsageError
        If it has no trains, or the tolerance is not allowed.
    OutputError
        If the results cannot be written.
    """

    def prepare(writer: Writer) -> Prepared:
        judging = Judging(scenario, writer, study=scenario.name, tolerance_s=tolerance_s)
        return lambda told: judging.execute(told).outcome, judging.keep_unfinished

    return computed(scenario, folder, prepare, kind=KIND, force=force, progress=progress)

"""One call from a case of train dynamics to its results, for notebooks and scripts."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tractionpower.dynamics.run import KIND, CaseRun
from tractionpower.dynamics.traindyn.stations_run import KIND as STATIONS
from tractionpower.dynamics.traindyn.stations_run import StationsRun
from tractionpower.errors import Problem
from tractionpower.io.dynamics_files import load_case
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.results.kept import input_hash_of
from tractionpower.results.outcome import Progress, Writer
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter, RunWriter


def simulate_case(
    case: str | Path | DynamicsScenario | StationsCase,
    folder: str | Path | None = None,
    *,
    force: bool = False,
    progress: Progress | None = None,
) -> Results:
    """Run a case of train dynamics.

    Parameters
    ----------
    case
        A folder with a ``case.yaml``, such a file, a configuration of Arshad et al., the name of a case that ships; or what
        `load_case` has read, its ``scenario``.
    folder
        Where to write the results; left out, they stay in memory.
    force
        Write even where results of another case are.
    progress
        Called now and then with the steps done and the steps in all.

    Raises
    ------
    InputError
        If the case has errors; all of them are told.
    UsageError
        If there is no such case, or a package that it needs is not installed.
    OutputError
        If the results cannot be written.
    """
    if isinstance(case, str | Path):
        loaded = load_case(case)
        scenario, name, warnings = loaded.scenario, loaded.name, loaded.problems
    else:
        scenario, name, warnings = case, case.name, ()
    if folder is None:
        memory = MemoryWriter()
        outcome = new_run(scenario, memory, name, warnings).execute(progress)
        return Results(outcome.run, outcome.key_figures, memory.tables(), scenario)
    kind = KIND if isinstance(scenario, DynamicsScenario) else STATIONS
    writer = RunWriter(Path(folder), name, input_hash_of(scenario), kind=kind, force=force, scenario=scenario)
    try:
        run = new_run(scenario, writer, name, warnings)
    except BaseException:
        writer.discard()
        raise
    try:
        outcome = run.execute(progress)
        writer.finish(outcome.run, outcome.key_figures)
    except KeyboardInterrupt:
        run.keep_unfinished(writer)
        raise
    return Results.open(Path(folder))


def new_run(
    scenario: DynamicsScenario | StationsCase, writer: Writer, name: str, warnings: Iterable[Problem] = ()
) -> CaseRun | StationsRun:
    """Return a run of a case of either kind, checked; `warnings` are what reading it has found.

    Raises
    ------
    InputError
        With all problems of the case.
    UsageError
        If a package that it needs is not installed.
    """
    if isinstance(scenario, DynamicsScenario):
        return CaseRun(scenario, writer, name, warnings=warnings)
    return StationsRun(scenario, writer, name, warnings=warnings)

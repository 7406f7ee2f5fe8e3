"""One call from a scenario to its results, for notebooks and scripts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tractionpower.cosimulation.run import Run
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter, RunWriter

Prepared = tuple[Callable[[Progress | None], Outcome], Callable[[RunWriter], Path]]
"""How to run to the end, and how to keep what is unfinished."""


def simulate(
    scenario: Scenario, folder: str | Path | None = None, *, force: bool = False, progress: Progress | None = None
) -> Results:
    """Run a scenario.

    Parameters
    ----------
    scenario
        What to run.
    folder
        Where to write the results; left out, they stay in memory.
    force
        Write even where results of another study are.
    progress
        Called now and then with the steps done and the steps in all.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    OutputError
        If the results cannot be written.
    """

    def prepare(writer: Writer) -> Prepared:
        run = Run(scenario, writer, scenario.name)
        return run.execute, run.keep_unfinished

    return computed(scenario, folder, prepare, force=force, progress=progress)


def computed(
    scenario: Scenario,
    folder: str | Path | None,
    prepare: Callable[[Writer], Prepared],
    *,
    kind: str = "",
    force: bool = False,
    progress: Progress | None = None,
) -> Results:
    """Compute something of a scenario and return its results; parameters not told here are those of `simulate`.

    A folder is left as it was if preparing fails; what is computed when Ctrl-C comes is kept.

    Parameters
    ----------
    prepare
        Called with what takes the tables; makes the runs ready.
    kind
        What is computed, as ``run.json`` says it; empty: a run.
    """
    if folder is None:
        memory = MemoryWriter()
        execute, _ = prepare(memory)
        outcome = execute(progress)
        return Results(outcome.run, outcome.key_figures, memory.tables(), scenario)
    writer = RunWriter(Path(folder), scenario.name, scenario.input_hash, kind=kind, force=force, scenario=scenario)
    try:
        execute, keep_unfinished = prepare(writer)
    except BaseException:
        writer.discard()
        raise
    try:
        outcome = execute(progress)
        writer.finish(outcome.run, outcome.key_figures)
    except KeyboardInterrupt:
        keep_unfinished(writer)
        raise
    return Results.open(Path(folder))

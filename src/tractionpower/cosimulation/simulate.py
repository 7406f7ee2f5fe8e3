"""One call from a scenario to its results, for notebooks and scripts."""

from __future__ import annotations

from pathlib import Path

from tractionpower.cosimulation.run import Progress, Run
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter, RunWriter


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
    if folder is None:
        memory = MemoryWriter()
        outcome = Run(scenario, memory, scenario.name).execute(progress)
        return Results(outcome.run, outcome.key_figures, memory.tables(), scenario)
    writer = RunWriter(Path(folder), scenario.name, scenario.input_hash, force=force, scenario=scenario)
    try:
        run = Run(scenario, writer, scenario.name)
    except BaseException:
        writer.discard()
        raise
    try:
        outcome = run.execute(progress)
        writer.finish(outcome.run, outcome.key_figures)
    except KeyboardInterrupt:
        run.keep_unfinished(writer)
        raise
    return Results.open(folder)

"""Every outage of a study, compared with the base case: does each device hold, and the timetable?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tractionpower.cosimulation.check import check_scenario
from tractionpower.errors import Problem, raise_errors
from tractionpower.io.library import shipped_library
from tractionpower.model.contingency import Contingency
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Writer
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter, RunWriter
from tractionpower.results.versions import versions
from tractionpower.studies.cases.devices import ratings_by_id
from tractionpower.studies.cases.judgement import checks_of, verdicts
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.envelope import Delays, DeviceEnvelope, LineEnvelope
from tractionpower.studies.contingency.outages import find_outages
from tractionpower.studies.contingency.summary import figures_of, summary_of
from tractionpower.studies.contingency.unfinished import note_unfinished
from tractionpower.studies.runner.case import COMPLETE
from tractionpower.studies.runner.into_folder import run_into
from tractionpower.studies.runner.outcomes import CasesRun, write_cases
from tractionpower.studies.runner.run import Told, run_cases
from tractionpower.studies.runner.store import CaseStore


class OutageStudy:
    """A study of outages in the making.

    Parameters
    ----------
    scenario
        What is looked at; its `contingency` chooses the outages.
    library
        Tables of equipment; left out: those that ship.
    study
        Identifier of the study, for ``run.json``.
    pairs
        Whether all pairs of different devices are out, too.
    grids
        Grid voltages of all cases; left out: those of the study, and for pairs the normal one.

    Attributes
    ----------
    cases
        What is run.
    notes
        Outages that are not looked at, and why.
    begins
        When outages of units that a reserve replaces begin, and why then.
    warnings
        Warnings of the checks of the base.

    Raises
    ------
    InputError
        If the scenario has errors, or names a device that does not exist; all of them are told.
    """

    def __init__(
        self,
        scenario: Scenario,
        *,
        library: Library | None = None,
        study: str = "",
        pairs: bool = False,
        grids: Sequence[str] | None = None,
    ) -> None:
        problems = check_scenario(scenario)
        raise_errors(problems)
        self.warnings: tuple[Problem, ...] = tuple(problems)
        self.scenario, self.study = scenario, study
        self._library = shipped_library() if library is None else library
        found = find_outages(scenario, pairs=pairs, grids=grids)
        self.cases, self.notes, self.begins = found.cases, found.notes, found.begins

    def execute(
        self,
        writer: Writer,
        store: CaseStore,
        *,
        workers: int = 1,
        scheduler: str | None = None,
        progress: Told | None = None,
    ) -> OutageOutcome:
        """Run all cases and write the tables; parameters are those of `studies.runner.run.run_cases`.

        After Ctrl-C the tables have the cases that had ended, and the outcome says so.
        """
        # Which outages are looked at changes none of them: with other choices they are found in the store again.
        base = self.scenario.model_copy(update={"contingency": Contingency()})
        run = run_cases(base, self._library, self.cases, measure, store, workers=workers, scheduler=scheduler, progress=progress)
        note_unfinished(self.scenario, checks_of(self.scenario), run)
        line, devices, delays = LineEnvelope(), DeviceEnvelope(), Delays()
        completed = {"case_profile": line.add_profile, "case_rails": line.add_rails, "case_devices": devices.add,
                     "case_trains": delays.add}  # fmt: skip
        write_cases(run, writer, completed)
        writer.append("envelope", line.table())
        writer.append("device_envelope", devices.table())
        return OutageOutcome(self, run, devices, scheduler)


class OutageOutcome:
    """How a study of outages ended.

    Attributes
    ----------
    cases
        All that was run.
    run, key_figures
        What ``run.json``, without the files, and ``key_figures.json`` hold.
    """

    def __init__(self, study: OutageStudy, cases: CasesRun, devices: DeviceEnvelope, scheduler: str | None) -> None:
        scenario, self.cases = study.scenario, cases
        checks, ratings = checks_of(scenario), ratings_by_id(scenario)
        said = verdicts(checks, cases.rows, ratings)
        self.run: dict[str, Any] = {
            "format": 1,
            "status": self._status(),
            "study": study.study,
            "name": scenario.name,
            "kind": "contingency",
            "input_hash": scenario.input_hash,
            "seed": scenario.seed,
            "step_s": scenario.clock.step_s,
            "start_s": scenario.clock.start,
            "end_s": scenario.clock.end,
            "versions": versions(),
            "wall_seconds": cases.wall_seconds,
            "workers": cases.workers,
            "scheduler": scheduler,
            "cases": cases.counts(),
            "verdicts": said,
            "contingency": summary_of(scenario, checks, cases, devices, ratings, study.notes) | {"begins": list(study.begins)},
        }
        self.key_figures = figures_of(checks, said, cases.rows)

    def _status(self) -> str:
        if self.cases.interrupted:
            return "interrupted"
        return COMPLETE if self.cases.count(COMPLETE) == len(self.cases.cases) else "flagged"

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C came before all cases had ended."""
        return self.cases.interrupted

    @property
    def flagged(self) -> bool:
        """Whether a case is flagged, was refused or failed."""
        return bool(self.run["status"] == "flagged")

    @property
    def holds(self) -> bool:
        """Whether no limit is violated in any case."""
        return all(verdict["met"] for verdict in self.run["verdicts"])


def contingency(
    scenario: Scenario,
    folder: str | Path | None = None,
    *,
    library: Library | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    pairs: bool = False,
    force: bool = False,
    progress: Told | None = None,
) -> Results:
    """Run every single outage that `scenario.contingency` asks for, and compare each with the base case.

    ``results.run["contingency"]`` sums it up; tables ``cases``, ``envelope`` and ``device_envelope`` have the figures of each
    outage, the worst along the line, and the worst of each device.

    Parameters
    ----------
    scenario
        What is looked at.
    folder
        Where to write the results; left out, they stay in memory. What was interrupted there goes on.
    library
        Tables of equipment; left out: those that ship.
    workers, scheduler
        Cases at a time, in processes of their own; or the address of a Dask scheduler whose workers run them.
    pairs
        Whether all pairs of different devices are out, too.
    force
        Write even where results of another study are.
    progress
        Called whenever a case has ended.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    UsageError
        If the cluster does not answer, or the folder is another study's.
    OutputError
        If the results cannot be written.
    KeyboardInterrupt
        After Ctrl-C; the cases that had ended are kept in the folder.
    """
    outages = OutageStudy(scenario, library=library, study=scenario.name, pairs=pairs)
    how: dict[str, Any] = {"workers": workers, "scheduler": scheduler, "progress": progress}
    if folder is None:
        memory = MemoryWriter()
        outcome = outages.execute(memory, CaseStore(), **how)
        if outcome.interrupted:
            raise KeyboardInterrupt
        return Results(outcome.run, outcome.key_figures, memory.tables(), scenario)
    writer = RunWriter(Path(folder), scenario.name, scenario.input_hash, kind="contingency", force=force, scenario=scenario)
    if run_into(outages, writer, **how).interrupted:
        raise KeyboardInterrupt
    return Results.open(folder)

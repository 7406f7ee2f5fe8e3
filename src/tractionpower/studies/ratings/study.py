"""Does every device hold? One run with all its tables, and what each device carries of what it may."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.simulate import Prepared, computed
from tractionpower.cosimulation.useful_voltage_recorder import UsefulVoltageRecorder
from tractionpower.errors import Problem
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.results import Results
from tractionpower.studies.ratings.findings import Findings, Row, size_notes, worst_breakers, worst_demand
from tractionpower.studies.ratings.use import Use, ruling
from tractionpower.studies.ratings.useful import lowest_useful
from tractionpower.studies.ratings.verdicts import ZONES, size_figures, size_verdicts
from tractionpower.studies.ratings.watch import RatingsWatch
from tractionpower.studies.runner.outcomes import rows_table
from tractionpower.studies.sizing_search.search import SizingFound


@dataclass(frozen=True, slots=True)
class Sized:
    """A study of ratings that has been made.

    Attributes
    ----------
    outcome
        How the run ended; ``outcome.run["size"]`` has the verdict.
    uses
        What every device carries over every window of its rating, and what is permitted.
    """

    outcome: Outcome
    uses: tuple[Use, ...]

    @property
    def verdict(self) -> str:
        """pass, fail or not rated."""
        return str(self.outcome.run["size"]["verdict"])

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """Warnings of the checks."""
        return self.outcome.warnings


class SizingRun:
    """A study of ratings in the making.

    Parameters
    ----------
    scenario
        What is looked at.
    writer
        Takes the tables of the run and those of the study.
    study
        Identifier of the study, for ``run.json``.

    Attributes
    ----------
    run
        The run.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """

    def __init__(self, scenario: Scenario, writer: Writer, *, study: str = "") -> None:
        self.scenario, self._writer = scenario, writer
        self.run = Run(scenario, writer, study)
        recorder = self.run.recorder
        self._ratings = RatingsWatch(scenario, self.run.compiled)
        self._voltages = UsefulVoltageRecorder(scenario, self.run.compiled.movement, recorder.trains.places)
        recorder.watches += [*self._ratings.watches, self._voltages]

    def execute(self, progress: Progress | None = None) -> Sized:
        """Run to the end of the clock, write the tables of the study, and judge."""
        outcome = self.run.execute(progress)
        found: dict[str, list[Row]] = {}
        for table, rows in self._ratings.tables(self.run.recorder.links.trips):
            found[table] = list(rows)
            if found[table]:
                self._writer.append(table, rows_table(table, found[table]))
        self._writer.append("useful_voltage", self._voltages.useful_voltage())
        self._writer.append("voltage_durations", self._voltages.voltage_durations())
        used, useful = self._ratings.uses(), lowest_useful(self._voltages)
        worst = worst_breakers(found["breakers"]), worst_demand(found["demand"])
        findings = Findings(ruling(used), *worst, useful, self._voltages.limit, self._ratings.recorder.loads.seconds)
        return Sized(self._judged(outcome, findings), used)

    def _judged(self, outcome: Outcome, found: Findings) -> Outcome:
        """Return the outcome of the run with what the study says."""
        # Verdicts of a run on zones count every train, however briefly it was there: here others take their place.
        kept = [verdict for verdict in outcome.run["verdicts"] if not verdict["name"].startswith(ZONES)]
        verdicts = [*kept, *size_verdicts(self.scenario, found)]
        said = {"kind": "size", "verdicts": verdicts, "size": size_notes(self.scenario, found)}
        figures = [*outcome.key_figures, *(figure.as_dict() for figure in size_figures(found))]
        return replace(outcome, run={**outcome.run, **said}, key_figures=figures)


def with_search(run: Mapping[str, Any], found: SizingFound) -> dict[str, Any]:
    """Return what ``run.json`` says of a study of ratings after a search for equipment."""
    return {**run, "size": {**run["size"], "search": found.notes()}}


def size(
    scenario: Scenario, folder: str | Path | None = None, *, force: bool = False, progress: Progress | None = None
) -> Results:
    """Rate every device of a supply in one run, and return the results of that run with the verdict.

    ``results.run["size"]`` has the verdict, tables ``ratings``, ``peaks``, ``breakers``, ``load_duration``, ``demand``,
    ``sharing``, ``useful_voltage`` and ``voltage_durations`` what it stands on.

    Parameters
    ----------
    scenario
        What to rate.
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
        sizing = SizingRun(scenario, writer, study=scenario.name)
        return lambda told: sizing.execute(told).outcome, sizing.run.keep_unfinished

    return computed(scenario, folder, prepare, kind="size", force=force, progress=progress)

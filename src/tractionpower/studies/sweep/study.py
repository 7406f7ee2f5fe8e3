"""A sweep: one scenario, many variants of its inputs, and what becomes of the key figures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tractionpower.cosimulation.check import check_scenario
from tractionpower.errors import Problem, UsageError, raise_errors
from tractionpower.io.library import shipped_library
from tractionpower.model.change import apply_changes, split_change
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Writer
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter, RunWriter
from tractionpower.results.versions import versions
from tractionpower.studies.cases.judgement import Check, checks_of, own_verdicts
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.envelope import Delays
from tractionpower.studies.runner.case import COMPLETE, FLAGGED, Case
from tractionpower.studies.runner.into_folder import run_into
from tractionpower.studies.runner.outcomes import CasesRun, rows_table, write_cases
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore
from tractionpower.studies.sweep.cases import BASE, as_cases, crossed, drawn, grid
from tractionpower.studies.sweep.cases_file import given_cases, read_cases
from tractionpower.studies.sweep.differences import differences, extremes
from tractionpower.studies.sweep.keys import Range, Varied, range_of, varied_of
from tractionpower.studies.sweep.trials import try_cases

_NO_LIMITS = ("supply.substations", "supply.section_cabins", "supply.feeders", "supply.contact_lines", "timetable.", "line.")
"""How paths begin that change no limit, so that the inputs of most cases need not be made once more to judge them."""

MEASURED = (COMPLETE, FLAGGED)
"""How a case ended that has figures."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What a sweep runs.

    Attributes
    ----------
    cases
        The base case, then the variants.
    sample
        Number of random draws; 0 without any.
    seed
        Seed of what is drawn.
    """

    cases: tuple[Case, ...]
    sample: int = 0
    seed: int = 1


def plan_sweep(
    scenario: Scenario,
    varied: Sequence[Varied] = (),
    given: tuple[Sequence[Mapping[str, str]], Sequence[str]] = ((), ()),
    ranges: Sequence[Range] = (),
    *,
    sample: int | None = None,
    seed: int | None = None,
) -> Plan:
    """Return the cases of a sweep: the grid of `varied`, the list `given` with its names, `sample` cases from `ranges`.

    Where several are told, every combination of them is a case. Nothing is run.

    Raises
    ------
    InputError
        If a path is varied in two ways.
    UsageError
        If there is nothing to vary, or only one of `sample` and `ranges` is told.
    """
    if (sample is None) != (not ranges):
        raise UsageError("a random sample needs both: --sample N and at least one --range KEY=LOW..HIGH")
    if sample is not None and sample < 1:
        raise UsageError(f"a sample of {sample}: allowed are whole numbers from 1")
    used = scenario.seed if seed is None else seed
    if used < 0:
        raise UsageError(f"seed {used}: allowed are whole numbers from 0")
    values, names = given
    combined, random = grid(varied) if varied else [], drawn(ranges, sample, used) if sample is not None else []
    if not (combined or values or random):
        told = "--vary KEY=V1,V2,..., --cases FILE.csv, or --sample N with --range KEY=LOW..HIGH"
        raise UsageError(f"there is nothing to vary: name {told}")
    is_list_alone = not combined and not random
    return Plan(as_cases(crossed(combined, values, random), names if is_list_alone else ()), sample or 0, used)


class SweepStudy:
    """A sweep in the making; what is wrong with its paths is told here, before anything runs.

    Parameters
    ----------
    scenario, plan
        The base and its variants.
    library
        Tables of equipment that changes may name; left out: those that ship.
    study
        Identifier of the study, for ``run.json``.

    Attributes
    ----------
    warnings
        What is to be said of the inputs.

    Raises
    ------
    InputError
        If the base has errors, a path does not exist, or all values of a path are refused.
    """

    def __init__(self, scenario: Scenario, plan: Plan, *, library: Library | None = None, study: str = "") -> None:
        problems = check_scenario(scenario)
        raise_errors(problems)
        self.scenario, self.plan, self.study = scenario, plan, study
        self._library = shipped_library() if library is None else library
        self.warnings: tuple[Problem, ...] = (*problems, *try_cases(scenario, self._library, plan.cases))

    def judged(self, rows: Iterable[Mapping[str, Any]]) -> Iterator[tuple[tuple[Check, ...], Mapping[str, Any]]]:
        """Yield the row of each case that has figures with what it is held against: the limits of its own inputs."""
        base, changes = checks_of(self.scenario), {case.id: case.changes for case in self.plan.cases}
        for row in rows:
            if row["status"] in MEASURED:
                own = changes[row["case"]]
                is_alike = all(split_change(change)[0].startswith(_NO_LIMITS) for change in own)
                yield base if is_alike else checks_of(apply_changes(self.scenario, own, self._library)), row

    def execute(self, writer: Writer, store: CaseStore, *, scheduler: str | None = None, **how: Any) -> SweepOutcome:
        """Run all cases and write the tables; parameters are those of `studies.runner.run.run_cases`.

        After Ctrl-C the tables have the cases that had ended, and the outcome says so.
        """
        done = run_cases(self.scenario, self._library, self.plan.cases, measure, store, scheduler=scheduler, **how)
        write_cases(done, writer, {"case_trains": Delays().add})
        base = next((row for row in done.rows if row["case"] == BASE), None)
        if base is not None and base["status"] in MEASURED:
            writer.append("differences", rows_table("differences", differences(done.rows, base)))
        return SweepOutcome(self, done, scheduler)


class SweepOutcome:
    """How a sweep ended.

    Attributes
    ----------
    cases
        All that was run.
    run
        What ``run.json`` holds, without the files.
    key_figures
        None: those of each case are in the tables.
    """

    key_figures: list[dict[str, Any]] = []  # noqa: RUF012 - never filled

    def __init__(self, study: SweepStudy, cases: CasesRun, scheduler: str | None) -> None:
        scenario, plan, self.cases = study.scenario, study.plan, cases
        self.run: dict[str, Any] = {
            "format": 1,
            "status": "interrupted" if cases.interrupted else "flagged" if self.flagged else COMPLETE,
            "study": study.study,
            "name": scenario.name,
            "kind": "sweep",
            "input_hash": scenario.input_hash,
            "seed": plan.seed,
            "versions": versions(),
            "wall_seconds": cases.wall_seconds,
            "workers": cases.workers,
            "scheduler": scheduler,
            "cases": cases.counts(),
            "verdicts": own_verdicts(study.judged(cases.rows)),
            "sweep": {
                "keys": _values_of(plan),
                "sample": {"count": plan.sample, "seed": plan.seed} if plan.sample else None,
                "extremes": extremes([row for row in cases.rows if row["status"] in MEASURED]),
            },
        }

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C came before all cases had ended."""
        return self.cases.interrupted

    @property
    def flagged(self) -> bool:
        """Whether a case is flagged or failed; one whose inputs the model refuses is a row with its reason."""
        return self.cases.count(FLAGGED) + self.cases.failed > 0

    @property
    def holds(self) -> bool:
        """Whether no limit is violated in any case."""
        return all(verdict["met"] for verdict in self.run["verdicts"])


def _values_of(plan: Plan) -> dict[str, list[str]]:
    """Return the values that each path takes, in the order in which they come."""
    keys: dict[str, dict[str, None]] = {}
    for path, value in (split_change(change) for case in plan.cases for change in case.changes):
        keys.setdefault(path, {})[value] = None
    return {path: list(values) for path, values in keys.items()}


def sweep(
    scenario: Scenario,
    vary: Mapping[str, Sequence[Any]] | None = None,
    *,
    cases: str | Path | Sequence[Mapping[str, Any]] | None = None,
    sample: int | None = None,
    ranges: Mapping[str, Any] | None = None,
    seed: int | None = None,
    folder: str | Path | None = None,
    **how: Any,
) -> Results:
    """Run variants of a scenario and return their key figures beside those of the base case.

    Parameters
    ----------
    scenario
        The base; it is the first case.
    vary
        Values by path: every combination of them is a case. ``{"supply.substations[A].units": [1, 2, 3]}``
    cases
        A list of cases: mappings from paths to values, with ``case`` for a name; or a CSV file of such.
    sample, ranges
        Number of cases with values drawn from ranges by path: ``(low, high)`` or ``(low, high, "log")``; whole numbers
        stay whole.
    seed
        Seed of the sample; left out: that of the scenario.
    folder
        Where to write the results; left out, they stay in memory.
    how
        ``workers``, ``scheduler`` and ``progress`` of `tractionpower.studies.runner.run.run_cases`; ``library``: tables of
        equipment that changes may name, left out those that ship; ``force``: write even where results of another study are.

    Raises
    ------
    InputError
        If the base has errors, a path does not exist, or all values of a path are refused.
    UsageError
        If there is nothing to vary.
    """
    library, force = how.pop("library", None), how.pop("force", False)
    given: tuple[list[dict[str, str]], list[str]]
    given = ([], []) if cases is None else read_cases(Path(cases)) if isinstance(cases, str | Path) else given_cases(cases)
    drawn_from = [range_of(path, bounds) for path, bounds in (ranges or {}).items()]
    plan = plan_sweep(scenario, varied_of(vary or {}), given, drawn_from, sample=sample, seed=seed)
    study = SweepStudy(scenario, plan, library=library, study=scenario.name)
    if folder is None:
        memory = MemoryWriter()
        outcome = study.execute(memory, CaseStore(), **how)
        if outcome.interrupted:
            raise KeyboardInterrupt
        return Results(outcome.run, [], memory.tables(), scenario)
    writer = RunWriter(Path(folder), scenario.name, scenario.input_hash, kind="sweep", force=force, scenario=scenario)
    if run_into(study, writer, **how).interrupted:
        raise KeyboardInterrupt
    return Results.open(folder)

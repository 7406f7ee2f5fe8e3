"""Before a sweep runs: which of its paths do not exist, which inputs it could not vary at all, what would change nothing."""

from __future__ import annotations

from collections.abc import Sequence

from tractionpower.errors import InputError, Problem
from tractionpower.model.change import apply_changes, split_change
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.studies.runner.case import Case
from tractionpower.supply.voltage_checks import check_units

_OF_PATHS = {"bad_change", "unknown_path", "ambiguous_path"}
"""Problems of a change that no value can mend."""

MOST_TOLD = 20
"""Refusals that are told where a path is refused with each of its values."""


def try_cases(base: Scenario, library: Library, cases: Sequence[Case]) -> list[Problem]:
    """Make the scenarios of cases, until every path has been accepted with one of its values; return warnings.

    Raises
    ------
    InputError
        With all paths that do not exist. Else, if a path is refused with each of its values, with what is said of them.
    """
    waiting = {path for case in cases for path in _paths(case)}
    wrong: dict[str, Problem] = {}
    refused: dict[str, list[Problem]] = {}
    warnings: dict[str, Problem] = {}
    units = set[str]()
    for case in cases:
        paths = _paths(case)
        of_units = {change for change in case.changes if split_change(change)[0].endswith(".units")} - units
        if not waiting.intersection(paths) and not of_units:
            continue
        units |= of_units
        try:
            changed = apply_changes(base, case.changes, library)
        except InputError as error:
            of_paths = [problem for problem in error.problems if problem.code in _OF_PATHS]
            wrong |= {problem.path: problem for problem in of_paths}
            waiting -= {problem.path for problem in of_paths}
            for path in paths:
                refused.setdefault(path, []).extend(error.problems)
            continue
        waiting -= set(paths)
        warnings |= {problem.path: problem for problem in check_units(changed.supply) if _is_varied(problem.path, paths)}
    if wrong:
        raise InputError(wrong.values())
    if waiting:
        told = {(problem.path, problem.found): problem for path in sorted(waiting) for problem in refused[path]}
        raise InputError(list(told.values())[:MOST_TOLD])
    return list(warnings.values())


def _paths(case: Case) -> list[str]:
    return [split_change(change)[0] for change in case.changes]


def _is_varied(path: str, paths: Sequence[str]) -> bool:
    """Return whether one of `paths` sets what is at `path`; ``[*]`` and an index stand for any item."""
    tail = path.rpartition(".")[2]
    return any(varied == path or (varied.endswith("." + tail) and "substations[" in varied) for varied in paths)

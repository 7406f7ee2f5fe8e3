"""Cases of train dynamics: a case file, or a configuration of Arshad et al., to what is computed; all problems at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tractionpower.errors import InputError, Problem
from tractionpower.io.arshad.own_words import IniProvenance
from tractionpower.io.arshad.reading import read_arshad
from tractionpower.io.case_finder import FoundCase, find_case, shipped_cases
from tractionpower.io.changes import Change, below, changed
from tractionpower.io.documents import Reader
from tractionpower.io.problems import Input, in_file_order
from tractionpower.io.provenance import Mark, Provenance
from tractionpower.io.rolling_stock import RollingStock
from tractionpower.io.text_files import Source
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.model.base import Declaration
from tractionpower.model.dynamics.case import Case, DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase

__all__ = ["LoadedCase", "find_case", "load_case", "read_case", "shipped_cases"]

KINDS: dict[str, type[Case] | type[StationsCase]] = {"vehicles": Case, "stations": StationsCase}
"""What a case file declares, by its ``kind``. One that is no train as many vehicles stands for itself."""

LEAST = (
    "docs/dynamics.md has a whole case to start from; the least one is"
    " {name: A wagon rolls, vehicles: [{id: wagon-zobory}], start: {speed_kmh: 50}, run: {duration_s: 60}}"
)
"""What helps where a case file is empty."""

ROOT = "case"
"""Model path of the content of a case file."""


@dataclass(frozen=True, slots=True)
class LoadedCase:
    """A case with the memory of where it came from.

    Attributes
    ----------
    scenario
        What is computed: a `DynamicsScenario`, or the declaration itself of a case with stations.
    provenance
        File and line of every model path.
    file
        The file that was named or found.
    name
        Name of its folder, or of the file without its ending.
    problems
        Warnings of the reading.
    origin
        Where it was found, in words.
    """

    scenario: DynamicsScenario | StationsCase
    provenance: Provenance
    file: Path
    name: str
    problems: tuple[Problem, ...] = ()
    origin: str = ""

    def changed(self, changes: Sequence[Change]) -> LoadedCase:
        """Return the case with changes by options; what is wrong with them later is told at the option.

        Raises
        ------
        InputError
            With all that is wrong with them now.
        """
        root = "" if isinstance(self.scenario, DynamicsScenario) else ROOT
        scenario = changed(self.scenario, changes, root=root)
        places = [(below(root, each.path), each.option) for each in changes]
        return replace(self, scenario=scenario, provenance=self.provenance.overlaid(places))


def load_case(case: str | Path) -> LoadedCase:
    """Read the case of train dynamics at a path, or the shipped one of that name.

    Raises
    ------
    InputError
        With all problems of all its files.
    UsageError
        If there is no such case.
    """
    loaded, problems = read_case(case)
    if loaded is None or any(problem.severity == "error" for problem in problems):
        raise InputError(problems)
    return loaded


def read_case(case: str | Path) -> tuple[LoadedCase | None, list[Problem]]:
    """Read a case and return it with all problems found; None instead of a case if there are errors.

    A configuration of Arshad et al. that has errors in its keys alone, unknown ones or some twice, comes with its case all the
    same, so that what else is wrong can be told in the same breath.

    Raises
    ------
    UsageError
        If there is no such case.
    """
    found = find_case(case)
    reader = Reader(found.file.parent)
    scenario, root = read_arshad(reader, found) if found.is_ini else _read_yaml(reader, found)
    problems = in_file_order(reader.problems)
    if scenario is None:
        return None, problems
    provenance = IniProvenance(root) if found.is_ini else Provenance(root)
    return LoadedCase(scenario, provenance, found.file, found.name, tuple(problems), found.origin), problems


def _read_yaml(reader: Reader, found: FoundCase) -> tuple[DynamicsScenario | StationsCase | None, Mark]:
    source = Source(found.file, found.file.name, ROOT)
    root = Mark(source.label)
    # The kind decides what the file declares; the glance's own problems are told by the reading that follows.
    glance = Reader(reader.folder).read(source, Declaration)
    if glance is None:
        reader.read(source, Case)
        reader.problems[:] = [_with_pattern(problem) for problem in reader.problems]
        return None, root
    kind = glance.data.get("kind", "vehicles")
    if not isinstance(kind, str) or kind not in KINDS:
        place = glance.mark.find(("kind",)).place
        remedy = did_you_mean(str(kind), KINDS)
        reader.problems.append(Problem("bad_choice", f"{ROOT}.kind", shown(kind), ", ".join(KINDS), remedy, place=place))
        return None, root
    content = reader.read(source, KINDS[kind])
    if content is None:
        return None, root
    root.children[ROOT] = content.mark
    if KINDS[kind] is StationsCase:
        stations = reader.validated(StationsCase, content)
        return None if reader.has_errors else stations, root
    return _resolved(reader, found, content, root), root


def _with_pattern(problem: Problem) -> Problem:
    """Return a problem of a case file; that it is empty is told with a case to start from."""
    return replace(problem, remedy=LEAST) if problem.code == "empty_file" else problem


def _resolved(reader: Reader, found: FoundCase, content: Input, root: Mark) -> DynamicsScenario | None:
    case = reader.validated(Case, content)
    # Also of a broken case the vehicles are read, so that their problems are told in the same breath.
    stock = RollingStock(reader, found.file.parent)
    stock.add_case(content)
    root.children |= {"vehicles": stock.vehicles.mark(), "couplings": stock.couplings.mark()}
    if case is None or reader.has_errors:
        return None
    return DynamicsScenario(case=case, vehicles=stock.vehicles.sorted(), couplings=stock.couplings.sorted())

"""How a command that computes a case of train dynamics begins: load, change, refuse."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tractionpower.cli.look import Look
from tractionpower.cli.messages import has_errors
from tractionpower.cli.options import set_option
from tractionpower.cli.study_call import Call

if TYPE_CHECKING:
    from tractionpower.errors import Problem
    from tractionpower.io.dynamics_files import LoadedCase

CaseName = Annotated[
    str, typer.Argument(metavar="CASE", help="Folder with a case.yaml, such a file, a .ini of Arshad et al., or a shipped case.")
]
ChangesOfCase = Annotated[list[str] | None, set_option(", e.g. case.start.speed_kmh=30 or vehicles[v43].mass_t=82")]


@dataclass(frozen=True, slots=True)
class CaseCall(Call):
    """A case of train dynamics for which a command was called."""

    loaded: LoadedCase

    @property
    def units(self) -> str:
        """Units that people are told figures in: metric, or imperial."""
        return self.scenario.case.units if self.kind == "dynamics" else "metric"


def call_case(
    case: str, changes: Sequence[str], out: Path | None, look: Look, run: Mapping[str, float | str | None] | None = None
) -> CaseCall:
    """Load a case and change it, also keys of its `run`; results go to `out`, or into ``reports/dynamics-<case>``.

    Raises
    ------
    InputError
        With all problems of its files, or of the changes.
    UsageError
        If there is no such case.
    """
    from tractionpower.errors import InputError
    from tractionpower.io.changes import Change, changes_of
    from tractionpower.io.dynamics_files import read_case
    from tractionpower.model.dynamics.case import DynamicsScenario

    loaded, problems = read_case(case)
    if loaded is None or has_errors(problems):
        raise InputError(problems if loaded is None else [*problems, *find_problems(loaded)])
    given = {name: str(value).removesuffix(".0") for name, value in (run or {}).items() if value is not None}
    options = [Change(f"case.run.{name}", value, f"--{name.replace('_', '-')}") for name, value in given.items()]
    every = [*changes_of(changes), *options]
    loaded = loaded.changed(every) if every else loaded
    look.check_own()
    kind = "dynamics" if isinstance(loaded.scenario, DynamicsScenario) else loaded.scenario.kind
    folder = out if out is not None else Path("reports") / f"dynamics-{loaded.name}"
    return CaseCall(loaded, loaded.scenario, loaded.name, folder, kind, look)


def find_problems(loaded: LoadedCase) -> list[Problem]:
    """Return what a case whose files could be read contradicts itself in, each with its file and line."""
    from tractionpower.dynamics.checks import check_case
    from tractionpower.dynamics.traindyn.station_checks import check_stations
    from tractionpower.model.dynamics.case import DynamicsScenario

    scenario = loaded.scenario
    found = check_case(scenario) if isinstance(scenario, DynamicsScenario) else check_stations(scenario)
    return loaded.provenance.place(found)

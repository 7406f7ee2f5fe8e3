"""How a command that computes a case of train dynamics begins: load, change, refuse."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import Look
from tractionpower.cli.options import set_option
from tractionpower.cli.study_call import Call

if TYPE_CHECKING:
    from tractionpower.io.dynamics_files import LoadedCase

CaseName = Annotated[
    str, typer.Argument(metavar="CASE", help="Folder with a case.yaml, such a file, a .ini of Arshad et al., or a shipped case.")
]
ChangesOfCase = Annotated[list[str] | None, set_option(", e.g. case.run.step_s=0.002 or couplings[arshad].slack_mm=20")]


@dataclass(frozen=True, slots=True)
class CaseCall(Call):
    """A case of train dynamics for which a command was called."""

    loaded: LoadedCase


def call_case(case: str, changes: Sequence[str], out: Path | None, look: Look, run: Mapping[str, Any] | None = None) -> CaseCall:
    """Load a case and change it, also keys of its `run`; results go to `out`, or into ``reports/dynamics-<case>``.

    Raises
    ------
    InputError
        With all problems of its files, or of the changes.
    UsageError
        If there is no such case.
    """
    from tractionpower.io.dynamics_files import load_case
    from tractionpower.model.change import apply_changes
    from tractionpower.model.dynamics.case import DynamicsScenario

    loaded = load_case(case)
    of_vehicles = isinstance(loaded.scenario, DynamicsScenario)
    where = "case.run" if of_vehicles else "run"
    every = [*changes, *(f"{where}.{name}={value}" for name, value in (run or {}).items() if value is not None)]
    scenario = apply_changes(loaded.scenario, every) if every else loaded.scenario
    look.check_own()
    kind = "dynamics" if of_vehicles else str(getattr(scenario, "kind", ""))
    folder = out if out is not None else Path("reports") / f"dynamics-{loaded.name}"
    return CaseCall(loaded, scenario, loaded.name, folder, kind, look)

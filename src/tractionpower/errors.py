"""What can go wrong, as objects: problems of the input and the exceptions that carry them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

Severity = Literal["error", "warning"]


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong with the input, told so that it can be mended.

    Attributes
    ----------
    code
        Stable word for programs, for example ``unknown_key`` or ``gap``.
    path
        Place in the model, for example ``line.gradients[7].to_km``; empty when no model place exists.
    found, allowed, remedy
        What stands there, what may stand there, what to do.
    severity
        An ``error`` stops a run, a ``warning`` does not.
    place
        File, and line where known, for example ``line.yaml:12``; filled in by `tractionpower.io`.
    """

    code: str
    path: str
    found: str
    allowed: str = ""
    remedy: str = ""
    severity: Severity = "error"
    place: str = ""

    def __str__(self) -> str:
        head = " ".join(part for part in (self.place, self.path) if part)
        parts = [f"{self.severity}: {head}: {self.found}" if head else f"{self.severity}: {self.found}"]
        if self.allowed:
            parts.append(f"allowed: {self.allowed}")
        if self.remedy:
            parts.append(self.remedy)
        return "; ".join(parts)


class TractionPowerError(Exception):
    """Base of all exceptions that this package raises on purpose."""


class InputError(TractionPowerError):
    """The input has errors; `problems` lists all of them, warnings included."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))


class UsageError(TractionPowerError):
    """The call itself is wrong: a folder of another study, an unknown study, a bad option."""


class OutputError(TractionPowerError):
    """Results cannot be written: no permission, a full disk, a file that another program holds."""


def raise_errors(problems: Sequence[Problem]) -> None:
    """Raise `InputError` with all of `problems` if one of them is an error; warnings alone pass."""
    if any(problem.severity == "error" for problem in problems):
        raise InputError(problems)

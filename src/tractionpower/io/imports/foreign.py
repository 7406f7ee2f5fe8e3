"""Files of other formats: read as declarations with line numbers, keys that mean nothing here told, units converted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError
from pydantic_core import PydanticCustomError

from tractionpower.errors import InputError, Problem
from tractionpower.io.documents import read_document
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import printable, shown
from tractionpower.model.base import Declaration, Real

Model = TypeVar("Model", bound=BaseModel)

Length = Literal["m", "km"]
Mass = Literal["kg", "t"]
Force = Literal["N", "kN"]
Power = Literal["W", "kW", "MW"]
Speed = Literal["m/s", "km/h"]
Acceleration = Literal["m/s^2"]
Share = Literal["-", "%"]
Slope = Literal["permil", "‰", "%", "-"]
Time = Literal["s", "min", "h"]
Area = Literal["m^2"]
ForcePerSpeed = Literal["N/(m/s)", "kN/(m/s)", "N/(km/h)", "kN/(km/h)"]
ForcePerSpeed2 = Literal["N/(m/s)^2", "kN/(m/s)^2", "N/(km/h)^2", "kN/(km/h)^2"]

FACTORS = {
    **{"-": 1.0, "%": 1e-2, "permil": 1e-3, "‰": 1e-3},
    **{"m": 1.0, "km": 1e3, "m^2": 1.0, "kg": 1.0, "t": 1e3, "s": 1.0, "min": 60.0, "h": 3600.0},
    **{"N": 1.0, "kN": 1e3, "W": 1.0, "kW": 1e3, "MW": 1e6, "m/s": 1.0, "km/h": 1.0 / 3.6, "m/s^2": 1.0},
    **{"N/(m/s)": 1.0, "kN/(m/s)": 1e3, "N/(km/h)": 3.6, "kN/(km/h)": 3.6e3},
    **{"N/(m/s)^2": 1.0, "kN/(m/s)^2": 1e3, "N/(km/h)^2": 3.6**2, "kN/(km/h)^2": 3.6**2 * 1e3},
}
"""What one of a unit is in SI."""

DIGITS = 10
"""Significant digits of converted numbers; what lies beyond is rounding."""


def converted(value: float, unit: str, to: str) -> float:
    """Return `value` given in `unit` in the unit `to`, of the same kind.

    >>> converted(413.6, "m", "km"), converted(0.5, "kN/(km/h)", "N/(km/h)"), converted(10.0, "m/s", "km/h")
    (0.4136, 500.0, 36.0)
    """
    return tidy(value * FACTORS[unit] / FACTORS[to])


def tidy(value: float) -> float:
    """Return `value` without what lies beyond `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}")


class Foreign(Declaration):
    """A mapping of another format: keys that are not known here are kept, to be told as ignored."""

    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False, populate_by_name=True)


def unknown_keys(model: BaseModel, at: str = "") -> Iterator[str]:
    """Yield the places of all keys that a `Foreign` holds without knowing them; equal ones in rows of a list once."""
    told: dict[str, None] = {}
    for place in _unknown(model, at):
        told[place] = None
    yield from told


def _unknown(value: Any, at: str) -> Iterator[str]:
    if isinstance(value, BaseModel):
        yield from (f"{at}.{key}".removeprefix(".") for key in value.model_extra or ())
        for name, info in type(value).model_fields.items():
            yield from _unknown(getattr(value, name), f"{at}.{info.alias or name}".removeprefix("."))
    elif isinstance(value, tuple):
        for item in value:
            yield from _unknown(item, at)


def read_foreign(path: Path, model: type[Model], notes: Notes) -> Model | None:
    """Return the file as `model`, or None if it has errors: all of them are then in `notes`."""
    try:
        return read_document(path, model)
    except InputError as error:
        notes.problems += error.problems
        return None


def built(model: type[Model], data: dict[str, Any], notes: Notes, place: str) -> Model | None:
    """Return a declaration of the study made of `data`, or None with problems where the source holds what may not be."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        for fault in error.errors(include_url=False):
            path = ".".join(str(token) for token in fault["loc"])
            remedy = "mend the source: no study may hold this"
            notes.problems.append(Problem("not_allowed", path, shown(fault["input"]), fault["msg"], remedy, place=place))
        return None


def numbers(*names: str) -> BeforeValidator:
    """Return a validator of a row of numbers with these names, told as one where it is something else."""

    def check(value: Any) -> Any:
        numeric = isinstance(value, list | tuple) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in value)
        if not numeric or len(value) != len(names):
            text = "{found} is no row of {count} numbers: {names}"
            told = {"found": shown(value), "count": len(names), "names": ", ".join(names)}
            raise PydanticCustomError("bad_row", text, told)
        return value

    return BeforeValidator(check)


Pair = tuple[Real, Real]
Triple = tuple[Real, Real, Real]


def rising(rows: Sequence[tuple[Any, ...]], path: str, notes: Notes, *, repair: bool, place: str) -> list[tuple[Any, ...]]:
    """Return rows by rising position, their first number; others are a problem, or with `repair` put in order.

    Of rows at the same place the last holds, as it would if the one before had a length of zero.
    """
    wrong = [k for k in range(1, len(rows)) if not rows[k - 1][0] < rows[k][0]]
    if wrong and repair:
        notes.repaired.append(f"{path}: {len(wrong)} rows not in order put in order; of those at one place the last is kept")
    elif wrong:
        for k in wrong:
            found = f"{rows[k][0]:.10g} behind {rows[k - 1][0]:.10g}"
            remedy = "put the rows in order, or import with repair"
            notes.problems.append(Problem("not_rising", f"{path}[{k}]", found, "rising positions", remedy, place=place))
    in_order = sorted(rows, key=lambda row: float(row[0]))
    return list({row[0]: row for row in in_order}.values())


def find_file(source: Path, suffixes: tuple[str, ...], notes: Notes) -> bool:
    """Return whether `source` is a file that can be read; tell what is wrong if it is not."""
    if source.is_file():
        return True
    known = sorted(path for path in source.rglob("*") if path.suffix in suffixes) if source.is_dir() else []
    found = "a folder" if source.is_dir() else "no such file"
    allowed = ", ".join(path.relative_to(source).as_posix() for path in known[:20])
    notes.problems.append(Problem("no_file", "", found, allowed, "name one file", place=printable(str(source))))
    return False

"""What all declarations share: frozen models, strict numbers, identifiers, times of day."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, PlainSerializer, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

FORMAT = 1
"""Version of the input files and results that this program reads and writes."""

DAY_S = 86_400.0
"""Length of a day [s]."""

Format = Annotated[Literal[1], Field(description="Version of the file format.")]


class Declaration(BaseModel):
    """A frozen declaration; unknown keys are errors and no value is converted silently."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, populate_by_name=True)

    @model_validator(mode="after")
    def _has_one_zero(self) -> Self:
        # -0.0 == 0.0, so a field with that default is left out on saving; but as JSON they differ, and so would the hashes.
        # Here and not in `Real`: pydantic would forget the bounds of optional fields in the JSON schema.
        values = self.__dict__
        for name, value in values.items():
            if value == 0.0 and type(value) is float:
                values[name] = 0.0
            elif type(value) is tuple and value and type(value[0]) is float:
                values[name] = tuple(item + 0.0 for item in value)
            elif type(value) is dict:
                values[name] = {key: item + 0.0 if type(item) is float else item for key, item in value.items()}
        return self


def _identifier(value: Any) -> Any:
    # YAML reads `track: 1` as a number; nobody means the number.
    if isinstance(value, int) and not isinstance(value, bool):
        return str(value)
    if isinstance(value, str):
        if not value.strip() or value != value.strip() or len(value) > 300 or re.search(r"[\[\]\x00-\x1f]", value):
            raise PydanticCustomError("identifier", "an identifier has 1 to 300 characters, no brackets, no blanks at its ends")
        return value
    raise PydanticCustomError("identifier", "an identifier is a text or a whole number")


_DECIMALS = 6  # times are kept to the microsecond, so that what is written reads back as the same number
_TIME = re.compile(r"(\d{1,3}):([0-5]\d)(?::([0-5]\d(?:\.\d+)?))?")


def parse_time(text: str) -> float | None:
    """Return seconds after midnight of ``HH:MM`` or ``HH:MM:SS``, or None if `text` is neither.

    >>> parse_time("25:00:30")
    90030.0
    """
    match = _TIME.fullmatch(text.strip())
    if match is None:
        return None
    hours, minutes, seconds = match.groups()
    return round(int(hours) * 3600.0 + int(minutes) * 60.0 + float(seconds or 0.0), _DECIMALS)


def format_time(seconds: float) -> str:
    """Return seconds after midnight as ``HH:MM:SS``, with a fraction only where there is one, and a sign before midnight.

    >>> format_time(90030.0)
    '25:00:30'
    """
    if round(seconds * 10**_DECIMALS) < 0:
        return f"-{format_time(-seconds)}"
    whole, fraction = divmod(round(seconds * 10**_DECIMALS), 10**_DECIMALS)
    text = f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}"
    return f"{text}.{fraction:0{_DECIMALS}d}".rstrip("0") if fraction else text


def _time(value: Any) -> Any:
    if isinstance(value, str):
        seconds = parse_time(value)
        if seconds is not None:
            return seconds
    elif isinstance(value, float) and 0.0 <= value < 3.6e6:  # already seconds: a model built in Python
        return round(value, _DECIMALS)
    raise PydanticCustomError("time_of_day", "a time is HH:MM or HH:MM:SS, beyond 24:00:00 for the next day")


Real = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Count = Annotated[int, Field(strict=True)]
Identifier = Annotated[str, BeforeValidator(_identifier), WithJsonSchema({"type": ["string", "integer"]})]
Text = Annotated[str, Field(strict=True, max_length=20_000)]
TimeOfDay = Annotated[
    float,
    BeforeValidator(_time),
    PlainSerializer(format_time, return_type=str),
    WithJsonSchema({"type": "string", "pattern": r"^\d{1,3}:[0-5]\d(:[0-5]\d(\.\d+)?)?$"}),
]
"""Time of day: HH:MM[:SS] in files, seconds after midnight in Python."""


def _tracks(value: Any) -> Any:
    # In a CSV cell several tracks are separated by blanks; in YAML one track may stand without brackets.
    if isinstance(value, str):
        return value.split()
    if isinstance(value, int) and not isinstance(value, bool):
        return [value]
    return value


Tracks = Annotated[tuple[Identifier, ...], BeforeValidator(_tracks)]

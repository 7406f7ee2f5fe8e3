"""Inputs as declared: which fields they have, what these mean, and which of them are as the program takes them by default."""

from __future__ import annotations

import math
import types
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from tractionpower.model.quantity import REQUIRED, Quantity
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.frame.page import heading_of

GIVEN, DEFAULT, LEFT_OUT = mark("given"), mark("default"), mark("left out")

MOST_IN_CELL = 12
"""Rows that a cell shows of a list within a row, such as the profile of a load."""

DIGITS = 9
"""Decimals of a number within a text, zeros at its end left out."""

_NOT_TOLD = ("format",)

_OWN_WORDS = {"turns": {"left": mark("to the left"), "right": mark("to the right")}}
"""Words of fields that mean something else elsewhere: a train that has left the line."""

_OWN_NAMES = {"level": mark("control level")}
"""Names of fields that mean something else elsewhere: level track."""


@dataclass(frozen=True, slots=True)
class Declared:
    """A field of a declaration with its value.

    Attributes
    ----------
    name
        As it stands in files.
    value
        What it has; a time of day is a text.
    default
        What it has where a file leaves it out; `REQUIRED` where a file must not.
    meaning, source
        What it means, and where the default comes from.
    words
        What it may be, where it is one of a few words of the program.
    """

    name: str
    value: Any
    default: Any
    meaning: str
    source: str
    words: frozenset[str]

    @property
    def is_default(self) -> bool:
        """Whether the value is that of a file that leaves it out."""
        return self.default is not REQUIRED and bool(self.value == self.default)

    @property
    def known(self) -> str:
        """How the value is known, in a word: given, default, left out."""
        return LEFT_OUT if self.value is None else DEFAULT if self.is_default else GIVEN

    @property
    def shown(self) -> Any:
        """What a cell shows: a number as it is, all else in words."""
        own = _OWN_WORDS.get(self.name, {})
        if isinstance(self.value, str) and self.value in own:
            return tr(own[self.value])
        return readable(self.name, self.value) if _is_number(self.value) else in_words(self.value, self.words)


def declared(part: BaseModel) -> list[Declared]:
    """Return the fields of a declaration with their values, in their order."""
    written = part.model_dump(mode="json", by_alias=False)
    found = []
    for attribute, (name, default, meaning, source, words) in _fields(type(part)).items():
        value, text = getattr(part, attribute), written[attribute]
        usual = default
        if isinstance(value, float) and isinstance(text, str):  # a time of day
            value, usual = text, _as_written(part, attribute, default)
        found.append(Declared(name, value, usual, meaning, source, words))
    return found


def readable(name: str, value: Any) -> Any:
    """Return a number without digits that come from converting units alone; all else as it is.

    Seven digits are kept and the third decimal at least, of kilometres and degrees the sixth.

    >>> readable("from_m", 820.4000000000001), readable("radius_m", 1746.397525437186), readable("km", 12.3456781)
    (820.4, 1746.398, 12.345678)
    """
    if not isinstance(value, float) or not math.isfinite(value) or value == 0.0:
        return value
    least = 6 if name == "km" or name.endswith(("_km", "_deg")) else 3
    return round(value, max(least, 6 - math.floor(math.log10(abs(value)))))


def flat(part: BaseModel, before: str = "") -> Iterator[tuple[str, Declared]]:
    """Yield heading and field of a declaration and of its inner parts, these with the name of the part before theirs."""
    for field in declared(part):
        if isinstance(field.value, BaseModel):
            yield from flat(field.value, f"{before}{words_of(field.name)}: ")
        else:
            yield f"{before}{heading_of(field.name)}", field


def words_of(name: str) -> str:
    """Return the name of a field or list for people, in the language of the report."""
    return tr(_OWN_NAMES[name]) if name in _OWN_NAMES else recorded(Quantity(name, "").words)


def in_words(value: Any, words: frozenset[str] = frozenset()) -> Any:
    """Return what stands in a cell for a value of a declaration: lists and parts in one line.

    `words` are those of the program that it may be; other texts are the user's and stay as they are.
    """
    if isinstance(value, BaseModel):
        parts = [field for field in declared(value) if field.value is not None and field.value != ""]
        told: Any = ", ".join(map(_part_in_words, parts))
    elif isinstance(value, dict):
        told = "; ".join(f"{key}: {in_words(part)}" for key, part in value.items())
    elif isinstance(value, tuple | list):
        told = _list_in_words(value, words)
    elif isinstance(value, bool):
        told = tr("yes") if value else tr("no")
    elif isinstance(value, float):
        told = number(value, DIGITS) if abs(value) < 1e12 else f"{value:g}"
    else:
        told = recorded(value.replace("_", " ")) if isinstance(value, str) and value in words else value
    return told


def _part_in_words(field: Declared) -> str:
    """Return name, value and unit of a field in a sentence."""
    unit = Quantity(field.name, "").unit if _is_number(field.value) and words_of(field.name) != field.name else ""
    value = in_words(field.value, field.words) if _is_number(field.value) else field.shown
    return f"{words_of(field.name)} {value} {unit}".strip()


def _list_in_words(values: Sequence[Any], words: frozenset[str]) -> str:
    of_parts = len(values) > 0 and isinstance(values[0], BaseModel)
    if of_parts and len(values) > MOST_IN_CELL:
        return tr("{count} rows, from {first} to {last}", count=len(values), first=in_words(values[0]), last=in_words(values[-1]))
    return ("; " if of_parts else ", ").join(str(in_words(each, words)) for each in values)


def choices(annotation: Any) -> frozenset[str]:
    """Return the words of the program that a field of this annotation may hold."""
    if get_origin(annotation) is Literal:
        return frozenset(each for each in get_args(annotation) if isinstance(each, str))
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return frozenset()
    found: frozenset[str] = frozenset()
    for part in get_args(annotation):
        found |= choices(part)
    return found


def parts_of(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the declarations that a field of this annotation may hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    elif get_origin(annotation) in (Union, types.UnionType) or get_args(annotation):
        for part in get_args(annotation):
            yield from parts_of(part)


@lru_cache(maxsize=200)
def _fields(kind: type[BaseModel]) -> dict[str, tuple[str, Any, str, str, frozenset[str]]]:
    """Return name, default, meaning, source of the default and possible words of each field, by attribute."""
    return {
        attribute: (info.alias or attribute, _default(info), info.description or "", _source(info), choices(info.annotation))
        for attribute, info in kind.model_fields.items()
        if attribute not in _NOT_TOLD
    }


def _default(info: FieldInfo) -> Any:
    return REQUIRED if info.is_required() else info.get_default(call_default_factory=True)


def _source(info: FieldInfo) -> str:
    extra = info.json_schema_extra
    return str(extra.get("source", "")) if isinstance(extra, dict) else ""


def _as_written(part: BaseModel, attribute: str, default: Any) -> Any:
    if default is REQUIRED or default is None:
        return default
    return part.model_copy(update={attribute: default}).model_dump(mode="json")[attribute]


def _is_number(value: Any) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool)

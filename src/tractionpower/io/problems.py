"""Errors of the declarations in our own words: one clear problem each, with path, place, found and allowed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tractionpower.errors import Problem
from tractionpower.io.provenance import Loc, Mark, path_of
from tractionpower.io.shapes import Shape
from tractionpower.io.wording import did_you_mean, nearest, shorten, shown
from tractionpower.model.base import FORMAT


@dataclass(frozen=True, slots=True)
class Input:
    """A file's content with what is needed to talk about it.

    Attributes
    ----------
    root
        Model path of the content.
    data, mark
        Values and their lines.
    shape
        What is declared.
    file
        The file itself.
    silent
        Places that already have a problem; further errors there say nothing new.
    """

    root: str
    data: Any
    mark: Mark
    shape: Shape
    file: Path
    silent: set[Loc] = field(default_factory=set)


@dataclass(frozen=True, slots=True)
class _Fault:
    # One entry of ValidationError.errors() with its surroundings.
    code: str
    loc: Loc
    value: Any
    message: str
    shape: Shape | None
    parent: Shape | None

    @property
    def key(self) -> str:
        return str(self.loc[-1]) if self.loc else ""

    @property
    def meant(self) -> str:
        # The known key that this unknown one resembles: that it is missing need not be told as well.
        return nearest(self.key, self.parent.keys if self.parent is not None else ())

    @property
    def allowed(self) -> str:
        return self.shape.allowed() if self.shape is not None else ""


Told = tuple[str, str, str, str]
"""Code, found, allowed, remedy."""


def problems_of(error: ValidationError, content: Input) -> list[Problem]:
    """Return what the declaration raised for the data of `content` as problems, in the order of the file."""
    faults = [_fault(entry, content.shape) for entry in error.errors(include_url=False)]
    misspelt = {(*fault.loc[:-1], fault.meant) for fault in faults if fault.code == "extra_forbidden"}
    deeper = {fault.loc[:depth] for fault in faults for depth in range(len(fault.loc))}
    around = {loc[:depth] for loc in content.silent for depth in range(len(loc))}

    def is_news(fault: _Fault) -> bool:
        if fault.loc in content.silent or (fault.code == "missing" and fault.loc in misspelt):
            return False
        if fault.code == "too_short" and fault.loc in deeper:  # the rows are there, but wrong
            return False
        # A rule over several keys cannot be judged while one of them failed to be read.
        return fault.code in _TELLERS or fault.loc not in around

    return [_problem(fault, content) for fault in faults if is_news(fault)]


def _fault(entry: Any, shape: Shape) -> _Fault:
    tagged: Loc = tuple(token for token in entry["loc"] if token != "[key]")
    code, value = entry["type"], entry["input"]
    if code in _TAG_ERRORS:  # told at the key that is wrong or missing, not at the mapping around it
        key = str(entry["ctx"]["discriminator"]).strip("'")
        tagged, code = (*tagged, key), _TAG_ERRORS[code]
        value = value.get(key) if isinstance(value, dict) else value
    parent = shape.find(tagged[:-1]) if tagged else None
    return _Fault(code, shape.untagged(tagged), value, entry["msg"], shape.find(tagged), parent)


def in_file_order(problems: Iterable[Problem]) -> list[Problem]:
    """Return `problems` by file, in the order in which files appear, and by line within a file."""
    files: dict[str, int] = {}

    def key(problem: Problem) -> tuple[int, int]:
        file, _, line = problem.place.rpartition(":")
        number = int(line) if line.isdecimal() else 0
        return files.setdefault(file if number else problem.place, len(files)), number

    return sorted(problems, key=key)


def format_problem(content: Input) -> Problem | None:
    """Return the one problem of a file whose ``format`` is newer than this program, or None."""
    number = content.data.get("format", FORMAT)
    if isinstance(number, bool) or not isinstance(number, int | float) or number <= FORMAT:
        return None
    return Problem(
        "newer_format",
        f"{content.root}.format".removeprefix("."),
        f"format {shown(number)}",
        f"format {FORMAT}, which this program reads",
        "a newer tractionpower is needed",
        place=content.mark.find(("format",)).place,
    )


def _problem(fault: _Fault, content: Input) -> Problem:
    code, found, allowed, remedy = _TELLERS.get(fault.code, _tell_custom)(fault)
    mark = content.mark.find(fault.loc)
    if mark.is_row and fault.loc and isinstance(fault.loc[-1], str):
        column = ".".join(str(token) for token in fault.loc[_row_depth(fault.loc) :])
        found = f"{'nothing' if code == 'missing_key' else found} in column {shorten(column)}"
    path = path_of(content.root, fault.loc, content.data)
    return Problem(code, path, found, allowed, remedy, place=mark.place)


def _row_depth(loc: Loc) -> int:
    # A row may name a table of its own; the last number is that of the row with the cell.
    return max(index for index, token in enumerate(loc) if isinstance(token, int)) + 1


def _tell_unknown(fault: _Fault) -> Told:
    known = fault.parent.keys if fault.parent is not None else ()
    return "unknown_key", f"the key {shown(fault.key)}", ", ".join(known), did_you_mean(fault.key, known)


def _tell_missing(fault: _Fault) -> Told:
    meaning = fault.shape.meaning if fault.shape is not None else ""
    return "missing_key", f"no {fault.key}", fault.allowed, f"add {fault.key}" + (f": {meaning}" if meaning else "")


def _tell_type(fault: _Fault) -> Told:
    remedy = ""
    kind = fault.shape.kind if fault.shape is not None else "other"
    if kind in ("rows", "list", "names") and fault.value is None:
        remedy = f"write {fault.key}: [] for none, or leave {fault.key} out"
    elif kind == "text" and isinstance(fault.value, int | float):
        remedy = "put it in quotes"
    elif kind in ("number", "integer", "boolean") and str(fault.value).startswith("="):
        remedy = "formulas are not computed: write the value"
    elif kind in ("number", "integer") and isinstance(fault.value, str) and "," in fault.value:
        remedy = "write the decimals with a point"
    elif kind == "boolean" and str(fault.value).lower() in ("yes", "no", "y", "n", "on", "off", "0", "1"):
        remedy = "write true or false: in YAML 1.2 yes and no are texts"
    return "wrong_type", shown(fault.value), fault.allowed, remedy


def _tell_bounds(fault: _Fault) -> Told:
    return "out_of_bounds", shown(fault.value), fault.allowed, ""


def _tell_not_finite(fault: _Fault) -> Told:
    return "not_finite", shown(fault.value), f"{fault.allowed}, finite", ""


def _tell_choice(fault: _Fault) -> Told:
    choices = fault.shape.choices if fault.shape is not None else ()
    return "bad_choice", shown(fault.value), fault.allowed, did_you_mean(str(fault.value), map(str, choices))


def _tell_time(fault: _Fault) -> Told:
    return "bad_time", shown(fault.value), fault.allowed, ""


def _tell_identifier(fault: _Fault) -> Told:
    return (
        "bad_identifier",
        shown(fault.value),
        fault.message.removeprefix("an identifier has ").removeprefix("an identifier is "),
        "",
    )


def _tell_short(fault: _Fault) -> Told:
    least = int(fault.shape.schema.get("minItems", 1)) if fault.shape is not None else 1
    rows = "one row" if least == 1 else f"{least} rows"
    return "too_short" if fault.value else "empty_list", shown(fault.value), f"a list with at least {rows}", ""


def _tell_long(fault: _Fault) -> Told:
    return "too_long", shown(fault.value), fault.message, ""


def _tell_custom(fault: _Fault) -> Told:
    # The declarations word their own rules: start before end, power or current.
    return fault.code, shorten(fault.message, 200), "", ""


_TAG_ERRORS = {"union_tag_invalid": "literal_error", "union_tag_not_found": "missing"}
_TYPE_ERRORS = (
    "float_type", "float_parsing", "int_type", "int_from_float", "int_parsing", "int_parsing_size", "bool_type",
    "string_type", "string_unicode", "tuple_type", "list_type", "dict_type", "model_type", "model_attributes_type",
)  # fmt: skip
_TELLERS: dict[str, Callable[[_Fault], Told]] = {
    "extra_forbidden": _tell_unknown,
    "missing": _tell_missing,
    "finite_number": _tell_not_finite,
    "literal_error": _tell_choice,
    "time_of_day": _tell_time,
    "identifier": _tell_identifier,
    "too_short": _tell_short,
    "too_long": _tell_long,
    "string_too_long": _tell_long,
    **dict.fromkeys(("greater_than", "greater_than_equal", "less_than", "less_than_equal"), _tell_bounds),
    **dict.fromkeys(_TYPE_ERRORS, _tell_type),
}

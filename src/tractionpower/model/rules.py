"""The rules of declarations once more: for those that were built in Python past their own validation."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ValidationError

from tractionpower.errors import Problem
from tractionpower.model.base import Declaration
from tractionpower.model.change import model_path


def broken_rules(declaration: Declaration, parts: tuple[str, ...]) -> list[Problem]:
    """Return what the model refuses in `parts` of a declaration.

    What is loaded or changed by path was validated; ``model_copy(update=...)`` and ``model_construct`` validate nothing.
    """
    plain = _plain(declaration)
    try:
        valid = type(declaration).model_validate(plain)
    except ValidationError as error:
        return [
            Problem("bad_value", model_path(plain, detail["loc"]), _found(detail["input"], detail["msg"]))
            for detail in error.errors(include_url=False)
            if detail["loc"][:1] in {(part,) for part in parts}
        ]
    remedy = "build it with model_validate, or change it by path"
    return [
        Problem("bad_value", part, "it was not validated, and holds values of other types than declared", remedy=remedy)
        for part in parts
        if getattr(valid, part) != getattr(declaration, part)
    ]


def _plain(value: Any) -> Any:
    """Return declarations as mappings of their fields; a dump would stumble over what is not as declared."""
    if isinstance(value, BaseModel):
        fields = type(value).model_fields
        return {(fields[name].alias or name) if name in fields else name: _plain(item) for name, item in value.__dict__.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return value


def _found(given: Any, message: str) -> str:
    return message if isinstance(given, dict | list | tuple) else f"{given!r}: {message}"

"""Changes of inputs by options of a command: refused in the words that files are refused with, told at the option."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from tractionpower.errors import InputError, Problem
from tractionpower.io.problems import Input, problems_of
from tractionpower.io.provenance import Mark, split_path
from tractionpower.io.shapes import shape_of
from tractionpower.model.base import Declaration
from tractionpower.model.change import changed_data, split_change
from tractionpower.model.library import Library

Changed = TypeVar("Changed", bound=Declaration)


@dataclass(frozen=True, slots=True)
class Change:
    """A change of an input.

    Attributes
    ----------
    path
        Model path of what is changed.
    value
        Its new value, as it is written.
    option
        The option that asks for it, as messages call it.
    """

    path: str
    value: str
    option: str


def changes_of(texts: Iterable[str], option: str = "--set") -> list[Change]:
    """Return the changes ``PATH=VALUE`` that an option asks for.

    >>> changes_of(["case.run.step_s=0.01"])
    [Change(path='case.run.step_s', value='0.01', option='--set')]

    Raises
    ------
    InputError
        With all that are none.
    """
    changes, problems = [], []
    for text in texts:
        try:
            changes.append(Change(*split_change(text), option))
        except InputError as error:
            problems += [replace(problem, place=option) for problem in error.problems]
    if problems:
        raise InputError(problems)
    return changes


def changed(scenario: Changed, changes: Iterable[Change], library: Library | None = None, root: str = "") -> Changed:
    """Return a scenario with `changes`; see `model.change.apply_changes`.

    Parameters
    ----------
    scenario
        What is changed.
    changes
        The changes, in their order.
    library
        Rows that changes may name.
    root
        Model path of the scenario itself; changes may be given with it, or without.

    Raises
    ------
    InputError
        With all wrong paths, or else all wrong values, each at its option.
    """
    changes = list(changes)
    texts = [f"{each.path.removeprefix(f'{root}.') if root else each.path}={each.value}" for each in changes]
    try:
        data = changed_data(scenario, texts, library)
    except InputError as error:
        raise InputError(_placed(error.problems, changes, root)) from None
    try:
        return type(scenario).model_validate(data)
    except ValidationError as error:
        content = Input(root, data, Mark(""), shape_of(type(scenario)), Path())
        raise InputError(_placed(problems_of(error, content), changes, root)) from None


def _placed(problems: Iterable[Problem], changes: Iterable[Change], root: str) -> list[Problem]:
    by_place = {tuple(split_path(each.path.removeprefix(f"{root}.") if root else each.path)): each.option for each in changes}
    return [replace(problem, path=below(root, problem.path), place=_option(problem.path, by_place, root)) for problem in problems]


def below(root: str, path: str) -> str:
    """Return a path that is given with the `root` of the model, or without, with it."""
    return path if not root or path.split(".", maxsplit=1)[0] == root else f"{root}.{path}"


def _option(path: str, options: dict[tuple[str, ...], str], root: str) -> str:
    # The option that set this very place, or one around it; else one that set something in it; else the last one.
    tokens = tuple(split_path(path.removeprefix(f"{root}.") if root else path))
    around = [option for place, option in options.items() if tokens[: len(place)] == place]
    inside = [option for place, option in options.items() if place[: len(tokens)] == tokens]
    return (around or inside or list(options.values()))[-1]

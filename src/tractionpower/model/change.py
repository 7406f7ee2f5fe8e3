"""Changes by path: a study is a base and changes such as ``supply.substations[A].internal_resistance_ohm=0.2``.

The same text serves ``--set``, sweeps, outages and sizing. A change works on the plain form of a scenario, and the
model validates the result again, so that a changed scenario obeys every rule that a loaded one obeys.
"""

from __future__ import annotations

import copy
import difflib
import json
import re
from collections.abc import Iterable, Sequence
from typing import Any, TypeVar

from pydantic import ValidationError

from tractionpower.errors import InputError, Problem
from tractionpower.model.base import Declaration
from tractionpower.model.library import KEYS, Library
from tractionpower.model.scenario import Scenario

# An identifier in brackets may hold dots and equals signs, so the first "=" outside brackets ends the path.
_CHANGE = re.compile(r"(?P<path>(?:[^=\[\]]|\[[^\[\]]*\])+)=(?P<value>.*)", re.DOTALL)
_STEP = re.compile(r"(?:^|\.)(?P<name>[^.\[\]]+)|\[(?P<key>[^\[\]]+)\]")
_WORDS = {"null": None, "~": None, "true": True, "false": False}
_INTEGER = re.compile(r"[-+]?\d+")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SHOWN = 12
_MOST_MEANT = 2

Changed = TypeVar("Changed", bound=Declaration)

ALL, ADDED = "[*]", "[+]"
"""Steps of a path: every item of a list, one more item."""


def apply_change(scenario: Scenario, change: str) -> Scenario:
    """Return `scenario` with one value changed.

    Parameters
    ----------
    scenario
        The base; it stays as it is.
    change
        ``PATH=VALUE``, for example ``supply.section_cabins[C].state=bypassed``. Items of a list are addressed by their
        ``id``, or by a zero-based index where they have none or no id is a number (``trains[ic].vehicles[0].count=2``).
        ``[*]`` means all items of a list, ``[+]`` adds one: ``supply.feeders[+]={"at": "A", "track": "1", ...}``.
        The value is read as in YAML: a number, ``true``, ``false``, ``null`` (clears an optional value) or a text; a
        text in quotes stays a text. In braces or brackets it is JSON: ``timetable.driving={"kind": "to_time"}``.

    Raises
    ------
    InputError
        If the path does not exist or the model refuses the value.
    """
    return apply_changes(scenario, [change])


def apply_changes(scenario: Changed, changes: Iterable[str], library: Library | None = None) -> Changed:
    """Return `scenario`, or a case of train dynamics, with all `changes` applied in their order and validated once at the end.

    Changes that only hold together, such as taking `power_kw` from a load and giving it `current_a`, go in one call.
    See `apply_change` for their form. A scenario holds the conductors, duty classes and rectifier units that its supply
    uses; `library` has further ones that changes may name.

    Raises
    ------
    InputError
        With all wrong paths, or else with all complaints of the model.
    """
    plain = changed_data(scenario, changes, library)
    try:
        return type(scenario).model_validate(plain)
    except ValidationError as error:
        raise InputError(_complaints(plain, error)) from error


def changed_data(scenario: Declaration, changes: Iterable[str], library: Library | None = None) -> dict[str, Any]:
    """Return `scenario` as plain data with all `changes` applied, not validated; see `apply_changes`.

    Raises
    ------
    InputError
        With all wrong paths.
    """
    plain: dict[str, Any] = _thaw(scenario.model_dump(by_alias=True, mode="python"))
    problems: list[Problem] = []
    for change in changes:
        try:
            _change(plain, change)
        except InputError as error:
            problems.extend(error.problems)
    if problems:
        raise InputError(problems)
    if library is not None:
        _add_rows(plain, library)
    return plain


def _add_rows(plain: dict[str, Any], library: Library) -> None:
    """Add the rows of the tables that are not in `plain` yet; the model keeps those that are used."""
    for name, keys in KEYS.items():
        if isinstance(plain[name], list):
            own = {tuple(row.get(key) for key in keys) for row in plain[name] if isinstance(row, dict)}
            plain[name] += [row for row in getattr(library, name) if tuple(getattr(row, key) for key in keys) not in own]


def model_path(plain: Any, location: Sequence[str | int]) -> str:
    """Return a pydantic error location as a model path, with identifiers where the items of a list have them.

    >>> model_path({"loads": [{"id": "depot", "km": -1}]}, ("loads", 0, "km"))
    'loads[depot].km'
    """
    path = ""
    for step in location:
        if isinstance(step, int):
            items = plain if isinstance(plain, list | tuple) else ()
            plain = items[step] if step < len(items) else None
            name = plain.get("id") if isinstance(plain, dict) else None
            is_own = sum(isinstance(item, dict) and item.get("id") == name for item in items) == 1
            path += f"[{step if name is None or not is_own else name}]"
        elif isinstance(plain, dict) and step not in plain and step == plain.get("kind"):
            continue  # not a key, but which of several declarations, such as those of drives, was meant
        else:
            path += f"[{step}]" if not step.isidentifier() else f".{step}" if path else step
            plain = plain.get(step) if isinstance(plain, dict) else None
    return path


def split_change(change: str) -> tuple[str, str]:
    """Return the path of a change and its value as it is written.

    >>> split_change("supply.loads[a=b].power_kw = 400")
    ('supply.loads[a=b].power_kw', '400')

    Raises
    ------
    InputError
        If it is no change.
    """
    match = _CHANGE.fullmatch(change.strip())
    if match is None or not match["value"].strip():
        raise _refusal("bad_change", "", f"{change!r} is not a change", "PATH=VALUE", "write null as value to clear a value")
    return match["path"].strip(), match["value"].strip()


def parse_scalar(text: str) -> Any:
    """Return the value that `text` stands for: number, true, false, null or text; a text in quotes stays a text.

    >>> [parse_scalar(text) for text in ("0.2", "3", "null", "00:05:00", "'3'")]
    [0.2, 3, None, '00:05:00', '3']

    Raises
    ------
    ValueError
        If a quote is not closed.
    """
    text = text.strip()
    if text[:1] in {'"', "'"}:
        return _unquote(text)
    if text.lower() in _WORDS:
        return _WORDS[text.lower()]
    if _INTEGER.fullmatch(text):
        return int(text)
    return float(text) if _NUMBER.fullmatch(text) else text


def _unquote(text: str) -> str:
    if text[0] == '"':
        value = json.loads(text)  # its error is a ValueError
        return str(value)
    if not re.fullmatch(r"'(?:[^']|'')*'", text):
        raise ValueError("the quote is not closed")
    return text[1:-1].replace("''", "'")


def _thaw(value: Any) -> Any:
    """Return `value` with lists in place of tuples, so that items can be replaced."""
    if isinstance(value, dict):
        return {key: _thaw(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_thaw(item) for item in value]
    return value


def _change(plain: dict[str, Any], change: str) -> None:
    path, value = _parse(change)
    _set(plain, _steps(path), value, path, "")


def _set(container: Any, steps: Sequence[tuple[str, str]], value: Any, path: str, done: str) -> None:
    """Set what `steps` lead to from `container`, which the path `done` has led to."""
    (step, label), rest = steps[0], steps[1:]
    if label == ADDED and isinstance(container, list) and not rest:
        container.append(copy.deepcopy(value))
        return
    is_all = label == ALL and isinstance(container, list) and container
    for key in range(len(container)) if is_all else (_key(container, step, path, done),):
        if rest:
            _set(container[key], rest, value, path, done + label)
        else:
            container[key] = copy.deepcopy(value)


def _parse(change: str) -> tuple[str, Any]:
    path, value = split_change(change)
    if value[:1] in {"{", "["}:
        return path, _json(path, value)
    try:
        return path, parse_scalar(value)
    except ValueError:
        raise _refusal("bad_change", path, f"the quotes in {value} do not pair", "a number or a text") from None


def _json(path: str, text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError as error:
        allowed = 'JSON where it begins with a brace or bracket, for example {"kind": "to_time"}'
        raise _refusal("bad_change", path, f"{text.strip()!r} is not JSON: {error}", allowed) from None


def _steps(path: str) -> list[tuple[str, str]]:
    """Return the steps of `path`, each with its label as it stands in the path."""
    matches = list(_STEP.finditer(path))
    if "".join(match[0] for match in matches) != path:
        example = "for example supply.substations[A].km"
        raise _refusal("unknown_path", path, f"{path!r} is not a path", f"names with dots and [id], {example}")
    return [(match["name"] or match["key"], match[0]) for match in matches]


def _key(container: Any, step: str, path: str, done: str) -> Any:
    """Return the key or index of `container` that `step` names."""
    if isinstance(container, dict):
        keys = {str(key): [key] for key in container}
    elif isinstance(container, list):
        keys = _item_keys(container)
    else:
        raise _refusal("unknown_path", path, f"{done} is a single value and has no part {step!r}", remedy=f"set {done} itself")
    found = keys.get(step) or (_by_index(container, keys, step) if isinstance(container, list) else [])
    if not found:
        raise _unknown(path, done, step, container)
    if len(found) > 1:
        raise _refusal(
            "ambiguous_path", path, f"{done} has {len(found)} items with id {step!r}", remedy="name it by its index, from 0"
        )
    return found[0]


def _item_keys(items: list[Any]) -> dict[str, list[int]]:
    """Return what addresses each item: its id if all items have one, else its index."""
    by_id = all(isinstance(item, dict) and "id" in item for item in items)
    keys: dict[str, list[int]] = {}
    for index, item in enumerate(items):
        keys.setdefault(str(item["id"] if by_id else index), []).append(index)
    return keys


def _by_index(items: list[Any], keys: dict[str, list[int]], step: str) -> list[int]:
    """Return the item of which `step` is the index, if an index cannot be taken for an id."""
    is_index = step.isdecimal() and len(step) < 10 and not any(map(str.isdecimal, keys))
    return [int(step)] if is_index and int(step) < len(items) else []


def _unknown(path: str, done: str, step: str, container: Any) -> InputError:
    names = [str(key) for key in container] if isinstance(container, dict) else list(_item_keys(container))
    shown = ", ".join(names[:_SHOWN]) + (f", ... ({len(names)} in all)" if len(names) > _SHOWN else "")
    folded = {name.lower(): name for name in names}
    nearest = difflib.get_close_matches(step.lower(), folded, n=1, cutoff=0.5)
    remedy = f"did you mean {folded[nearest[0]]!r}?" if nearest else ""
    deeper = _paths_that_end(container, path.removeprefix(done).removeprefix("."), done)
    if deeper:  # what was written is right, but its beginning is missing
        remedy = f"did you mean {' or '.join(deeper)}?"
    return _refusal("unknown_path", path, f"no {step!r} in {done or 'the scenario'}", shown or "nothing, it is empty", remedy)


def _paths_that_end(container: Any, end: str, done: str) -> list[str]:
    """Return the first paths below `container`, which the path `done` has led to, that end like `end`."""
    steps = [step for step, _ in _steps(end)]
    found: list[str] = []
    waiting = [(container, done)]
    while waiting and len(found) < _MOST_MEANT:
        here, path = waiting.pop(0)  # what lies higher comes first
        if isinstance(here, dict):
            waiting += [(value, f"{path}.{key}" if path else str(key)) for key, value in here.items()]
        elif isinstance(here, list):
            waiting += [(here[k], f"{path}[{name}]") for name, (k, *more) in _item_keys(here).items() if not more]
        if path != done and isinstance(here, dict) and _leads(here, steps):
            found.append(f"{path}{'' if end.startswith('[') else '.'}{end}")
    return found


def _leads(container: Any, steps: Sequence[str]) -> bool:
    """Return whether all `steps`, one after the other, exist from `container` on."""
    for step in steps:
        if isinstance(container, dict) and step in container:
            container = container[step]
        elif isinstance(container, list) and len(_item_keys(container).get(step, ())) == 1:
            container = container[_item_keys(container)[step][0]]
        else:
            return False
    return True


def _refusal(code: str, path: str, found: str, allowed: str = "", remedy: str = "") -> InputError:
    return InputError([Problem(code, path, found, allowed, remedy)])


def _complaints(plain: dict[str, Any], error: ValidationError) -> list[Problem]:
    """Return the complaints of the model as problems that name the path and the refused value."""
    problems = []
    for detail in error.errors(include_url=False):
        given = detail["input"]
        found = "" if isinstance(given, dict | list | tuple) else f"{given!r}: "
        problems.append(Problem("bad_value", model_path(plain, detail["loc"]), found + detail["msg"]))
    return problems

"""What the outcome of a case hangs on, as a key: the program, what measures it, the changed scenario."""

from __future__ import annotations

import functools
import hashlib
import json
from dataclasses import asdict, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import BaseModel

import tractionpower
from tractionpower.model.scenario import Scenario
from tractionpower.results.versions import versions
from tractionpower.studies.runner.case import Work
from tractionpower.studies.runner.packed import FORMAT


@cache
def program() -> dict[str, str]:
    """Return the versions of the program and of what its numbers hang on, with a hash of its source."""
    root = Path(tractionpower.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py"), key=lambda path: path.relative_to(root).as_posix()):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return {**versions(), "source": digest.hexdigest()[:16]}


def key_of(scenario: Scenario, work: str) -> str:
    """Return the key of what `work` (see `work_identity`) measures of a scenario."""
    parts = {"format": FORMAT, "program": program(), "work": work, "input_hash": scenario.input_hash}
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def work_identity(work: Work) -> str:
    """Return the name and the arguments of what measures cases.

    Raises
    ------
    TypeError
        If an argument is no plain value: number, text, list, mapping, path, dataclass or declaration.
    """
    if isinstance(work, functools.partial):
        arguments = json.dumps([work.args, work.keywords], sort_keys=True, default=_told)
        return f"{work_identity(work.func)}{arguments}"
    return f"{work.__module__}.{work.__qualname__}"


def _told(value: Any) -> Any:
    """Return a value as JSON can hold it."""
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", by_alias=True)
    if is_dataclass(value) and not isinstance(value, type):
        return asdict(value)
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"an argument of what measures cases is no plain value: {value!r}")

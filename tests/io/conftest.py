"""A small sound study in a folder, and what reading it tells."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tractionpower.errors import Problem
from tractionpower.io.scenario_files import read_scenario

FILES = {
    "study.yaml": 'format: 1\nname: Test\nclock: {start: "00:00:00", end: 00:15:00}\n',
    "line.yaml": 'format: 1\ntracks:\n  - {id: "1", from_km: 0.0, to_km: 20.0}\n  - {id: "2", from_km: 0.0, to_km: 20.0}\n',
    "supply.yaml": (
        "format: 1\n"
        "substations:\n"
        "  - {id: A, km: 0.0, no_load_voltage_v: 3600, internal_resistance_ohm: 0.12}\n"
        "contact_lines:\n"
        "  - {from_km: 0.0, to_km: 20.0, resistance_ohm_per_km: 0.05}\n"
        "return_circuit:\n"
        "  - {from_km: 0.0, to_km: 20.0, resistance_ohm_per_km: 0.01}\n"
    ),
}

Writer = Callable[..., Path]
Teller = Callable[..., list[Problem]]


@pytest.fixture
def write_study(tmp_path: Path) -> Writer:
    """Write the small study with some files replaced or appended to; keys are file names with `_` for the dot."""

    def write(append: dict[str, str] | None = None, **files: str | bytes) -> Path:
        texts: dict[str, str | bytes] = dict(FILES)
        texts.update({name.replace("__", "-").replace("_", "."): text for name, text in files.items()})
        for name, text in (append or {}).items():
            texts[name] = str(texts[name]) + text
        for name, text in texts.items():
            (tmp_path / name).write_bytes(text.encode() if isinstance(text, str) else text)
        return tmp_path

    return write


@pytest.fixture
def problems_of_study(write_study: Writer) -> Teller:
    """Write a study and return the problems of reading it."""

    def tell(append: dict[str, str] | None = None, **files: str | bytes) -> list[Problem]:
        loaded, problems = read_scenario(write_study(append, **files))
        assert (loaded is None) == any(problem.severity == "error" for problem in problems)
        return problems

    return tell


@pytest.fixture
def only_problem(problems_of_study: Teller) -> Callable[..., Problem]:
    """Write a study that has exactly one problem and return it."""

    def tell(append: dict[str, str] | None = None, **files: str | bytes) -> Problem:
        problems = problems_of_study(append, **files)
        assert len(problems) == 1, problems
        return problems[0]

    return tell

"""A small sound study in a folder, and what reading it tells."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tractionpower.errors import Problem
from tractionpower.io import stock_finder
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

COACH = (
    "format: 1\nid: coach\nkind: coach\nmass_t: 42\nlength_m: 26.4\nmax_speed_kmh: 160\n"
    "rotating_mass_factor: 1.05\nresistance: {a_n: 100}\n"
)
TRAIN = "format: 1\nid: ic\nvehicles:\n  - {id: coach, count: 3}\n"
TIMETABLE = (
    "format: 1\ntrains:\n  - id: 7\n    train: ic\n    route: [{track: 1, from_km: 0, to_km: 20}]\n"
    "    calls:\n      - {station: A, departure: 00:05:00}\n      - {station: B, arrival: 00:20}\n"
)
WITH_TRAINS = {
    "study.yaml": "timetable: timetable.yaml\n",
    "timetable.yaml": TIMETABLE,
    "rollingstock/trains/ic.yaml": TRAIN,
    "rollingstock/vehicles/coach.yaml": COACH,
}

Writer = Callable[..., Path]
Teller = Callable[..., list[Problem]]


@pytest.fixture
def write_study(tmp_path: Path) -> Writer:
    """Write the small study with some files replaced, appended to or added; keys are file names, or such with `_` for the dot."""

    def write(append: dict[str, str] | None = None, **files: str | bytes) -> Path:
        texts: dict[str, str | bytes] = dict(FILES)
        texts.update({name.replace("__", "-").replace("_", "."): text for name, text in files.items()})
        for name, text in (append or {}).items():
            texts[name] = str(texts.get(name, "")) + text
        for name, text in texts.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_bytes(text.encode() if isinstance(text, str) else text)
        return tmp_path

    return write


@pytest.fixture
def with_trains() -> dict[str, str]:
    """What makes the small study one with a train."""
    return dict(WITH_TRAINS)


@pytest.fixture
def stock_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Path]:
    """Empty folders in place of the working folder and of the data that ship."""
    places = {name: tmp_path / "places" / name for name in ("work", "ships")}
    for folder in places.values():
        folder.mkdir(parents=True)
    monkeypatch.chdir(places["work"])
    monkeypatch.setattr(stock_finder, "data_folder", lambda kind: places["ships"] / kind)
    return places


@pytest.fixture
def problems_of_trains(
    problems_of_study: Callable[..., list[Problem]], stock_places: dict[str, Path]
) -> Callable[..., list[Problem]]:
    """Write the study with one train, some files of it replaced, and return the problems; None takes a file away."""

    def tell(changed: dict[str, str | None]) -> list[Problem]:
        files = {name: text for name, text in (WITH_TRAINS | changed).items() if text is not None}
        return problems_of_study(files)

    return tell


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

"""Timetables: plans with the least energy, the working day of a suburban line, the verdict on the timetable of a main line."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import tractionpower as tp
from line import MEASURED, _run
from report import goal, table
from timing import Times, take_turns
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import compile_trains
from tractionpower.movement.driving.driven import compile_driven

PLAN_GOAL_S, DAY_GOAL_S, VERDICT_GOAL_S = 1.0, 5.0, 60.0
RESERVES = (3, 8, 20)
LENGTH_KM = 60.0

Row = tuple[str, Times, float | None]


def measure(rounds: int) -> list[Row]:
    """Measure plans in this process, days and verdicts in processes of their own; kernels are compiled before."""
    flat = _journey()
    plans = {f"a plan for 60 km with {percent} % in reserve": _reserve(flat, percent) for percent in RESERVES}
    actions = {"the same journey compiled flat out": lambda: _nothing(compile_trains(flat))}
    actions |= {name: (lambda study=study: _nothing(compile_driven(study))) for name, study in plans.items()}
    rows: list[Row] = [
        (name, times, PLAN_GOAL_S if name in plans else None) for name, times in take_turns(actions, rounds).items()
    ]
    wkd = tp.load("wkd")
    saving = wkd.model_copy(update={"timetable": _driven(wkd, {"kind": "to_time"})})
    whole = take_turns(
        {"plans of the working day of `wkd`, all trains to time": lambda: _nothing(compile_driven(saving))}, rounds
    )
    rows += [(name, times, None) for name, times in whole.items()]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows.append(
            _process("`run wkd --no-reports`", ["run", "wkd", "--no-reports", "--out", str(folder / "wkd")], rounds, DAY_GOAL_S)
        )
        for line in ("wkd", "cmk"):
            what = ["feasibility", line, "--no-reports", "--out", str(folder / f"{line}-feasibility")]
            rows.append(_process(f"`feasibility {line} --no-reports`", what, rounds, VERDICT_GOAL_S if line == "cmk" else None))
    return rows


def _process(what: str, arguments: list[str], rounds: int, limit_s: float) -> Row:
    return what, Times(tuple(_run(MEASURED, json.dumps(arguments))[0] for _ in range(rounds))), limit_s


def _journey() -> Scenario:
    """Return a train of the real line that runs 60 km of it without a stop, from rest to rest."""
    study = tp.load("cmk")
    run = {
        "id": "x", "train": "vectron-9-coaches", "route": [{"track": "1", "from_km": 98.5, "to_km": 98.5 + LENGTH_KM}],
        "start": {"time": 36000.0}, "end": "stop",
    }  # fmt: skip
    return study.model_copy(update={"timetable": type(study.timetable).model_validate({"trains": [run]})})


def _reserve(study: Scenario, percent: float) -> Scenario:
    return study.model_copy(update={"timetable": _driven(study, {"kind": "reserve", "percent": float(percent)})})


def _driven(study: Scenario, driving: dict[str, object]) -> object:
    timetable = study.timetable
    return type(timetable).model_validate(timetable.model_dump(by_alias=True) | {"driving": driving})


def _nothing(_: object) -> None:
    return None


def describe(rows: list[Row]) -> str:
    """Return the results as markdown."""
    headings = ["what", "seconds, least", "median", "goal [s]"]
    cells = [
        [what, f"{times.least:.2f}", f"{times.median:.2f}", "" if limit is None else f"{limit:g}: {goal(times.least, limit)}"]
        for what, times, limit in rows
    ]
    told = (
        "Plans with the least energy: `vectron-9-coaches` on 60 km of `cmk`, from rest to rest, kernels compiled; from the"
        " declared study to the tables, the search for the time included. Commands are whole processes."
    )
    return f"### Timetables\n\n{table(headings, cells)}\n\n{told}"

"""Texts that lower floors declare and reports show: names and meanings of quantities, limits, words of tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel

from tractionpower.cosimulation.events import KINDS as FLAGGED_KINDS
from tractionpower.cosimulation.events import KINDS_TOLD
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rating_files import DUTY_CLASSES
from tractionpower.kernels.train_tables import LIMITED_BY, PHASES
from tractionpower.model.base import Declaration
from tractionpower.model.contingency import OUTAGE_KINDS, Contingency
from tractionpower.model.dynamics.case import Case, CaseRun, CaseStart, CaseTrack, DynamicsScenario
from tractionpower.model.dynamics.coupling import Coupling, Gear, Wedge
from tractionpower.model.dynamics.gear import AirBrake, BlockFriction, BrakeGear, ElectricBrake, Traction
from tractionpower.model.dynamics.point_mass import SpecificResistance, TrainCharacteristics
from tractionpower.model.dynamics.stations import StationsCase, StationsRun, Traffic, TrainKind
from tractionpower.model.feasibility import Feasibility
from tractionpower.model.quantity import Quantity
from tractionpower.model.remedies import RemedyCosts, RemedySearch
from tractionpower.model.scenario import Clock, Output, Scenario, StudyFile
from tractionpower.model.sizing import Sizing, SizingSearch, UsefulVoltageStudy
from tractionpower.results import rails
from tractionpower.results.columns import DELAY_PARTS, ORIGIN_PARTS, TABLES
from tractionpower.results.dynamics_figures import WORKS
from tractionpower.results.key_figures import LEDGER_FIGURES
from tractionpower.results.selection.select import PART
from tractionpower.studies.cases.judgement import DEMAND, PEAK
from tractionpower.studies.ratings.useful import DEFINITIONS
from tractionpower.studies.ratings.words import KINDS

SETTINGS = (
    StudyFile,
    Clock,
    Output,
    Feasibility,
    RemedySearch,
    RemedyCosts,
    Sizing,
    UsefulVoltageStudy,
    SizingSearch,
    Contingency,
    Case,
    CaseRun,
    CaseStart,
    CaseTrack,
    AirBrake,
    BrakeGear,
    BlockFriction,
    Traction,
    ElectricBrake,
    Coupling,
    Gear,
    Wedge,
    StationsCase,
    StationsRun,
    Traffic,
    TrainKind,
    TrainCharacteristics,
    SpecificResistance,
)
"""Declarations of which reports tell the meaning of every field."""

CALLS = ("arrival", "departure", "pass")
STATUSES = (
    "complete",
    "flagged",
    "interrupted",
    "refused",
    "failed",
    "verified",
    "secondary",
    "recalled",
    "user",
    "derived",
    "assumed",
)
CONTINGENCY = ("base", "pair", "normal", "low", "high", "dead")
VERDICTS = ("feasible", "infeasible", "not finished", "not judged", "pass", "fail", "not rated", "holds", "fails", "not reached")
WHERE = ("cross section", "pantograph", "fixed", "zone", "train", "run", "hour", "given", "whole run", "network", "driving")


def static_texts() -> Iterator[str]:
    """Yield all texts of lower floors that are the same in every report; some more than once."""
    yield from _of_tables()
    yield from _of_declarations()
    for limit in shipped_limits():
        yield from (limit.meaning, limit.source)
    for duty in DUTY_CLASSES.shipped:
        yield from (duty.meaning, duty.source)
    yield from _of_figures()
    yield from _plain(PHASES, LIMITED_BY, KINDS_TOLD, FLAGGED_KINDS.values(), KINDS, KINDS.values(), OUTAGE_KINDS, DELAY_PARTS)
    yield from _plain(ORIGIN_PARTS, CALLS, STATUSES, CONTINGENCY, VERDICTS, WHERE, DEFINITIONS.values(), (DEMAND, PEAK))
    yield PART


def _plain(*lists: Iterable[str]) -> Iterator[str]:
    for words in lists:
        yield from (word.replace("_", " ") for word in words)


def _of_tables() -> Iterator[str]:
    for table, columns in TABLES.items():
        yield table.replace("_", " ")
        for column in columns:
            yield from (column.quantity.words, column.quantity.meaning)


def _of_figures() -> Iterator[str]:
    for name, definition in (
        *LEDGER_FIGURES.values(),
        *((name, told) for name, (_, told) in WORKS.items()),
        *rails.FIGURES.items(),
        *rails.DEVICE_FIGURES.items(),
    ):
        yield from (Quantity(name, "").words, definition)


def _of_declarations() -> Iterator[str]:
    """Yield names, meanings, sources of defaults and words of the fields of all inputs."""
    known: set[type[BaseModel]] = set()
    left: list[type[BaseModel]] = [Scenario, StudyFile, DynamicsScenario, StationsCase]
    while left:
        kind = left.pop()
        if kind in known:
            continue
        known.add(kind)
        for attribute, field in kind.model_fields.items():
            yield Quantity(field.alias or attribute, "").words
            if kind in SETTINGS or isinstance(field.default, float | int):  # of others reports do not tell the meaning
                extra = field.json_schema_extra
                yield from (field.description or "", str(extra.get("source", "")) if isinstance(extra, dict) else "")
            parts, words = _held(field.annotation)
            yield from _plain(words)
            left += parts
            for part in field.metadata:  # a list whose own annotation hides in its constraints
                more, words = _held(part)
                yield from _plain(words)
                left += more


def _held(annotation: Any) -> tuple[list[type[BaseModel]], list[str]]:
    """Return the declarations and the words that a field of an annotation may hold."""
    if isinstance(annotation, type) and issubclass(annotation, Declaration):
        return [annotation], []
    if get_origin(annotation) is Literal:
        return [], [each for each in get_args(annotation) if isinstance(each, str)]
    parts: list[type[BaseModel]] = []
    words: list[str] = []
    for each in get_args(annotation):
        inner = _held(each)
        parts, words = parts + inner[0], words + inner[1]
    return parts, words

"""The sheet of assumptions: what holds in this run that is not computed but taken as given, with how far it is known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from pydantic import BaseModel

from tractionpower.model.limits import Limit
from tractionpower.model.scenario import Scenario, StudyFile
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common import assumed_supply, assumed_trains
from tractionpower.reporting.workbook.common.assumption import Assumption, figure, names
from tractionpower.reporting.workbook.common.declared import Declared, declared, words_of
from tractionpower.reporting.workbook.common.inputs import MANY, used_limits
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts, limit_in_words
from tractionpower.reporting.workbook.frame.page import Column, heading_of

COLUMNS = (
    Column("no.", "0"),
    Column("of", "beside", widest=22),
    Column("assumption", "beside", widest=84),
    Column("where it acts", "beside", widest=40),
    Column("source, status", "beside", widest=48),
)
DEFAULTS = (
    Column("of", widest=34),
    Column("quantity", widest=40),
    Column("value", "general"),
    Column("held by", "beside", widest=14),
    Column("meaning", "beside", widest=70),
    Column("source of the default", "beside", widest=30),
)

FAMILIES = {
    "touch_": mark("touch voltages"),
    "stray_": mark("stray current"),
    "window_": mark("windows of currents"),
    "wire_": mark("weather and wires"),
    "grid_": mark("grid voltage at outages"),
}
"""Limits that belong together, by how their names begin, and what they enter."""

MOST_OF_SOURCES = 60
"""Assumptions out of the sources of the inputs that the list takes."""

_ASSUMES = re.compile(r"assum|estimat|recalled|neglected|taken (as|from|to)|założ|przyję|szacow", re.IGNORECASE)
"""What a source says that is no source."""

_SENTENCE = re.compile(r"(?:[^.;(]|\([^)]*\)|[.;(](?!\s|$))+[.;]?")
"""A part of a text that ends with a full stop or semicolon, unless these stand in brackets."""

BY_MODEL = mark("method of the program, docs/model.md")


def add(book: Book) -> None:
    """Add the sheets: the numbered assumptions, and the defaults of the program that are in use."""
    facts = book.facts
    groups = (
        (mark("method"), [*_method(facts), *assumed_supply.network(facts)]),
        (mark("supply system"), [*assumed_supply.supply(facts)]),
        (mark("line and trains"), [*assumed_trains.trains(facts)]),
        (mark("limits"), [*_limits(facts)]),
        (mark("sources of inputs"), [*_sources(facts.scenario)]),
        (mark("notes of the run"), [*_notes(facts)]),
        (mark("the study's own"), [Assumption(text, "", tr("by the author of the study")) for text in book.report.assumptions]),
    )
    rows = [(tr(title), *row) for title, found in groups for row in found]
    page = book.page("Assumptions", "Assumptions of this run")
    page.note(
        "What the results rest on beside the inputs as given. Every line holds in this run; what the run does not use is left"
        " out."
        " Numbers that the study leaves to the program are on sheet Defaults."
    )
    page.table(COLUMNS, [(k, *row) for k, row in enumerate(rows, 1)], frozen=True)
    defaults = list(_defaults(facts))
    if defaults:
        page = book.page("Defaults", "Defaults of the program that act in this run")
        page.note(
            "Numbers that the study leaves to the program, or gives as it would take them. Held by: how many have this value."
        )
        page.table(DEFAULTS, defaults, frozen=True)


def _method(facts: Facts) -> Iterator[Assumption]:
    scenario = facts.scenario
    step = facts.run.get("step_s", scenario.clock.step_s)
    trains, network = tr("trains"), tr("network")
    if facts.run.get("kind") in MANY:
        yield Assumption(
            tr("What stands here is that of the base case; every other case differs from it in what its changes tell."),
            tr("all cases"), tr("of the study"),
        )  # fmt: skip
    if facts.run.get("kind") == "compare":
        yield Assumption(
            tr("What stands here is that of the base folder; the others differ from it in the inputs of sheet {sheet}.",
               sheet=tr("Inputs that differ")),
            tr("all folders"), tr("of the comparison"),
        )  # fmt: skip
    if not scenario.runs:
        yield Assumption(tr("A network calculation without trains: fixed loads alone take current."), network, tr("of the study"))
    elif facts.run.get("coupling", scenario.coupling) == "full":
        yield Assumption(
            tr("Full coupling: trains and network limit each other within the same step, without a lag or a damping factor."),
            tr("trains and network"), tr(BY_MODEL),
        )  # fmt: skip
    else:
        volts = facts.run.get("coupling_voltage_v", scenario.coupling_voltage_v)
        yield Assumption(
            tr("Trains take their currents at a constant {volts} V; the network tells the voltages that follow, and low"
               " voltages slow"
               " no train down.", volts=figure(volts)),
            trains, tr("of the study; Krzysztozek 2019"),
        )  # fmt: skip
    yield Assumption(
        tr("Places of trains in the network hold for a step of {step} s; forces, currents, voltages and powers are means of a"
           " step.",
           step=figure(step)),
        tr("all figures"), tr(BY_MODEL),
    )  # fmt: skip
    clock = scenario.clock
    if clock.warm_up is not None:
        yield Assumption(
            tr("The first {minutes} min are a warm-up: computed and written, but left out of key figures and verdicts.",
               minutes=figure(clock.warm_up / 60.0)),
            tr("key figures, verdicts"), tr("of the study"),
        )  # fmt: skip
    elif scenario.runs:
        yield Assumption(
            tr("No warm-up: the run counts from its first step, with the trains that are on the line then."),
            tr("key figures, verdicts"), tr("default"),
        )  # fmt: skip
    if scenario.output.every_s is not None:
        yield Assumption(
            tr("Tables keep a row every {seconds} s; key figures, windows and verdicts look at every step.",
               seconds=figure(scenario.output.every_s)),
            tr("tables and charts"), tr("of the study"),
        )  # fmt: skip


def _limits(facts: Facts) -> Iterator[Assumption]:
    """Yield the limits that verdicts or results rest on and nobody has verified, then how they are applied."""
    used = {str(verdict["limit"]) for verdict in facts.verdicts}
    compared = facts.table("compare_verdicts")
    used |= set(compared["limit"].astype(str)) if len(compared) else set()
    told = {row["limit"] for row in (facts.run.get("return_circuit") or {}).get("touch_voltage", ())}
    families: dict[tuple[str, str, str], list[Limit]] = {}
    for limit in used_limits(facts):
        family = next((each for each in FAMILIES if limit.name.startswith(each)), "")
        acts = limit.name in used | told or (family not in ("", "touch_"))
        if limit.status != "verified" and acts:
            families.setdefault((family, limit.status, limit.source), []).append(limit)
    for (family, status, source), limits in families.items():
        known = f"{recorded(KNOWN_AS.get(status, status))}; {recorded(source)}"
        where = tr(FAMILIES[family]) if family else tr("verdicts")
        yield Assumption("; ".join(map(_value, limits)), where, known)
    if {"u_min2", "u_max2"} & used:
        yield Assumption(
            tr("U_min2 and U_max2 are held against the lowest and highest mean of a step at trains, loads and fixed places of the"
               " network, with 0.1 V of tolerance."),
            tr("verdicts on voltages"), tr("EN 50163 as quoted; what it says of short dips is not at hand"),
        )  # fmt: skip
    if any(name.startswith("u_useful") for name in used):
        yield Assumption(
            tr("The mean useful voltage is told by both definitions in circulation, current-weighted and as a mean over time;"
               " zones"
               " lie between neighbouring substations of a track unless the study names its own."),
            tr("mean useful voltage"), tr("secondary: EN 50388 is not at hand"),
        )  # fmt: skip
        yield Assumption(
            tr("The class of the line is {line_class}.",
               line_class=recorded(facts.scenario.sizing.useful_voltage.line_class.replace("_", " "))),
            tr("limit of the mean useful voltage"), _origin(facts.scenario.sizing.useful_voltage, "line_class"),
        )  # fmt: skip
    if facts.run.get("return_circuit"):
        yield Assumption(
            tr("The rail potential stands for the touch voltage; between two durations of the table that of the longer one"
               " holds."),
            tr("verdicts on rail potentials"), tr("EN 50122-1, secondary; an upper bound"),
        )  # fmt: skip
    if facts.feasibility is not None:
        yield Assumption(
            tr("A train is late beyond {seconds} s.", seconds=figure(facts.scenario.feasibility.tolerance_s)),
            tr("verdict on the timetable"), _origin(facts.scenario.feasibility, "tolerance_s"),
        )  # fmt: skip


def _value(limit: Limit) -> str:
    name = limit_in_words(limit.name) if limit.name.startswith("u_") else limit.name
    return f"{name} = {figure(limit.value)} {limit.unit}".strip() + f" ({recorded(limit.meaning)})"


def _origin(part: BaseModel, name: str) -> str:
    """Return whether a setting was given."""
    return next(tr(field.known) for field in declared(part) if field.name == name)


def _sources(scenario: Scenario) -> Iterator[Assumption]:
    """Yield the sentences in the sources of the inputs that say what is assumed, estimated or recalled."""
    told: dict[str, list[str]] = {}
    for where, source in _source_texts(scenario):
        for sentence in _SENTENCE.findall(source):
            if _ASSUMES.search(sentence):
                told.setdefault(" ".join(sentence.split()).rstrip(";"), []).append(where)
    for sentence, owners in list(told.items())[:MOST_OF_SOURCES]:
        yield Assumption(sentence, names(owners), tr("source text of the input"))
    if len(told) > MOST_OF_SOURCES:
        left = tr("{count} more are in the sources on sheet Inputs study.", count=len(told) - MOST_OF_SOURCES)
        yield Assumption(left, "", tr("source text of the input"))


def _source_texts(scenario: Scenario) -> Iterator[tuple[str, str]]:
    yield tr("line"), scenario.line.source
    for vehicle in scenario.vehicles:
        yield tr("vehicle {id}", id=vehicle.id), vehicle.source
    for train in scenario.trains:
        yield tr("train {train}", train=train.id), train.source
    for unit in scenario.rectifier_units:
        yield tr("rectifier unit {id}", id=unit.unit), unit.source
    for row in scenario.conductors:
        yield tr("conductor {id}", id=row.name), row.source
    for duty in scenario.duty_classes:
        yield tr("duty class {id}", id=duty.duty_class), recorded(duty.source)


def _notes(facts: Facts) -> Iterator[Assumption]:
    run = facts.run
    inner = [run.get(name) or {} for name in ("size", "contingency")]
    kept = [*(run.get("notes") or ()), *(note for each in inner for note in (each.get("notes") or ()))]
    overlaps = (run.get("overlaps") or {}).get("message")
    for note in [*kept, *([overlaps] if overlaps else [])]:
        yield Assumption(recorded(str(note)), tr("this run"), tr("told by the program"))
    for words in (run.get("contingency") or {}).get("begins") or ():
        yield Assumption(recorded(str(words)), tr("outages"), tr("told by the program"))


NEEDED_BY = {
    "trip_delay_s": "trip_current_a",
    "reclosures": "reclose_after_s",
    "reclaim_s": "reclose_after_s",
    "reserve_after_s": "reserve_units",
    "reserve_overload_percent": "reserve_units",
    "rails_every_s": "",
}
"""Fields that act only where another one of the same part is given; nothing: they change no figure."""


def _defaults(facts: Facts) -> Iterator[tuple[Any, ...]]:
    """Yield the numbers that parts of the inputs have by default, each once, with how many have them."""
    scenario = facts.scenario
    roots: list[tuple[str, Sequence[BaseModel]]] = [
        ("clock", [scenario.clock]), ("supply", [scenario.supply]), ("line", [scenario.line]), ("vehicles", scenario.vehicles),
        ("trains", scenario.trains), ("timetable", [scenario.timetable]),
    ]  # fmt: skip
    if facts.run.get("kind") in ("size", "contingency", "sweep"):
        roots.append(("sizing", [scenario.sizing]))
    usual = {field.name: field for field in declared(scenario)}
    study = StudyFile.model_fields["coast_without_voltage_s"]
    coasts = usual["coast_without_voltage_s"]
    if coasts.is_default and scenario.runs:
        yield words_of("study"), heading_of(coasts.name), coasts.value, "", recorded(study.description or ""), ""
    for title, parts in roots:
        yield from defaults_of(title, parts)


def defaults_of(title: str, parts: Iterable[BaseModel], before: str = "") -> Iterator[tuple[Any, ...]]:
    """Yield the rows of equal parts of the inputs, then those of their inner parts; bounds of searches change no figure."""
    found: dict[str, list[Declared]] = {}
    inner: dict[str, list[BaseModel]] = {}
    for part in parts:
        for field in declared(part):
            value = field.value
            if isinstance(value, BaseModel) and field.name != "search":
                inner.setdefault(field.name, []).append(value)
            elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
                inner.setdefault(field.name, []).extend(value)
            elif _is_number(field.default) and _acts(part, field.name):
                found.setdefault(field.name, []).append(field)
    of = f"{before}{words_of(title)}"
    for name, fields in found.items():
        count = sum(field.is_default for field in fields)
        if count:
            first = fields[0]
            share = tr("{count} of {all}", count=count, all=len(fields)) if len(fields) > 1 else ""
            yield of, heading_of(name), first.default, share, recorded(first.meaning), recorded(first.source)
    for name, values in inner.items():
        yield from defaults_of(name, values, f"{of}: ")


def _acts(part: BaseModel, name: str) -> bool:
    needed = NEEDED_BY.get(name)
    return needed is None or bool(getattr(part, needed, None))


def _is_number(value: Any) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool)

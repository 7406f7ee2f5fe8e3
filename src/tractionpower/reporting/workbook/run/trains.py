"""The sheet of trains: one row for each, its figures side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.model.line import Line
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Part
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.facts import STATES, Facts
from tractionpower.reporting.workbook.frame.page import Block, Column, heading_of

FIGURES = {
    "journey_time_s": "time",
    "running_time_s": "time",
    "late_at_end_s": "0",
    "length_km": "0.000",
    "mean_speed_kmh": "0.0",
    "highest_speed_kmh": "0.0",
    "energy_taken_kwh": "0.0",
    "energy_returned_kwh": "0.0",
    "auxiliary_energy_kwh": "0.0",
    "drive_loss_kwh": "0.0",
    "starting_resistor_energy_kwh": "0.0",
    "refused_energy_kwh": "0.0",
    "highest_current_a": "0",
    "lowest_pantograph_voltage_v": "0",
    "lowest_10_s_mean_voltage_v": "0",
    "mean_useful_voltage_current_weighted_v": "0",
    "mean_useful_voltage_time_mean_v": "0",
}
"""Key figures of a train that have a column, and the format of each."""

_HEADINGS = {"lowest_pantograph_voltage_v": "lowest voltage [V]", "lowest_10_s_mean_voltage_v": "lowest mean voltage of 10 s [V]"}
NEAR_KM = 0.05
"""A run that begins or ends so near a station is said to be there [km]."""

_VOLTAGES = tuple(name for name in FIGURES if name.endswith("voltage_v") or name.startswith("mean_useful"))


def add(book: Book) -> None:
    """Add the sheet of trains, if there are any."""
    facts = book.facts
    if not facts.trains:
        return
    page = book.page("Trains", "Trains")
    low, nominal = facts.limit("u_min2"), facts.limit("u_n")
    if low is not None and nominal is not None:
        page.note(
            f"Voltages below U_min2 = {low.value:g} V are red, below U_n = {nominal.value:g} V amber"
            f" (values {low.status}: {low.source})."
        )
    page.note("Times of day go beyond 24:00:00 on the next day. Late is computed less planned time; negative is early.")
    present = [name for name in FIGURES if any(facts.value(_place(train), name) is not None for train in facts.trains)]
    block = page.table(_columns(present), (_row(facts, train, present) for train in facts.trains), frozen=True)
    for name in present:
        if name in _VOLTAGES and low is not None and nominal is not None:
            _colour(block, _heading(name), low.value, nominal.value)
    if "late_at_end_s" in present:
        colour_late(block, _heading("late_at_end_s"))


def colour_late(block: Block, heading: str) -> None:
    """Let times late show amber from a second on, red from a minute on."""
    area = block.cells(heading)
    for least, colour in (("59.5", RED_FILL), ("0.5", AMBER_FILL)):
        rule = CellIsRule(operator="greaterThanOrEqual", formula=[least], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)


def route_in_words(run: TrainRun | None, line: Line) -> tuple[str, str]:
    """Return where a run begins and ends: the station there, or else track and kilometre."""
    if run is None:
        return "", ""
    first, last = run.route[0], run.route[-1]
    names = {station.id: station.name or station.id for station in line.stations}
    begins, ends = _place_in_words(line, first.track, first.from_km), _place_in_words(line, last.track, last.to_km)
    if run.calls and run.start is None:
        begins = names.get(run.calls[0].station, begins)
    if run.calls and run.calls[-1].stops:
        ends = names.get(run.calls[-1].station, ends)
    return begins, ends


def _place_in_words(line: Line, track: str, km: float) -> str:
    at_station = [s for s in line.stations if abs(s.km - km) <= NEAR_KM and (s.tracks is None or track in s.tracks)]
    if at_station:
        nearest = min(at_station, key=lambda station: abs(station.km - km))
        return nearest.name or nearest.id
    return f"track {track}, km {km:g}"


def formation_in_words(parts: Sequence[Part]) -> str:
    """Return the vehicles of a train from its front, with their load and whether they are hauled."""
    words = []
    for part in parts:
        load = f", {part.load_percent:g} % loaded" if part.load_percent else ""
        hauled = "" if part.powered else ", hauled"
        words.append(f"{part.count} × {part.id}{load}{hauled}")
    return " + ".join(words)


def _place(train: dict[str, Any]) -> str:
    return f"train {train['train']}"


def _heading(name: str) -> str:
    heading = _HEADINGS.get(name) or heading_of(name)
    return heading.replace("[s]", "[h:min:s]") if FIGURES[name] == "time" else heading


def _columns(present: list[str]) -> list[Column]:
    words = [Column("train", widest=24), Column("formation", widest=24), Column("from", widest=24), Column("to", widest=24)]
    words += [Column("what became of it", widest=26), Column("entered", "time"), Column("left", "time")]
    return words + [Column(_heading(name), FIGURES[name]) for name in present]


def _row(facts: Facts, train: dict[str, Any], present: list[str]) -> list[Any]:
    run = facts.runs.get(str(train["train"]))
    formation = "" if run is None else run.train or formation_in_words(run.vehicles)
    state = train.get("status", "")
    words = [train["train"], formation, *route_in_words(run, facts.scenario.line), STATES.get(state, state)]
    values = [facts.value(_place(train), name) for name in present]
    return [*words, train.get("entered_s"), train.get("finished_s"), *values]


def _colour(block: Block, heading: str, low: float, nominal: float) -> None:
    """Let voltages below the lowest that is allowed show red, below the nominal one amber."""
    area = block.cells(heading)
    first = area.split(":")[0]
    for limit, colour in ((low, RED_FILL), (nominal, AMBER_FILL)):
        rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}<{limit:g})"], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)

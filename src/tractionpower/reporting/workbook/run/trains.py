"""The sheets of trains: what became of each and what it took, and where its energy went."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.model.limits import USEFUL_NAMES
from tractionpower.model.line import Line
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Part
from tractionpower.movement.compile import train_of
from tractionpower.movement.formation import form
from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.common.accepted import tolerance_name
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL
from tractionpower.reporting.workbook.frame.facts import STATES, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.frame.rules import Rule
from tractionpower.reporting.workbook.run.sums import add_sums, number, total
from tractionpower.reporting.workbook.run.timetable import colour_late
from tractionpower.results.spells import TOLERANCE_V

NEAR_KM = 0.05
"""A run that begins or ends so near a station is said to be there [km]."""

ENERGIES = {
    "taken": "energy_taken_kwh",
    "returned": "energy_returned_kwh",
    "auxiliary": "auxiliary_energy_kwh",
    "drive": "drive_loss_kwh",
    "starting": "starting_resistor_energy_kwh",
    "refused": "refused_energy_kwh",
}
"""Key figures of the energies of a train by the keys of their columns."""

NET, SPECIFIC = "{taken}-{returned}", "IF({mass}*{length}>0,1000*({taken}-{returned})/({mass}*{length}),0)"

USEFUL = "train_useful_voltages"
"""Name of the mean useful voltages of the trains, in the order of the trains."""

_COLUMNS = (
    Column("train", widest=22),
    Column("formation", widest=20),
    Column("from", widest=18),
    Column("to", widest=18),
    Column("what became of it", widest=16),
    Column("entered", "time"),
    Column("left", "time"),
    Column("journey time [h:min:s]", "time"),
    Column("running time [h:min:s]", "time"),
    Column("late at end [s]", "0", key="late"),
    Column("length [km]", "0.000", key="length"),
    Column("mean speed [km/h]", "0.0"),
    Column("highest speed [km/h]", "0.0"),
    Column("energy taken [kWh]", "0.0", key="taken"),
    Column("energy returned [kWh]", "0.0", key="returned"),
    Column("net energy [kWh]", "0.0", key="net"),
    Column("highest current [A]", "0"),
    Column("lowest voltage [V]", "0", key="lowest"),
    Column("mean useful voltage [V]", "0", key="useful"),
)

_ENERGY_COLUMNS = (
    Column("train", widest=34),
    Column("category", widest=20, key="category"),
    Column("mass [t]", "0", key="mass"),
    Column("length [km]", "0.000", key="length"),
    Column("gross [t km]", "0", key="tkm"),
    Column("taken [kWh]", "0.0", key="taken"),
    Column("returned [kWh]", "0.0", key="returned"),
    Column("net [kWh]", "0.0", key="net"),
    Column("net, specific [Wh/(t km)]", "0.0", key="specific"),
    Column("auxiliaries and heating [kWh]", "0.0", key="auxiliary"),
    Column("losses of the drive [kWh]", "0.0", key="drive"),
    Column("starting resistors [kWh]", "0.0", key="starting"),
    Column("braking energy refused by the line [kWh]", "0.0", key="refused"),
    Column("returned of what the brake offered [%]", "0.0", key="share"),
)


def add(book: Book) -> None:
    """Add the sheets of trains, if there are any."""
    if book.facts.trains:
        _journeys(book)
        _energies(book)


def place_of(train: dict[str, Any]) -> str:
    """Return the place of the key figures of a train."""
    return f"train {train['train']}"


def category_of(facts: Facts, name: str) -> str:
    """Return the category of a run, or else of its train; a dash without one."""
    run = facts.runs.get(name)
    if run is None:
        return "–"
    return run.category or train_of(run, facts.scenario.trains).category or "–"


def mass_t(facts: Facts, name: str) -> float | None:
    """Return the mass of a train with its load [t]; None where the timetable does not have it."""
    run = facts.runs.get(name)
    if run is None:
        return None
    vehicles = {vehicle.id: vehicle for vehicle in facts.scenario.vehicles}
    return form(train_of(run, facts.scenario.trains), vehicles).mass_kg / 1000.0


def useful_name(facts: Facts) -> str:
    """Return the name of the limit of the mean useful voltage on lines of this class."""
    return USEFUL_NAMES[facts.scenario.sizing.useful_voltage.line_class]


def _journeys(book: Book) -> None:
    facts = book.facts
    page = book.page("Trains", "Trains")
    page.note(
        "Times of day go beyond 24:00:00 on the next day. Late: simulated less planned time at the last timed call, negative is"
        " early. Mean useful voltage: current-weighted, from sheet Voltages. Voltages below the limit are red. Net is what is"
        " taken less what is returned; sums and net are formulas."
    )
    rows = [_journey(facts, train, number_) for number_, train in enumerate(facts.trains, 1)]
    block = page.table(_COLUMNS, rows, frozen=True)
    add_sums(page, block, {"length": "0.000", "taken": "0.0", "returned": "0.0", "net": "0.0"}, rows)
    if any(number(row[block.column("late") - 1]) is not None for row in rows):
        colour_late(book, page, block.cells("late"))
    colour_low(book, page, block.cells("lowest"), "u_min2")
    colour_low(book, page, block.cells("useful"), useful_name(facts))


def colour_low(book: Book, page: Page, area: str, limit: str) -> None:
    """Let voltages below a limit show red, in the cell that has it; a voltage below the nominal one is nothing to warn of."""
    found = book.facts.limit(limit)
    if found is not None:
        name = f"limit_{limit}"
        slack = tolerance_name(name)
        test = f"{{cell}}<{{{name}}}-N({{{slack}}})"
        book.rules.append(Rule(page.sheet, area, test, RED_FILL, {name: found.value, slack: TOLERANCE_V}))


def _journey(facts: Facts, train: dict[str, Any], number_: int) -> list[Any]:
    name, place = str(train["train"]), place_of(train)
    run = facts.runs.get(name)
    formation = "" if run is None else run.train or formation_in_words(run.vehicles)
    state = str(train.get("status", ""))

    def figure(which: str) -> float | None:
        return facts.value(place, which)

    taken, returned = figure("energy_taken_kwh"), figure("energy_returned_kwh")
    useful = figure("mean_useful_voltage_current_weighted_v")
    return [
        name, formation, *route_in_words(run, facts.scenario.line), tr(STATES.get(state, state)),
        train.get("entered_s"), train.get("finished_s"), figure("journey_time_s"), figure("running_time_s"),
        figure("late_at_end_s"), figure("length_km"), figure("mean_speed_kmh"), figure("highest_speed_kmh"),
        taken, returned, net_of(taken, returned), figure("highest_current_a"), figure("lowest_pantograph_voltage_v"),
        None if useful is None else Formula(f"INDEX({{{USEFUL}}},{number_})", useful),
    ]  # fmt: skip


def net_of(taken: float | None, returned: float | None) -> Formula | None:
    """Return what is taken less what is returned."""
    return None if taken is None else Formula(NET, taken - (returned or 0.0))


def specific_of(taken: float | None, returned: float | None, mass: float | None, length: float | None) -> Formula | None:
    """Return the net energy for each tonne and kilometre [Wh/(t km)]."""
    if taken is None or not mass or not length:
        return None
    return Formula(SPECIFIC, 1000.0 * (taken - (returned or 0.0)) / (mass * length))


def _energies(book: Book) -> None:
    facts = book.facts
    if not any(facts.value(place_of(train), "energy_taken_kwh") is not None for train in facts.trains):
        return
    page = book.page("Train energy", "Energy of trains")
    page.note(
        "Energies at the pantograph. Gross tonne-kilometres count the mass with load. The brake offers what it returns and what"
        " the line does not take. Sums, net, specific values and shares are formulas."
    )
    rows = [_energy(facts, train) for train in facts.trains]
    block = page.table(_ENERGY_COLUMNS, rows, frozen=True)
    sums = ("length", "tkm", *ENERGIES, "net")
    text, offered = "IF({returned}+{refused}>0,100*{returned}/({returned}+{refused}),0)", {}
    for key in ("returned", "refused", "net", "tkm"):
        offered[key] = total(row[block.column(key) - 1] for row in rows)
    back = offered["returned"] + offered["refused"]
    row = add_sums(
        page, block, {key: "0.000" if key == "length" else "0.0" for key in sums}, rows,
        share=Formula(text, 100.0 * offered["returned"] / back if back > 0.0 else 0.0),
        specific=Formula("IF({tkm}>0,1000*{net}/{tkm},0)", 1000.0 * offered["net"] / offered["tkm"] if offered["tkm"] else 0.0),
    )  # fmt: skip
    for key in ("category", "tkm", "net", *ENERGIES):
        book.define(f"trains_{key}", page, block.cells(key))
        if key != "category":
            book.define(f"trains_all_{key}", page, block.cell(key, row))


def _energy(facts: Facts, train: dict[str, Any]) -> list[Any]:
    name, place = str(train["train"]), place_of(train)
    mass, length = mass_t(facts, name), facts.value(place, "length_km")
    found = {key: facts.value(place, figure) for key, figure in ENERGIES.items()}
    known = {key: value or 0.0 for key, value in found.items()}
    offered = known["returned"] + known["refused"]
    share = Formula("100*{returned}/({returned}+{refused})", 100.0 * known["returned"] / offered) if offered > 0.0 else None
    gross = None if mass is None or length is None else Formula("{mass}*{length}", mass * length)
    taken, returned = found["taken"], found["returned"]
    return [
        name, category_of(facts, name), mass, length, gross, taken, returned, net_of(taken, returned),
        specific_of(taken, returned, mass, length), *(found[key] for key in ("auxiliary", "drive", "starting", "refused")), share,
    ]  # fmt: skip


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
    return recorded(f"track {track}, km {km:g}")


def formation_in_words(parts: Sequence[Part]) -> str:
    """Return the vehicles of a train from its front, with their load and whether they are hauled."""
    words = []
    for part in parts:
        load = tr(", {percent} % loaded", percent=f"{part.load_percent:g}") if part.load_percent else ""
        hauled = "" if part.powered else tr(", hauled")
        words.append(f"{part.count} × {part.id}{load}{hauled}")
    return " + ".join(words)

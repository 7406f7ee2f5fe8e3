"""The sheet of substations and loads: energies and their shares, peaks, sliding windows, demand by the clock; supply points."""

from __future__ import annotations

import re

from tractionpower.model.base import format_time, parse_time
from tractionpower.model.supply import Substation
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import bars
from tractionpower.reporting.workbook.run.judged import judge
from tractionpower.reporting.workbook.run.sums import add_sums, number, total, without_empty
from tractionpower.reporting.workbook.run.trains import colour_low, useful_name
from tractionpower.reporting.workbook.run.voltages import PLAIN, WEIGHTED, quotient

STATES = {
    "in_service": mark("in service"),
    "rectifiers_out": mark("rectifiers out"),
    "bypassed": mark("bypassed"),
    "open": mark("open"),
}

_ENERGIES = (
    Column("substation", widest=24),
    Column("place [km]", "0.000"),
    Column("normal state", "beside", 16),
    Column("energy at the busbars [kWh]", "0.0", key="energy"),
    Column("share of all [%]", "0.0", key="share"),
    Column("of it fed back [kWh]", "0.0", key="back"),
    Column("mean current [A]", "0"),
    Column("RMS current of the run [A]", "0"),
    Column("highest power [kW]", "0", key="power"),
    Column("time of highest power", "time"),
    Column("highest current [A]", "0", key="current"),
    Column("time of highest current", "time"),
    Column("mean of highest power [%]", "0.0", key="factor"),
    Column("highest 15 min demand by the clock [kW]", "0", key="demand"),
    Column("start of this demand", "time"),
)
_PLANTS = (
    Column("substation", widest=24),
    Column("no-load voltage [V]", "0"),
    Column("internal resistance [Ω]", "0.0000"),
    Column("lowest busbar voltage [V]", "0.0", key="lowest"),
    Column("time of lowest voltage", "time"),
    Column("mean busbar voltage [V]", "0.0"),
    Column("rectifier units", "0"),
    Column("supply point", "beside", 24),
    Column("contract [kW]", "0"),
    Column("out by events", "beside", 40),
)
_ZONES = (
    Column("zone", widest=34),
    Column("sum over trains of mean U |I| [kW]", "0.0", key="power"),
    Column("sum over trains of mean |I| [A]", "0.0", key="current"),
    Column("mean useful voltage, current-weighted [V]", "0.0", key="weighted"),
    Column("sum U dt of all trains [V s]", "0", key="volts"),
    Column("time of all trains [s]", "0", key="seconds"),
    Column("mean useful voltage, time mean [V]", "0.0", key="plain"),
)
_POINTS = (
    Column("supply point", widest=24, key="point"),
    Column("substations", widest=40),
    Column("energy at the busbars [kWh]", "0.0", key="energy"),
    Column("share of all [%]", "0.0", key="share"),
    Column("contract [kW]", "0"),
)
_LOADS = (
    Column("load", widest=24),
    Column("place [km]", "0.000"),
    Column("track", "beside", 10),
    Column("energy [kWh]", "0.0", key="energy"),
    Column("share of all [%]", "0.0", key="share"),
)

BUSBARS = "busbar_energy"
"""Name of the sum of the energies of all substations at their busbars [kWh]."""

_WINDOWED = {
    mark("Sliding mean power: the highest mean of each window [kW]"): re.compile(r"highest_mean_power_(\d+)_(s|min|h)_kw"),
    mark("Sliding RMS current: the highest root mean square of each window [A]"): re.compile(
        r"highest_rms_current_(\d+)_(s|min|h)_a"
    ),
}
_SECONDS = {"s": 1, "min": 60, "h": 3600}


def add(book: Book) -> None:
    """Add the sheet of substations, if there are any; loads stand there, too."""
    facts = book.facts
    if not (facts.scenario.supply.substations or facts.scenario.supply.loads):
        return
    page = book.page("Substations", "Substations and loads")
    page.note(
        "Power is that at the busbars, means of a step. A window longer than the run is not told. A time of a window or by the"
        " clock is the start of the period. Sums and shares are formulas."
    )
    if facts.scenario.supply.substations:
        page.next += 1
        page.section("Energies and peaks")
        main = _energies(page)
        _plants(page)
        page.new_page()
        tables = [block for title, pattern in _WINDOWED.items() if (block := _windows(page, facts, title, pattern))]
        page.new_page()
        _points(page)
        _zones(page)
        if facts.scenario.supply.loads:
            _loads(page)
        _chart(page, main, tables[0] if tables else None)
    else:
        _loads(page)


def ordered(facts: Facts) -> list[Substation]:
    """Return the substations along the line."""
    return sorted(facts.scenario.supply.substations, key=lambda s: (s.km, s.id))


def windows_of(facts: Facts, pattern: re.Pattern[str]) -> list[tuple[str, str]]:
    """Return key figure and heading of every window that some substation has, from the shortest on."""
    found = {}
    for place, figures in facts.places.items():
        for name in figures if place.startswith("substation ") else ():
            if match := pattern.fullmatch(name):
                found[name] = (int(match[1]) * _SECONDS[match[2]], f"{match[1]} {match[2]}")
    return [(name, found[name][1]) for name in sorted(found, key=lambda name: found[name])]


def _energies(page: Page) -> Block:
    facts = page.book.facts
    energies = {s.id: facts.value(f"substation {s.id}", "energy_kwh") for s in ordered(facts)}
    whole = total(energies.values())
    hours = _hours(facts)
    rows = []
    for s in ordered(facts):
        place, energy = f"substation {s.id}", energies[s.id]
        power = facts.value(place, "highest_power_kw")
        mean = f"100*{{energy}}/({hours!r}*{{power}})"
        factor = Formula(mean, 100.0 * energy / (hours * power)) if energy is not None and power and hours > 0.0 else None
        rows.append(
            [
                s.id, s.km, tr(STATES[s.state]), energy, share_of(energy, whole, BUSBARS),
                facts.value(place, "energy_fed_back_kwh"), facts.value(place, "mean_current_a"),
                facts.value(place, "rms_current_a"), power, parse_time(facts.when(place, "highest_power_kw")),
                facts.value(place, "highest_current_a"), parse_time(facts.when(place, "highest_current_a")), factor,
                facts.value(place, "highest_clock_15_min_power_kw"),
                parse_time(facts.when(place, "highest_clock_15_min_power_kw")),
            ]
        )  # fmt: skip
    columns, rows = without_empty(_ENERGIES, rows, ("energy", "share", "power"))
    block = page.table(columns, rows)
    row = add_sums(page, block, {"energy": "0.0", "share": "0.0"}, rows)
    page.book.define(BUSBARS, page, block.cell("energy", row))
    page.book.define("substation_energies", page, block.cells("energy"))
    page.note("Demand of all substations together is not the sum of these peaks, which come at different times.")
    page.next += 1
    return block


def share_of(value: float | None, whole: float, name: str, key: str = "energy") -> Formula | None:
    """Return a cell's share of a named sum [%]."""
    if value is None:
        return None
    return Formula(f"IF({{{name}}}=0,0,100*{{{key}}}/{{{name}}})", 100.0 * value / whole if whole else 0.0)


def _hours(facts: Facts) -> float:
    """Return the time that counts in energies and means [h]."""
    clock, run = facts.scenario.clock, facts.run
    return max(0.0, int(run.get("steps", 0)) * clock.step_s - (clock.warm_up or 0.0)) / 3600.0


def _plants(page: Page) -> None:
    facts = page.book.facts
    page.section("Plants and busbars")
    rows = []
    for s in ordered(facts):
        place = f"substation {s.id}"
        rows.append(
            [
                s.id, s.no_load_voltage_v * s.grid_voltage_pu, s.plant_resistance_ohm,
                facts.value(place, "lowest_busbar_voltage_v"), parse_time(facts.when(place, "lowest_busbar_voltage_v")),
                facts.value(place, "mean_busbar_voltage_v"), s.units, s.supply_point or "", s.contract_power_kw,
                _events(facts, s.id),
            ]
        )  # fmt: skip
    block = page.table(*without_empty(_PLANTS, rows, ("lowest",)))
    colour_low(page.book, page, block.cells("lowest"), "u_min2")


def _events(facts: Facts, substation: str) -> str:
    """Return in words what switch events do to a substation."""
    told = []
    for event in sorted(facts.scenario.supply.switch_events, key=lambda event: event.time):
        if event.device == substation:
            units = tr("{count} units in service", count=event.units_in_service)
            state = units if event.state is None else tr(STATES.get(event.state, event.state))
            told.append(f"{format_time(event.time)} {state}")
    return "; ".join(told)


def _windows(page: Page, facts: Facts, title: str, pattern: re.Pattern[str]) -> Block | None:
    windows = windows_of(facts, pattern)
    if not windows:
        return None
    page.section(title)
    columns = [Column("substation", widest=24), *(Column(heading, "0", key=name) for name, heading in windows)]
    rows = [[s.id, *(facts.value(f"substation {s.id}", name) for name, _ in windows)] for s in ordered(facts)]
    return page.table(columns, rows)


def _points(page: Page) -> None:
    """Write the energies of supply points, where the study has some: sums over their substations."""
    facts = page.book.facts
    points: dict[str, list[int]] = {}
    for k, s in enumerate(ordered(facts)):
        if s.supply_point is not None:
            points.setdefault(s.supply_point, []).append(k)
    if not points:
        return
    page.section("Supply points")
    page.note("Energies at the busbars of their substations; losses of transformers and rectifiers come on top of them.")
    energies = [facts.value(f"substation {s.id}", "energy_kwh") for s in ordered(facts)]
    whole, rows = total(energies), []
    for point, members in points.items():
        value = total(energies[k] for k in members)
        text = "+".join(f"INDEX({{substation_energies}},{k + 1})" for k in members)
        own = [ordered(facts)[k] for k in members]
        contract = next((s.contract_power_kw for s in own if s.contract_power_kw is not None), None)
        rows.append([point, ", ".join(s.id for s in own), Formula(text, value), share_of(value, whole, BUSBARS), contract])
    page.table(_POINTS, rows)


def _zones(page: Page) -> None:
    """Write the mean useful voltages of the zones between substations, if trains ran there."""
    book, facts = page.book, page.book.facts
    zones = [place for place in facts.places if place.startswith("zone ")]
    if not zones:
        return
    page.section("Mean useful voltage of the zones between substations, by both definitions")
    page.note(
        "Current-weighted: every train counts by its means while it is in the zone. Time mean: over all trains and steps. Both"
        " are formulas, the quotients of the columns before them."
    )
    rows = []
    for zone in zones:
        names = ("useful_power_kw", "useful_current_a", "voltage_of_useful_steps_vs", "time_of_useful_steps_s")
        power, current, volts, seconds = (facts.value(zone, name) for name in names)
        weighted = quotient("1000*{power}/{current}", facts.value(zone, WEIGHTED), power, current)
        plain = quotient("{volts}/{seconds}", facts.value(zone, PLAIN), volts, seconds)
        rows.append([zone.removeprefix("zone "), power, current, weighted, volts, seconds, plain])
    block = page.table(_ZONES, rows)
    for key, words in (("weighted", "current-weighted"), ("plain", "time mean")):
        book.define(f"zone_voltages_{key}", page, block.cells(key))
        colour_low(book, page, block.cells(key), useful_name(facts))
        known = [value for row in rows if (value := number(row[block.column(key) - 1])) is not None]
        judge(book, f"mean useful voltage of zones, {words}", f"MIN({{zone_voltages_{key}}})", min(known, default=None))


def _loads(page: Page) -> None:
    facts = page.book.facts
    page.section("Loads")
    loads = sorted(facts.scenario.supply.loads, key=lambda load: (load.km, load.id))
    energies = [facts.value(f"load {load.id}", "load_energy_kwh") for load in loads]
    whole = total(energies)
    rows = [
        [load.id, load.km, load.track, energy, share_of(energy, whole, "loads_energy")]
        for load, energy in zip(loads, energies, strict=True)
    ]
    block = page.table(_LOADS, rows)
    row = add_sums(page, block, {"energy": "0.0", "share": "0.0"}, rows)
    page.book.define("loads_energy", page, block.cell("energy", row))


def _chart(page: Page, main: Block, windows: Block | None) -> None:
    """Draw the peaks as bars: of a step, or of the windows that suit a transformer."""
    wanted = ("10 s", "1 min", "15 min", "60 min")
    headings = [heading for heading in wanted if windows is not None and heading in windows.headings]
    if windows is not None and headings:
        title = tr("Highest mean power of substations by window")
        chart = bars(title, tr("power [kW]"), windows, "substation", headings)
    elif any(main.sheet[main.cell("power", row)].value is not None for row in range(main.first, main.last + 1)):
        chart = bars(tr("Highest power of substations"), tr("power [kW]"), main, "substation", ["highest power [kW]"])
    else:
        return
    page.new_page_for_chart()
    page.chart(chart)

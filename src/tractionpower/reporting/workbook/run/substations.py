"""The sheet of substations and loads: energies, peaks, sliding windows, demand by the clock."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from tractionpower.model.base import format_time, parse_time
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Block, Column, Page, heading_of
from tractionpower.reporting.workbook.frame.plots import bars

_FIGURES = {
    "energy_kwh": "0.0",
    "mean_current_a": "0",
    "rms_current_a": "0",
    "highest_current_a": "0",
    "highest_power_kw": "0",
    "highest_clock_15_min_power_kw": "0",
}
_HEADINGS = {"highest_clock_15_min_power_kw": "highest 15 min demand by the clock [kW]"}
_TIMED = ("highest_current_a", "highest_power_kw", "highest_clock_15_min_power_kw")

_USEFUL = ("mean_useful_voltage_current_weighted_v", "mean_useful_voltage_time_mean_v")

_WINDOWED = {
    "Sliding mean power: the highest mean of each window [kW]": re.compile(r"highest_mean_power_(\d+)_(s|min|h)_kw"),
    "Sliding RMS current: the highest root mean square of each window [A]": re.compile(r"highest_rms_current_(\d+)_(s|min|h)_a"),
}
_SECONDS = {"s": 1, "min": 60, "h": 3600}


def add(book: Book) -> None:
    """Add the sheet of substations, if there are any; loads stand there, too."""
    facts = book.facts
    if not (facts.scenario.supply.substations or facts.scenario.supply.loads):
        return
    page = book.page("Substations", "Substations and loads")
    page.note(
        "Power is that at the busbars. A window longer than the run is not told. A time by the clock is the start of the period."
    )
    if facts.scenario.supply.substations:
        page.section("Energies and peaks")
        main = page.table(*_main(facts))
        tables = [block for title, pattern in _WINDOWED.items() if (block := _windows(page, facts, title, pattern))]
        _zones(page, facts)
        if facts.scenario.supply.loads:
            _loads(page, facts)
        _chart(page, main, tables[0] if tables else None)
    elif facts.scenario.supply.loads:
        _loads(page, facts)


def windows_of(facts: Facts, pattern: re.Pattern[str]) -> list[tuple[str, str]]:
    """Return key figure and heading of every window that some substation has, from the shortest on."""
    found = {}
    for place, figures in facts.places.items():
        for name in figures if place.startswith("substation ") else ():
            if match := pattern.fullmatch(name):
                found[name] = (int(match[1]) * _SECONDS[match[2]], f"{match[1]} {match[2]}")
    return [(name, found[name][1]) for name in sorted(found, key=lambda name: found[name])]


def _main(facts: Facts) -> tuple[list[Column], list[list[Any]]]:
    columns = [Column("substation", widest=24), Column("place [km]", "0.000"), Column("normal state")]
    events = {s.id: _events(facts, s.id) for s in facts.scenario.supply.substations}
    if any(events.values()):
        columns.append(Column("out by events", widest=40))
    columns += [Column(heading_of("no_load_voltage_v"), "0"), Column(heading_of("internal_resistance_ohm"), "general")]
    getters: list[Callable[[str], Any]] = []
    for name, style in _FIGURES.items():
        if not any(facts.value(f"substation {s.id}", name) is not None for s in facts.scenario.supply.substations):
            continue
        columns.append(Column(_HEADINGS.get(name, heading_of(name)), style))
        getters.append(lambda place, name=name: facts.value(place, name))  # type: ignore[misc]
        if name in _TIMED:
            columns.append(Column(f"time of {heading_of(name).split(' [')[0]}", "time"))
            getters.append(lambda place, name=name: parse_time(facts.when(place, name)))  # type: ignore[misc]
    rows = [
        [s.id, s.km, s.state.replace("_", " "), *([events[s.id]] if any(events.values()) else [])]
        + [s.no_load_voltage_v, s.plant_resistance_ohm]
        + [get(f"substation {s.id}") for get in getters]
        for s in sorted(facts.scenario.supply.substations, key=lambda s: (s.km, s.id))
    ]
    return columns, rows


def _events(facts: Facts, substation: str) -> str:
    """Return in words what switch events do to a substation."""
    told = []
    for event in sorted(facts.scenario.supply.switch_events, key=lambda event: event.time):
        if event.device == substation:
            units = f"{event.units_in_service} units in service"
            told.append(f"{format_time(event.time)} {units if event.state is None else event.state.replace('_', ' ')}")
    return "; ".join(told)


def _windows(page: Page, facts: Facts, title: str, pattern: re.Pattern[str]) -> Block | None:
    windows = windows_of(facts, pattern)
    if not windows:
        return None
    page.section(title)
    columns = [Column("substation", widest=24), *(Column(heading, "0") for _, heading in windows)]
    ordered = sorted(facts.scenario.supply.substations, key=lambda s: (s.km, s.id))
    return page.table(columns, [[s.id, *(facts.value(f"substation {s.id}", name) for name, _ in windows)] for s in ordered])


def _zones(page: Page, facts: Facts) -> None:
    """Write the mean useful voltages of the zones between substations, if trains ran there."""
    zones = [place for place in facts.places if place.startswith("zone ")]
    if not zones:
        return
    page.section("Mean useful voltage of the zones between substations, by both definitions")
    columns = [
        Column("zone", widest=34),
        *(Column(heading_of(name).replace("mean useful voltage ", ""), "0") for name in _USEFUL),
    ]
    page.table(columns, [[zone.removeprefix("zone "), *(facts.value(zone, name) for name in _USEFUL)] for zone in zones])


def _loads(page: Page, facts: Facts) -> None:
    page.section("Loads")
    columns = [Column("load", widest=24), Column("place [km]", "0.000"), Column("track"), Column("energy [kWh]", "0.0")]
    loads = sorted(facts.scenario.supply.loads, key=lambda load: (load.km, load.id))
    page.table(columns, [[load.id, load.km, load.track, facts.value(f"load {load.id}", "load_energy_kwh")] for load in loads])


def _chart(page: Page, main: Block, windows: Block | None) -> None:
    """Draw the peaks as bars: of a step, or of the windows that suit a transformer."""
    wanted = ("10 s", "1 min", "15 min", "60 min")
    headings = [heading for heading in wanted if windows is not None and heading in windows.headings]
    if windows is not None and headings:
        chart = bars("Highest mean power of substations by window", "power [kW]", windows, "substation", headings)
    elif heading_of("highest_power_kw") in main.headings:
        chart = bars("Highest power of substations", "power [kW]", main, "substation", [heading_of("highest_power_kw")])
    else:
        return
    page.new_page()
    page.chart(chart)

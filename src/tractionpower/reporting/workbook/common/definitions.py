"""The sheet of definitions: what every key figure and every column of the tables means, how it is computed, by which source."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.model.quantity import unit_of
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.results.columns import TABLES
from tractionpower.results.dynamics_columns import DYNAMICS_TABLES
from tractionpower.studies.sweep.differences import FIGURES

_FIGURES = (
    Column("figure", widest=46),
    Column("unit"),
    Column("of", widest=34),
    Column("how it is computed", "beside", widest=90),
    Column("defined by", widest=50),
    Column("name in key_figures.json", widest=46),
)
_COLUMNS = (
    Column("table", widest=20),
    Column("column", widest=36),
    Column("unit"),
    Column("meaning", "beside", widest=100),
    Column("name in files", widest=36),
)

OF = {
    "train ": mark("each train"),
    "substation ": mark("each substation"),
    "feeder ": mark("each feeder"),
    "section cabin ": mark("each feeder of a section cabin"),
    "switch ": mark("each switch"),
    "load ": mark("each fixed load"),
    "zone ": mark("each feeding zone"),
    "earthing ": mark("each earthing"),
    "voltage-limiting device ": mark("each voltage-limiting device"),
    "supply point ": mark("each supply point"),
    "case ": mark("each case"),
    "coupling ": mark("the worst coupling"),
    "vehicle ": mark("the worst vehicle"),
    "stop ": mark("each stop"),
}
"""What a figure is told of, by how its place begins."""

RUN, WORST = mark("the whole run"), mark("the worst of the run")

OF_RUN = (
    "lowest_voltage_v", "highest_voltage_v", "longest_spell", "lowest_useful_voltage", "utilisation_percent", "breaker_share",
    "least_reserve", "rail_potential_v", "lowest_rail", "highest_rail", "lowest_mean_rail", "highest_mean_rail",
    "highest_mean_stray",
)  # fmt: skip
"""How figures begin that are told once, with the place where they came about."""

SOURCES = {
    "mean_useful_voltage_current_weighted": mark("EN 50388 (2005, 2012) as recalled; public design tool for Polish supply areas"),
    "mean_useful_voltage_time_mean": mark("EN 50388:2022, annex B, as public evaluation scripts compute it"),
    "lowest_useful_voltage": mark("EN 50388, both definitions; the text of the standard is not at hand"),
    "lowest_voltage": mark("EN 50163, U_min2; secondary"),
    "highest_voltage": mark("EN 50163, U_max2; secondary"),
    "longest_spell_above_touch": mark("EN 50122-1, touch voltages; secondary"),
    "longest_spell": mark("EN 50163, durations; secondary"),
    "highest_mean_stray_current": mark("EN 50122-2, stray current; recalled"),
    "lowest_mean_rail_potential": mark("EN 50122-2, shift of the rail potential; recalled"),
    "highest_mean_rail_potential": mark("EN 50122-2, shift of the rail potential; recalled"),
    "utilisation": mark("duty classes of IEC 60146-1-1, recalled; ratings of the inputs"),
    "highest_clock_15_min": mark("quarter-hour demand of the grid operator, by the clock"),
    "highest_demand": mark("quarter-hour demand of the grid operator, by the clock"),
}
"""Standard or practice that a figure follows, by how its name begins; the first that fits."""

MEANS = mark("Voltages, currents and powers are means of a time step. Without an entry under defined by: the program's own.")
STEPS = mark(
    "Tables that these results have, as Parquet files beside this workbook. A row of a time describes the step that begins"
    " then; currents and powers are positive when a train or load takes them, and when a substation feeds."
)
SINCE_THE_START = mark("Times count from the start of the case. Without an entry under defined by: the program's own.")
NOTES = {
    "dynamics": (
        SINCE_THE_START,
        mark(
            "Tables that these results have, as Parquet files beside this workbook. A row of a time describes that instant. A"
            " force in a"
            " coupling is positive in tension; brakes, resistance and gradient are positive against the direction of travel."
        ),
    ),
    "stations": (
        SINCE_THE_START,
        mark(
            "Tables that these results have, as Parquet files beside this workbook. A row of a time describes that instant."
            " Places are those of the front of a train, from where trains come."
        ),
    ),
}
"""Notes of the two sheets by the kind of results, those of train dynamics apart."""

OWN_WORDS = {"coupling": mark("coupling between vehicles"), "level": mark("control level")}
"""Columns of train dynamics whose names mean something else in other tables."""


def add(book: Book) -> None:
    """Add the sheets of definitions: of the key figures, and of the columns of the tables that these results have."""
    figures, notes = list(_figures(book)), NOTES.get(str(book.computed.run.get("kind")), (MEANS, STEPS))
    if figures:
        page = book.page("Definitions", "Definitions of the key figures")
        page.note(notes[0])
        page.table(_FIGURES, figures, frozen=True)
    columns = list(_columns(book))
    if columns:
        page = book.page("Columns", "Definitions of the columns of the tables")
        page.note(notes[1])
        page.table(_COLUMNS, columns, frozen=True)


def _figures(book: Book) -> Iterator[tuple[str, ...]]:
    """Yield every key figure once for each definition that it has."""
    places: dict[tuple[str, str], list[str]] = {}
    units: dict[tuple[str, str], str] = {}
    for figure in book.computed.results.key_figures:
        key = (figure["name"], figure.get("definition", ""))
        places.setdefault(key, []).append(figure.get("place") or "")
        units[key] = figure.get("unit", "")
    for name, definition, place in _of_many(book):
        places.setdefault((name, definition), []).append(place)
        units[name, definition] = unit_of(name)
    for (name, definition), where in places.items():
        of = ", ".join(tr(each) for each in _told_of(name, where))
        heading = heading_of(name).split(" [")[0]
        yield heading, units[name, definition], of, recorded(definition), _source(name), name


def _of_many(book: Book) -> Iterator[tuple[str, str, str]]:
    """Yield name, definition and place of the figures of a comparison, and of those of cases."""
    results, compared = book.computed.results, book.computed.run.get("compare") or {}
    told: dict[str, str] = compared.get("definitions", {})
    meanings = {column.quantity.name: column.quantity.meaning for column in TABLES["cases"] if column.quantity.name in FIGURES}
    if compared and "compare" in results.tables:
        rows = results.table("compare", ("figure", "place")).astype(str).drop_duplicates()
        for name, place in rows.itertuples(index=False):
            words = meanings.get(name, "") if place.startswith("case ") else told.get(name, "")
            if words:
                yield name, words, place
    if "cases" in results.tables and not results.key_figures:
        rows = results.table("cases")
        yield from ((name, words, "case ") for name, words in meanings.items() if rows[name].notna().any())


def _told_of(name: str, places: list[str]) -> list[str]:
    """Return what a figure with these places is told of."""
    if name.startswith(OF_RUN) and not all(place.startswith("case ") for place in places):
        return [WORST]
    found = (next((words for begin, words in OF.items() if place.startswith(begin)), RUN) for place in places)
    return list(dict.fromkeys(found))


def _source(name: str) -> str:
    return next((tr(source) for begin, source in SOURCES.items() if name.startswith(begin)), "")


def _columns(book: Book) -> Iterator[tuple[str, ...]]:
    present = set(book.computed.results.tables)
    for table, columns in TABLES.items():
        for column in columns if table in present else ():
            quantity = column.quantity
            called = OWN_WORDS.get(quantity.name, "") if table in DYNAMICS_TABLES else ""
            heading = tr(called) if called else heading_of(quantity.name).split(" [")[0]
            yield recorded(table.replace("_", " ")), heading, quantity.unit, recorded(quantity.meaning), quantity.name

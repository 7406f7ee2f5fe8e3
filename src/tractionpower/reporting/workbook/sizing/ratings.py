"""The sheets of ratings: utilisation of every device in the window that rules, and in all windows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.facts.device_words import KINDS, kind_order
from tractionpower.reporting.figures.supply.ratings_figures import TIGHT_PERCENT
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, PLAIN_FILL, RED_FILL, fill, put
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Block, Column, Page
from tractionpower.studies.ratings.words import window_words

USE, HOLDS = "utilisation [%]", "holds"
UNRATED = "not rated"

_DEVICE = (
    Column("device", widest=34),
    Column("kind", widest=28),
    Column("station", widest=22),
    Column("track"),
    Column("from [km]", "0.000"),
    Column("to [km]", "0.000"),
)
_LOAD = (
    Column("load: highest RMS in it [A]", "0"),
    Column("permitted in it [A]", "0"),
    Column(USE, "0.0"),
    Column("left [A]", "0"),
    Column(HOLDS, "beside"),
    Column("that window begins", "time"),
)
_SOURCE = (Column("status of the rating", "beside", 24), Column("source", "0"))

KNOWN = KNOWN_AS | {"derived": "derived from other inputs"}


def add(book: Book) -> None:
    """Add the sheets, if the run has ratings."""
    rows = book.facts.table("ratings")
    if rows.empty:
        return
    rows = in_order(rows)
    permitted = book.facts.scenario.sizing.utilisation_percent
    page = book.page("Ratings", "Ratings: what every device carries, and what it may")
    ruling = one_for_each(rows)
    sentence, style = ratings_in_words(ruling, permitted)
    banner(page, sentence, style)
    page.note(
        "For every device the window that rules: that with the highest utilisation. The load is the highest sliding root mean"
        " square of the current over the window; permitted is the rated current times the multiple that the duty class permits"
        f" for it. A device holds up to {permitted:g} % of that; amber from {TIGHT_PERCENT:g} % of it on."
        " A device without a rating shows its load over the whole run and is not judged. Ratings whose status is not 'verified'"
        " are editable values: devices are checked against those values, which is no statement about a standard."
    )
    columns = (
        *_DEVICE,
        Column("rated current [A]", "0"),
        Column("duty class", "beside", 16),
        Column("window that rules", "beside"),
    )
    block = page.table((*columns, *_LOAD, *_SOURCE), _ruling_rows(ruling), frozen=True)
    colour_use(block, USE, permitted)
    colour_word(block, HOLDS)
    _sources(page, ruling)
    _by_window(book, rows, permitted)


def in_order(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows of devices by kind and along the line."""
    kinds = rows["kind"].astype(str).map(kind_order).astype(int)
    return rows.assign(_kind=kinds).sort_values(["_kind", "from_km", "device"], kind="stable").drop(columns="_kind")


def places_of(facts: Facts) -> dict[str, tuple[int, float]]:
    """Return kind and place of every device, by which others than the ratings are ordered."""
    rows = facts.table("ratings")
    if rows.empty:
        return {}
    found = rows.drop_duplicates("device")
    places = zip(found["device"].astype(str), found["kind"].astype(str), found["from_km"], strict=True)
    return {device: (kind_order(kind), float(km)) for device, kind, km in places}


def one_for_each(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the ruling row of each device; of one without a rating that of the longest time."""
    unrated = ~rows["device"].isin(rows.loc[rows["ruling"], "device"])
    length = rows["window_s"].where(rows["window_s"] > 0.0, float("inf"))
    longest = length[unrated].groupby(rows.loc[unrated, "device"].astype(str)).idxmax()
    return rows[rows["ruling"] | rows.index.isin(longest)].drop_duplicates("device")


def ratings_in_words(ruling: pd.DataFrame, permitted: float) -> tuple[str, str]:
    """Return what the ratings say in a sentence, and the style that suits it."""
    rated = ruling[ruling["utilisation_percent"].notna()]
    bare = len(ruling) - len(rated)
    without = f"; {bare} more have no rating and are not judged" if bare else ""
    if rated.empty:
        return f"None of {len(ruling)} devices has a rating", "doubt"
    worst = rated.iloc[int(rated["utilisation_percent"].argmax())]
    words = f"{worst['device']}, {worst['utilisation_percent']:.0f} % in {_window(worst['window_s'])}"
    over = rated[rated["met"].astype(str) == "no"]
    if len(over):
        return f"{len(over)} of {len(rated)} rated devices beyond {permitted:g} %. Most: {words}{without}", "bad"
    return f"All {len(rated)} rated devices within {permitted:g} %. Most: {words}{without}", "good" if not bare else "neutral"


def _window(seconds: float) -> str:
    return "the whole run" if seconds == 0.0 else window_words(seconds)


def banner(page: Page, text: str, style: str) -> None:
    """Write a verdict in large letters across the page."""
    put(page.sheet, page.next, 1, text, page.styles[f"big {style}"])
    page.sheet.merge_cells(start_row=page.next, start_column=1, end_row=page.next, end_column=8)
    page.sheet.row_dimensions[page.next].height = LINE_POINTS * 1.5 * (1 + len(text) // 85) + 8.0
    page.next += 1


def _device(row: dict[Any, Any]) -> tuple[Any, ...]:
    kind = KINDS.get(str(row["kind"]), str(row["kind"]))
    return row["device"], kind, row["station"], row["track"], row["from_km"], row["to_km"]


def _load(row: dict[Any, Any]) -> tuple[Any, ...]:
    values = (row["load_a"], row["permitted_a"], row["utilisation_percent"], row["left_a"])
    return *values, str(row["met"]) or UNRATED, row["from_s"]


def _ruling_rows(ruling: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    numbers = _numbers(ruling)
    for row in ruling.to_dict("records"):
        status = str(row["status"])
        rated = (row["rated_current_a"], row["duty_class"], window_words(row["window_s"]))
        yield *_device(row), *rated, *_load(row), KNOWN.get(status, status), numbers.get((status, str(row["source"])))


def _numbers(ruling: pd.DataFrame) -> dict[tuple[str, str], int]:
    """Return a number for each source of ratings, which are too long to stand in every row."""
    pairs = zip(ruling["status"].astype(str), ruling["source"].astype(str), strict=True)
    return {pair: number for number, pair in enumerate(dict.fromkeys(pair for pair in pairs if pair[0]), 1)}


def _sources(page: Page, ruling: pd.DataFrame) -> None:
    """Write below the ratings where they come from."""
    numbers = _numbers(ruling)
    if not numbers:
        return
    page.section("Sources of the ratings")
    for (status, source), number in numbers.items():
        page.wrapped(f"{number}: {KNOWN.get(status, status)}. {source}")


def _by_window(book: Book, rows: pd.DataFrame, permitted: float) -> None:
    page = book.page("Ratings by window", "Ratings by window: the load of every device in every window")
    page.note("Sliding root mean square of the current. The window with the highest utilisation rules. 'Whole run': no window.")
    columns = (*_DEVICE[:2], Column("window", "beside"), Column("window [s]", "0"), *_LOAD, Column("rules", "beside"))
    cells = (
        (row["device"], KINDS.get(str(row["kind"]), row["kind"]), window_words(row["window_s"]), row["window_s"], *_load(row),
         "rules" if row["ruling"] else "")
        for row in rows.to_dict("records")
    )  # fmt: skip
    block = page.table(columns, cells, frozen=True)
    colour_use(block, USE, permitted)
    colour_word(block, HOLDS)


def colour_use(block: Block, heading: str, permitted: float) -> None:
    """Let a utilisation show green, amber when little is left, red when it is beyond what is permitted."""
    area = block.cells(heading)
    first = area.split(":")[0]
    tight = TIGHT_PERCENT / 100.0 * permitted
    for test, colour in ((f">{permitted:g}", RED_FILL), (f">{tight:g}", AMBER_FILL), (">=0", GREEN_FILL)):
        rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}{test})"], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)


def colour_word(block: Block, heading: str) -> None:
    """Let yes and no show green and red, what is not judged grey."""
    for word, colour in (("yes", GREEN_FILL), ("no", RED_FILL), (UNRATED, PLAIN_FILL)):
        rule = CellIsRule(operator="equal", formula=[f'"{word}"'], fill=fill(colour))
        block.sheet.conditional_formatting.add(block.cells(heading), rule)

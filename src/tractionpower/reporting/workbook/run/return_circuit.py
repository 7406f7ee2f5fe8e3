"""The sheets of the return circuit: touch voltages, stray currents, earthings; potentials along the line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd

from tractionpower.model.base import parse_time
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.acceptance import colour_words
from tractionpower.reporting.workbook.common.accepted import BY_LIMIT, OPEN, verdict_word
from tractionpower.reporting.workbook.common.verdicts import Comparison, same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import FIRST_PRINTED, Block, Column, Page, heading_of
from tractionpower.reporting.workbook.frame.plots import COLOURS, Line, draw, scatter
from tractionpower.results.stray import FORMATIONS
from tractionpower.results.verdicts import AT_MOST

MOST_DRAWN = 3
"""Return conductors in the chart."""

PLACE, TRACK = mark("place [km]"), mark("track")
_POTENTIALS = ("lowest_potential_v", "mean_potential_v", "highest_potential_v")
_WHICH = dict(zip(_POTENTIALS, (mark("lowest"), mark("mean"), mark("highest")), strict=True))
_PROFILE = {
    **dict.fromkeys(_POTENTIALS, "0.0"),
    "mean_leakage_a_per_km": "0.000",
    "mean_leaving_a_per_km": "0.000",
    "longest_above_limit_s": "0",
    "leakage_s_per_km": "0.0000",
    "length_km": "0.000",
}
_JUDGED = (
    Column("name of the limit", "beside", 20),
    Column("verdict", widest=14, key="verdict"),
    Column("status of the limit", widest=24),
    Column("source of the limit", widest=44),
)
_FIGURES = (
    "highest_rail_potential_v",
    "lowest_rail_potential_v",
    "highest_mean_rail_potential_v",
    "lowest_mean_rail_potential_v",
    "highest_mean_stray_current_ma_per_m",
    "mean_leaked_current_a",
    "highest_leaked_current_a",
    "leaked_charge_ah",
)
_KINDS = {"earthing": mark("earthing"), "voltage-limiting device": mark("voltage-limiting device")}
_DEVICE = {
    "highest_current_into_earth_a": "0.0",
    "lowest_current_into_earth_a": "0.0",
    "mean_current_into_earth_a": "0.00",
    "charge_through_earth_ah": "0.00",
    "time_with_earth_current_s": "0",
}


def add(book: Book) -> None:
    """Add the sheets of the return circuit, if its rails have a potential or lumping them was tried."""
    facts = book.facts
    told, lumping = facts.run.get("return_circuit"), facts.run.get("lumping")
    if not told and not lumping:
        return
    page = book.page("Return circuit", "Return circuit: rail potential, touch voltage, leakage and stray current")
    if told:
        page.note(
            "Potentials are those of the rails against remote earth, means of a step. They stand for the touch voltage, of which"
            " they are the upper bound. Limits are editable values of the limits table: no statement about a standard."
        )
        _key_figures(page, facts)
        _touch(page, told["touch_voltage"])
        _stray(page, facts, told["stray_current"])
        _devices(page, facts)
    if lumping:
        _lumping(page, lumping)
    if told:
        _profile(book, page)


# The tables stand below each other: texts, numbers and places are in the same columns of all.


def _key_figures(page: Page, facts: Facts) -> None:
    page.section("Whole run")
    columns = (
        Column("figure", widest=40), Column("value", "0.00"), Column("unit", "beside", 8), Column("time of day", "time"),
        Column("place", "beside", 36),
    )  # fmt: skip
    found = [f for name in _FIGURES for f in facts.results.key_figures if f["name"] == name]
    rows = [
        (heading_of(f["name"]).split(" [")[0], f["value"], f["unit"], parse_time(f["time"] or ""), recorded(f["place"] or ""))
        for f in found
    ]
    page.table(columns, rows)


def _judged(row: dict[str, Any], found: float | None, limit: float | None) -> tuple[Formula | str, str, str]:
    """Return the verdict, which follows the limit where numbers decide, and how the limit is known."""
    word: Formula | str = verdict_word(row)
    if row["met"] is not None and found is not None and limit is not None and (found <= limit) == row["met"]:
        word = Formula(Comparison("{found}", "{limit}", AT_MOST).verdict(BY_LIMIT), word)
    return word, tr(KNOWN_AS.get(row["status"], row["status"])), recorded(row["source"])


def _limit(name: str, value: float | None) -> Formula | float | None:
    """Return a limit as that of the sheet of acceptance, which can be edited there."""
    return None if value is None else Formula(same_as(f"{{{name}}}"), value)


def _touch(page: Page, rows: Sequence[dict[str, Any]]) -> None:
    page.section("Touch voltage: how long the potential, of either sign, stays above a voltage, and how long it may")
    page.note(
        "Between two durations of the table the voltage of the longer one holds, so a spell above a voltage may last as long as"
        " the next shorter duration. Durations below the step are not looked at. The voltage of workshops holds there only."
    )
    columns = (
        Column("limit", widest=40),
        Column("above [V]", "0"),
        Column("longest spell [s]", "0.0", key="found"),
        Column("may last [s]", "0.0", key="limit"),
        Column("place", "beside", 36),
        Column("begins at", "time"),
        *_JUDGED,
    )
    block = page.table(
        columns,
        [
            (
                recorded(row["meaning"]), row["voltage_v"], row["longest_s"],
                _limit(f"limit_{row['limit']}_s", row["may_last_s"]), recorded(row["place"] or ""),
                parse_time(row["time"] or ""), row["limit"],
                *_judged(row, row["longest_s"], row["may_last_s"]),
            )
            for row in rows
        ],
    )  # fmt: skip
    if rows:
        colour_words(block.sheet, block.cells("verdict"))


def _stray(page: Page, facts: Facts, rows: Sequence[dict[str, Any]]) -> None:
    if not rows:
        return
    page.section("Stray current: what needs no further study")
    if any(row["met"] is None for row in rows):
        page.note(
            tr("The values hold for the mean of a day. This run is shorter ({time}): {open}.", time=_hours(facts), open=tr(OPEN))
        )
    page.note(
        "Of a single track: the leakage of a conductor of several tracks is shared out to them. Steps in which current enters the"
        " rails count as zero in the stray current. The leakage conductance decides which mean potential a place is held against."
    )
    columns = (
        Column("what", widest=40),
        Column("found", "0.00", key="found"),
        Column("limit value", "0.0", key="limit"),
        Column("unit", "beside", 8),
        Column("worst place", widest=36),
        Column("track formation"),
        *_JUDGED,
    )
    formations = {f"stray_{what}_{formation}": formation for what in ("shift", "leakage") for formation in FORMATIONS}
    block = page.table(
        columns,
        [
            (
                recorded(row["name"]), row["value"], _limit(f"limit_{row['limit']}", row["limit_value"]), row["unit"],
                recorded(row["place"] or ""), recorded(formations.get(row["limit"], "")), row["limit"],
                *_judged(row, row["value"], row["limit_value"]),
            )
            for row in rows
        ],
    )  # fmt: skip
    colour_words(block.sheet, block.cells("verdict"))


def _hours(facts: Facts) -> str:
    clock, run = facts.scenario.clock, facts.run
    minutes = round((run.get("steps", 0) * clock.step_s - (clock.warm_up or 0.0)) / 60.0)
    return tr("{hours} h {minutes} min", hours=minutes // 60, minutes=f"{minutes % 60:02d}")


def _devices(page: Page, facts: Facts) -> None:
    supply = facts.scenario.supply
    earthed = [
        (f"earthing {each.id}", each.id, each.track or "", each.km, each.resistance_ohm, each.substation or "")
        for each in supply.earthing
    ]
    limiting = [
        (f"voltage-limiting device {each.id}", each.id, each.track, each.km, each.closed_resistance_ohm, "")
        for each in supply.voltage_limiting_devices
    ]
    if not earthed and not limiting:
        return
    page.section("Earthings and voltage-limiting devices")
    columns = [
        Column("device", widest=40), Column("resistance [Ω]", "general"), Column(PLACE, "0.000"), Column(TRACK),
        Column("kind", widest=36), *(Column(heading_of(name), style) for name, style in _DEVICE.items()),
    ]  # fmt: skip
    rows = []
    for place, name, track, km, ohm, busbar in (*earthed, *limiting):
        kind = tr(_KINDS[place.removesuffix(f" {name}")]) + (tr(", busbar of {substation}", substation=busbar) if busbar else "")
        rows.append([name, ohm, km, track, kind, *(facts.value(place, figure) for figure in _DEVICE)])
    page.table(columns, rows)


def _lumping(page: Page, lumping: dict[str, Any]) -> None:
    """Tell what error it would make to lump the rails into the contact line."""
    page.section("What lumping the rails into the contact lines would change, at the step with the lowest voltage of a train")
    low, lumped = lumping["voltage_v"], lumping["lumped_voltage_v"]
    columns = (
        Column("train", widest=40),
        Column("voltage [V]", "0.0", key="own"),
        Column("with lumped rails [V]", "0.0", key="lumped"),
        Column("error [V]", "0.0", key="error"),
        Column("largest error at any train or load [V]", "0.0"),
        Column("time of day", "time"),
    )
    row = (
        lumping["train"],
        low,
        lumped,
        Formula("{lumped}-{own}", lumped - low),
        lumping["largest_difference_v"],
        parse_time(lumping["time"]),
    )
    page.table(columns, [row])


def _profile(book: Book, front: Page) -> None:
    """Add the sheet of all places; the chart of their potentials goes to the front sheet."""
    frame = book.facts.table("rail_profile")
    if frame.empty:
        return
    page = book.page("Rail potential", "Rail potential and leakage along the line")
    page.note(
        "Lowest, mean and highest of all steps. The longest time is that above the permanent touch voltage. Leakage is that of"
        " the return conductor with all its tracks; times the length, summed up, it is that of the line."
    )
    columns = [Column(TRACK), Column(PLACE, "0.000"), *(Column(heading_of(name), style) for name, style in _PROFILE.items())]
    frame = frame.assign(track=frame["track"].astype(str)).sort_values(["track", "km"], kind="stable", ignore_index=True)
    block = page.table(columns, frame[["track", "km", *_PROFILE]].itertuples(index=False), frozen=True, printed=FIRST_PRINTED)
    lines = book.facts.lines.by_line(frame["track"].unique())
    for tracks in lines:
        front.new_page()
        title = tr("Rail potential along the line")
        title = tr("{title}, {tracks}", title=title, tracks=told(tracks)) if len(lines) > 1 else title
        front.chart(_chart(frame[frame["track"].isin(tracks)], block, title))


def _chart(frame: pd.DataFrame, block: Block, title: str) -> Any:
    """Return a chart of highest, mean and lowest potential of the conductors with the highest ones, all of one line."""
    chart = scatter(title, tr(PLACE), tr("rail potential [V]"))
    peak = frame[list(_POTENTIALS)].abs().max(axis=1).groupby(frame["track"]).max().sort_values(ascending=False)
    for track, colour in zip(peak.index[:MOST_DRAWN], COLOURS, strict=False):
        rows = frame.index[frame["track"] == track]
        for name, dashes in zip(reversed(_POTENTIALS), ("solid", "sysDash", "solid"), strict=True):
            words = tr("track {track}, {which}", track=track, which=tr(_WHICH[name]))
            first, last = block.first + int(rows[0]), block.first + int(rows[-1])
            draw(chart, block, Line(words, PLACE, heading_of(name), first, last, colour, dashes))
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = float(frame["km"].min()), float(frame["km"].max())
    return chart

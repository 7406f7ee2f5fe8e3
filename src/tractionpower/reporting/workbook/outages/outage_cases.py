"""The sheets of all cases: voltages, loads and trains of every outage at every grid voltage, and what each fails at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.facts.outages import COMPUTED, Outages
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.accepted import OPEN, Accepted
from tractionpower.reporting.workbook.common.verdicts import ROUNDING
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.outages import outage_reasons
from tractionpower.reporting.workbook.outages.case_figures import (
    DEVICES,
    FIRST,
    NOT_COMPUTED,
    Case,
    figure_of,
    grid_in_words,
    limit_name,
    range_name,
    tolerance_of,
)
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    YES,
    Bound,
    bound_line,
    colour_red,
    colour_word,
    judged,
    known,
)
from tractionpower.results.verdicts import sense_of
from tractionpower.studies.cases.judgement import Check


@dataclass(frozen=True)
class Sheet:
    """A sheet with a row for each case.

    Attributes
    ----------
    key
        How the names of its ranges begin.
    name, title
        Its name and title, English.
    note
        What a reader has to know.
    columns
        Its columns; the key of one is the figure, a column of table ``cases``.
    changes
        Figures whose difference from the case with nothing out stands beside them: its heading and format.
    """

    key: str
    name: str
    title: str
    note: str
    columns: tuple[Column, ...]
    changes: Mapping[str, tuple[str, str]]


SHEETS = (
    Sheet(
        "volts", mark("Outage voltages"), mark("Voltages in outages: every outage at every grid voltage"),
        mark("Lowest voltage: at trains, loads and cross-sections that are fed. Changes: less the value with nothing out at the"
             " same grid voltage. Mean useful voltages: the lowest of all zones and of all trains over the run, by both"
             " definitions."),
        (
            Column("lowest voltage [V]", "0", key="lowest_voltage_v"),
            Column("on track", "beside", 10, key="lowest_voltage_track"),
            Column("at [km]", "0.0", key="lowest_voltage_km"),
            Column("at", "time", key="lowest_voltage_s"),
            Column("highest voltage [V]", "0", key="highest_voltage_v"),
            Column("longest above U_max1 [s]", "0", key="above_u_max1_s"),
            Column("useful voltage of zones, weighted by current [V]", "0", key="useful_zone_v"),
            Column("zone", "beside", 30, key="useful_zone"),
            Column("of zones, mean over time [V]", "0", key="useful_zone_time_mean_v"),
            Column("of trains, weighted by current [V]", "0", key="useful_train_v"),
            Column("train", "beside", 16, key="useful_train"),
            Column("of trains, mean over time [V]", "0", key="useful_train_time_mean_v"),
        ),
        {"lowest_voltage_v": (mark("lowest: change [V]"), "0"), "useful_zone_v": (mark("of zones: change [V]"), "0")},
    ),
    Sheet(
        "loads", mark("Outage loads"), mark("Loads and contracts in outages: every outage at every grid voltage"),
        mark("Highest utilisation: of all devices in the window that rules, of what the rating permits. Changes: less the value"
             " with nothing out at the same grid voltage. Shares: of the contract, of the setting of a breaker. Devices beyond"
             " their rating are counted with the limit of the run."),
        (
            Column("highest utilisation [%]", "0.0", key="utilisation_percent"),
            Column("device", "beside", 28, key="utilisation_device"),
            Column("devices beyond their rating", "0", key="overloaded"),
            Column("highest demand of 15 min [kW]", "0", key="highest_demand_kw"),
            Column("of the contract [%]", "0.0", key="contract_share_percent"),
            Column("supply point", "beside", 24, key="contract_point"),
            Column("peak, of the breaker's setting [%]", "0.0", key="breaker_share_percent"),
            Column("feeder", "beside", 28, key="breaker_device"),
            Column("trips", "0", key="trips"),
            Column("greatest rail potential [V]", "0", key="rail_potential_v"),
            Column("energy of the substations [kWh]", "0", key="energy_kwh"),
            Column("heat in lines [kWh]", "0", key="line_loss_kwh"),
        ),
        {
            "utilisation_percent": (mark("utilisation: change [%]"), "0.0"),
            "highest_demand_kw": (mark("demand: change [kW]"), "0"),
            "energy_kwh": (mark("energy: change [kWh]"), "0"), "line_loss_kwh": (mark("heat: change [kWh]"), "0"),
        },
    ),
    Sheet(
        "served", mark("Outage trains"), mark("Trains and loads in outages: every outage at every grid voltage"),
        mark("Late: at a timed call, beyond the tolerance of the run. Latest: at least that where trains are stuck at the end."
             " Stuck: trains that stand for good. Without voltage: for longer than trains coast. Unfinished: trains that end"
             " their run with nothing out. Not served: fixed loads without a voltage."),
        (
            Column("late trains", "0", key="late_trains"),
            Column("latest [s]", "0", key="worst_late_s"),
            Column("train", "beside", 18, key="worst_late_train"),
            Column("stuck trains", "0", key="stuck_trains"),
            Column("trains without voltage", "0", key="dark_trains"),
            Column("unfinished trains", "0", key="unfinished_trains"),
            Column("loads not served", "0", key="unserved_loads"),
            Column("for, all of them together [s]", "0", key="unserved_load_s"),
            Column("nothing fed at all for [s]", "0", key="blackout_s"),
        ),
        {"worst_late_s": (mark("latest: change [s]"), "0")},
    ),
)  # fmt: skip


def add(book: Book, outages: Outages) -> None:
    """Add the sheets of all cases, and tell the sheet of acceptance the worst of each limit."""
    for sheet in SHEETS:
        _add(book, outages, sheet)
    outage_reasons.add(book, outages)
    _accept(book, outages)


def _add(book: Book, outages: Outages, sheet: Sheet) -> None:
    cases = list(outages.by_id.values())
    shown = [column for column in sheet.columns if any(figure_of(case, column.key) not in (None, "") for case in cases)]
    figures = {column.key for column in shown}
    page = book.page(sheet.name, sheet.title)
    checks = [check for check in outages.checks if check.figure in figures]
    limits = _limits(page, checks)
    for limit, bound in limits.items():
        book.define(limit_name(limit), page, bound.limit.replace("$", ""))
        if bound.tolerance.startswith("$"):
            book.define(tolerance_of(limit), page, bound.tolerance.replace("$", ""))
    page.note(sheet.note)
    columns = _columns(sheet, shown)
    block = page.table(columns, _rows(outages, sheet, columns, checks, limits), frozen=True)
    for column in columns:
        if column.key in figures or column.key == HOLDS:
            book.define(range_name(f"{sheet.key}_hold" if column.key == HOLDS else column.key), page, block.cells(column.key))
    colour_word(block, HOLDS)
    for check in checks:
        colour_red(block, block.cells(check.figure), limits[check.limit].beyond(is_floor=check.is_floor))


def _limits(page: Page, checks: Sequence[Check]) -> dict[str, Bound]:
    """Write the limits above the table and return their addresses."""
    found: dict[str, Bound] = {}
    for check in checks:
        if check.limit not in found:
            words = recorded(check.name)
            label = tr(LIMIT_WORDS[check.limit]) if check.limit in LIMIT_WORDS else words[:1].upper() + words[1:]
            found[check.limit] = bound_line(page, label, (check.limit, check.value, check.unit), check.tolerance)
    return found


LIMIT_WORDS = {
    "u_min2": mark("U_min2: lowest voltage"),
    "u_max2": mark("U_max2: highest voltage"),
    "t_max2": mark("Longest above U_max1"),
    "u_useful": mark("Lowest mean useful voltage"),
    "u_useful_high_speed": mark("Lowest mean useful voltage"),
    "utilisation_percent": mark("Permitted utilisation"),
    "contract_power_kw": mark("Permitted, of the contract"),
    "breaker_percent": mark("Permitted, of the setting"),
    "tolerance_s": mark("Tolerance of lateness"),
    "trips": mark("Trips, permitted"),
    "stuck_trains": mark("Stuck trains, permitted"),
    "dark_trains": mark("Trains without voltage, permitted"),
    "unfinished_trains": mark("Unfinished trains, permitted"),
    "unserved_loads": mark("Loads not served, permitted"),
    "blackout_s": mark("Nothing fed at all, permitted"),
}


def _columns(sheet: Sheet, shown: Sequence[Column]) -> list[Column]:
    columns = [*FIRST, Column(HOLDS, "beside", key=HOLDS)]
    for column in shown:
        columns.append(column)
        if column.key in sheet.changes:
            columns.append(Column(*sheet.changes[column.key], key=f"change_{column.key}"))
    return columns


def _rows(
    outages: Outages, sheet: Sheet, columns: Sequence[Column], checks: Sequence[Check], limits: Mapping[str, Bound]
) -> Iterator[list[Any]]:
    base = {case["grid"]: (number, case) for number, case in enumerate(outages.by_id.values(), 1) if case["kind"] == "base"}
    for case in outages.by_id.values():
        cells = {column.key: figure_of(case, column.key) for column in columns}
        cells |= {key: device_told(cells[key]) for key in DEVICES if cells.get(key)}
        for figure in sheet.changes:
            cells[f"change_{figure}"] = _change(case, figure, base.get(case["grid"]))
        cells[HOLDS] = _holds(outages, case, checks, limits)
        first = [case["words"], grid_in_words(case["grid"])]
        yield [*first, *(cells[column.key] for column in columns[len(first) :])]


def _change(case: Case, figure: str, base: tuple[int, Case] | None) -> Formula | None:
    """Return the difference of a figure from that with nothing out at the same grid voltage."""
    value = figure_of(case, figure)
    other = None if base is None else figure_of(base[1], figure)
    if base is None or case["kind"] == "base" or not known(value) or not known(other):
        return None
    return Formula(f"{{{figure}}}-INDEX({{{range_name(figure)}}},{base[0]})", value - other)


def _holds(outages: Outages, case: Case, checks: Sequence[Check], limits: Mapping[str, Bound]) -> Formula | str:
    if case["status"] not in COMPUTED:
        return tr(NOT_COMPUTED)
    if not checks:
        return ""
    tests = ",".join(
        f"AND(ISNUMBER({{{check.figure}}}),{{{check.figure}}}{limits[check.limit].beyond(is_floor=check.is_floor)})"
        for check in checks
    )
    failed = [not check.is_met(case) for check in checks]
    by_numbers = [known(figure_of(case, check.figure)) and _is_beyond(check, case) for check in checks]
    limited = ",".join(dict.fromkeys(limits[check.limit].limit for check in checks))
    text = f'IF(OR({tests}),"{tr(NO)}",IF(COUNT({limited})=0,"{tr(OPEN)}","{tr(YES)}"))'
    return judged(text, NO if any(by_numbers) else YES, NO if any(failed) else YES)


def _is_beyond(check: Check, case: Case) -> bool:
    value = float(case[check.figure])
    slack = check.tolerance + float(ROUNDING) * abs(check.value)
    return value < check.value - slack if check.is_floor else value > check.value + slack


def _accept(book: Book, outages: Outages) -> None:
    """Tell the sheet of acceptance the worst case of each limit, by formulas on the sheets of cases."""
    checks = {check.name: check for check in outages.checks}
    for verdict in book.facts.verdicts:
        check = checks.get(str(verdict["name"]))
        values = [] if check is None else [figure_of(case, check.figure) for case in outages.by_id.values()]
        numbers = [float(value) for value in values if known(value)]
        if check is None or not numbers or range_name(check.figure) not in book.names:
            continue
        worst = min(numbers) if check.is_floor else max(numbers)
        found = Formula(f"{'MIN' if check.is_floor else 'MAX'}({{{range_name(check.figure)}}})", worst)
        place, time, status, source = (str(verdict[key] or "") for key in ("place", "time", "status", "source"))
        place = _place(outages, place) if worst or check.value else ""  # nothing has happened anywhere
        book.acceptance.append(
            Accepted(
                check.name, check.limit, check.value, check.unit, sense_of(verdict), found, place, time, status, source,
                tolerance=check.tolerance,
            )
        )  # fmt: skip


def _place(outages: Outages, place: str) -> str:
    """Return the place of a verdict with its case in the words of the other sheets."""
    cases = [case for case in outages.by_id if place == case or place.startswith(f"{case}: ")]
    case = max(cases, key=len, default="")
    return f"{outages.told(case)}{place[len(case) :]}" if case else place

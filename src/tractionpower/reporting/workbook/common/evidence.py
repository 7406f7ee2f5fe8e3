"""The sheet of evidence: how well the equations were solved, whether energies add up, and which files the book was made from."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from tractionpower.model.base import format_time
from tractionpower.movement.ledgers import ELECTRIC_SHARE, GIVEN, MECHANICAL_SHARE
from tractionpower.reporting.texts import mark, number, recorded, tr, trn
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Computed, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page

FLAGS = ("not_converged", "not_servable")
"""Kinds of events of flagged steps."""

MOST_FLAGS = 500

LEDGERS: dict[str, tuple[str, dict[str, str]]] = {
    "electric": (
        mark("Electric"),
        {
            "source": mark("sum of E I of the substations"),
            "regulation": mark("(E - U) I in substations, mostly commutation drop"),
            "train": mark("trains, taken less returned"),
            "load": mark("fixed loads"),
            "conductor": mark("heat in contact lines, return circuit and feeders"),
        },
    ),
    "pantograph_to_wheel": (
        mark("Pantograph to wheel"),
        {
            "line": mark("from the line, taken less returned"),
            "recovered": mark("from the electric brake"),
            "wheel": mark("work at the wheel"),
            "drive_loss": mark("losses of the drives"),
            "starting_resistors": mark("heat in starting resistors"),
            "auxiliaries": mark("auxiliaries and heating"),
            "coupling": mark("what the constant-voltage coupling leaves out"),
            "fitted": mark("by what fitted characteristics differ"),
        },
    ),
    "mechanical": (
        mark("Mechanical"),
        {
            "wheel": mark("work at the wheel"),
            "kinetic": mark("change of kinetic energy, with rotating masses"),
            "potential": mark("change of potential energy"),
            "resistance": mark("running resistance, curves and tunnels"),
            "brakes": mark("brakes, electric and friction"),
        },
    ),
}
"""Title and parts of each ledger, by their names in ``run.json``."""

_GIVEN = {"electric": ("source",), **GIVEN}
_SHARES = {"mechanical": MECHANICAL_SHARE, "pantograph_to_wheel": ELECTRIC_SHARE}
_RARE = ("coupling", "fitted")

CLOSES, OPEN = mark("closes"), mark("does not close")
ACCEPTED, FLAGGED = mark("accepted"), mark("flagged")
HOLDS, DIFFERS = mark("in balance"), mark("not in balance")

_WIDEST = 68
"""Width of the first column, in which hashes stand [characters]."""

_PARTS = (
    Column("ledger, part", widest=_WIDEST),
    Column("given [kWh]", "0.000", key="given"),
    Column("spent [kWh]", "0.000", key="spent"),
)
_SUMS = (
    Column("ledger", widest=_WIDEST),
    Column("given [kWh]", "0.000", key="given"),
    Column("spent [kWh]", "0.000", key="spent"),
    Column("gap of the sums [kWh]", "exponent", key="gap"),
    Column("gap / given", "exponent", key="share"),
    Column("sums", "beside", widest=16, key="sums"),
    Column("worst found", "exponent", key="worst"),
    Column("allowed", "exponent", key="allowed"),
    Column("unit", "beside", widest=34),
    Column("where", widest=24),
    Column("judged by the program", widest=20),
)
_WHAT = (Column("what", widest=_WIDEST), Column("value", "general"), Column("unit", "beside"))
_FOLDERS = (
    Column("folder", widest=_WIDEST),
    Column("study", "beside", widest=24),
    Column("status", "beside", widest=12),
    Column("step [s]", "general"),
    Column("steps", "0"),
    Column("cases", "0"),
    Column("flagged steps, or cases", "0"),
    Column("worst residual [A]", "exponent"),
    Column("ledgers", "beside", widest=16),
    Column("input hash", "beside", widest=_WIDEST),
)
_STEPS = (
    Column("flagged spell", widest=_WIDEST),
    Column("begins", "time"),
    Column("kind", "beside", widest=16),
    Column("at", widest=20),
    Column("track"),
    Column("place [km]", "0.000"),
    Column("found", "exponent"),
    Column("limit", "exponent"),
)


def add(book: Book) -> None:
    """Add the sheet."""
    facts = book.facts
    page = book.page("Solver evidence", "Solver evidence: how far these figures can be trusted")
    _say_status(page, facts)
    _solution(book, page)
    _ledgers(page, facts)
    _flagged(page, facts)
    _cases(page, facts)
    _folders(page, facts)
    add_origin(page, facts)


def _say_status(page: Page, facts: Facts) -> None:
    run = facts.run
    begin, end = run.get("start_s"), run.get("end_s")
    if begin is not None and end is not None:
        page.line(tr("Computed: {begin} to {end} in steps of {step} s.", begin=format_time(begin), end=format_time(end),
                     step=number(run.get("step_s", facts.scenario.clock.step_s), 3)))  # fmt: skip
    words = {
        "complete": mark("Complete: all steps, or cases, were computed, and none is flagged."),
        "flagged": mark("Flagged: the run is complete, but steps or ledgers below do not hold what is asked of them."),
        "interrupted": mark("Interrupted: the run was stopped before its end; all sheets tell of the part that was computed."),
    }
    status = str(run.get("status", ""))
    page.line(tr(words[status]) if status in words else status)
    page.next += 1


def _solution(book: Book, page: Page) -> None:
    """Write residual, iterations and steps; the verdict on the residual is a formula."""
    run = book.facts.run
    if run.get("worst_residual_a") is None:
        return
    page.section("Solution of the network")
    worst, limit = run["worst_residual_a"], run.get("residual_limit_a", 1e-3)
    told = (
        (tr("largest current that does not balance at a node, of all steps"), worst, "A", "exponent"),
        (tr("largest that is accepted without a flag"), limit, "A", "exponent"),
        (tr("mean number of iterations in a step"), run.get("mean_iterations"), "", "0.000"),
        (tr("time steps computed"), run.get("steps"), "", "0"),
        (tr("flagged steps"), run.get("flagged_steps"), "", "0"),
    )
    block = _values(page, [row for row in told if row[1] is not None])
    book.define("worst_residual_a", page, block.cell("value", block.first))
    book.define("residual_limit_a", page, block.cell("value", block.first + 1))
    page.next -= 1
    verdict = Formula(
        f'IF({{worst_residual_a}}<={{residual_limit_a}},"{tr(ACCEPTED)}","{tr(FLAGGED)}")',
        tr(ACCEPTED) if worst <= limit else tr(FLAGGED),
    )
    page.put(page.next, 1, tr("balance of the nodes"), "sum text")
    page.put(page.next, 2, verdict, "sum text")
    page.next += 2


def _values(page: Page, rows: Sequence[tuple[str, Any, str, str]]) -> Block:
    """Write a table of quantities with value, unit and the style of the value."""
    block = page.table(_WHAT, [row[:3] for row in rows])
    for k, (_, value, _, style) in enumerate(rows):
        page.put(block.first + k, 2, value, style)
    return block


def _ledgers(page: Page, facts: Facts) -> None:
    """Write the parts of the ledgers, then their sums and gaps as formulas."""
    told = {name: ledger for name, ledger in facts.ledgers.items() if name in LEDGERS}
    if not told:
        return
    page.section("Ledgers: what goes in comes out")
    page.note(
        "Sums, gaps and shares are formulas on the parts below. Worst found is the worst single step or train, which the program"
        " judges while it runs: a gap in a sum could hide in opposite signs."
    )
    top = page.next
    page.next = top + len(told) + 2  # the sums stand above their parts
    rows = {name: _parts(name, ledger) for name, ledger in told.items()}
    parts = page.table(_PARTS, [row for each in rows.values() for row in each])
    after, page.next = page.next, top
    first = parts.first
    sums = []
    for name, ledger in told.items():
        area = (first, first + len(rows[name]) - 1)
        first = area[1] + 1
        sums.append(_sum(name, ledger, rows[name], parts, area))
    page.table(_SUMS, sums)
    page.next = after


def _parts(name: str, ledger: dict[str, Any]) -> list[tuple[Any, ...]]:
    title, words = LEDGERS[name]
    rows: list[tuple[Any, ...]] = []
    for part, told in words.items():
        value = ledger.get(f"{part}_kwh")
        if value is not None and (value or part not in _RARE):
            given = part in _GIVEN[name]
            rows.append((f"{tr(title)}: {tr(told)}", value if given else None, None if given else value))
    return rows


def _sum(name: str, ledger: dict[str, Any], rows: list[tuple[Any, ...]], parts: Block, area: tuple[int, int]) -> tuple[Any, ...]:
    """Return the row of a ledger in the table of sums; its parts stand in the rows `area`."""
    given, spent = (math.fsum(row[k] for row in rows if row[k] is not None) for k in (1, 2))
    cells = [f"{parts.cell(key, area[0])}:{parts.cell(key, area[1])}" for key in ("given", "spent")]
    gap = round(given - spent, 6) + 0.0  # sums differ in their last digits from program to program
    share = abs(gap) / given if given else 0.0
    allowed = _SHARES.get(name, MECHANICAL_SHARE)
    if name == "electric":
        worst, unit, limit = ledger.get("worst_gap_w"), tr("W, of a step"), None
    else:
        worst, unit, limit = ledger.get("worst_gap_share"), tr("share of the exchange, of a train"), allowed
    train = ledger.get("train")
    where = tr("train {train}", train=train) if train else tr("any step")
    words = tr(HOLDS), tr(DIFFERS)
    return (
        tr(LEDGERS[name][0]),
        Formula(f"SUM({cells[0]})", given),
        Formula(f"SUM({cells[1]})", spent),
        Formula("ROUND({given}-{spent},6)", gap),
        Formula("IF({given}=0,0,ABS({gap})/ABS({given}))", share),
        Formula(f'IF({{share}}<={allowed:g},"{words[0]}","{words[1]}")', words[0] if share <= allowed else words[1]),
        worst,
        limit,
        unit if name != "electric" else tr("W, of a step; allowed: 1e-9 of its power and 1 mW"),
        where,
        tr(CLOSES) if ledger.get("closes") else tr(OPEN),
    )


def _flagged(page: Page, facts: Facts) -> None:
    """List the steps that are flagged, with time, place and residual."""
    if "events" not in facts.results.tables:
        return
    page.section("Flagged steps")
    events = facts.table("events")
    found = events[events["kind"].astype(str).isin(FLAGS)]
    if found.empty:
        page.line("None: every step balances and every demand could be served.")
        page.next += 1
        return
    if len(found) > MOST_FLAGS:
        page.note(tr("The first {most} of {count}; table events has all.", most=MOST_FLAGS, count=len(found)))
    page.note("Found is the residual of a node [A], or the share of all demand that could be served. A row is an unbroken spell.")
    page.table(_STEPS, _flag_rows(found.head(MOST_FLAGS)))


def _flag_rows(events: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    for event in events.itertuples(index=False):
        kind = recorded(str(event.kind).replace("_", " "))
        yield (
            recorded(str(event.message)), event.time_s, kind, str(event.subject), str(event.track), event.position_km,
            event.value, event.limit,
        )  # fmt: skip


def _cases(page: Page, facts: Facts) -> None:
    """Tell how the cases of a study of many ended."""
    counts = facts.run.get("cases")
    if not isinstance(counts, dict):
        return
    words = {
        "all": mark("cases"),
        "complete": mark("complete"),
        "flagged": mark("flagged: a step did not converge, or a ledger does not close"),
        "refused": mark("refused: their inputs have errors"),
        "failed": mark("failed"),
        "reused": mark("taken from an earlier study of the same inputs"),
    }
    page.section("Cases")
    page.note("Each case is a run of its own; residuals and ledgers of a case decide whether it is complete or flagged.")
    page.table(_WHAT, [(tr(told), counts[name], "") for name, told in words.items() if name in counts])


def _folders(page: Page, facts: Facts) -> None:
    """Tell of the folders of a comparison how they were computed, and how well."""
    folders = (facts.run.get("compare") or {}).get("folders")
    if not folders:
        return
    page.section("Folders that are compared")
    page.note("Evidence of each stands in its own workbook; this is what it comes to.")
    page.table(_FOLDERS, [_folder(entry) for entry in folders])


def _folder(entry: dict[str, Any]) -> tuple[Any, ...]:
    run = entry.get("run") or {}
    ledgers, cases = run.get("ledgers_close") or {}, run.get("cases") or {}
    closes = tr(CLOSES) if all(ledgers.values()) else tr(OPEN)
    return (
        f"{entry['name']}: {entry['folder']}", str(entry["study"]), tr(str(entry["status"])), run.get("step_s"),
        run.get("steps"), cases.get("all") if isinstance(cases, dict) else None,
        run.get("flagged_steps", cases.get("flagged") if isinstance(cases, dict) else None), run.get("worst_residual_a"),
        closes if ledgers else "", str(entry.get("input_hash") or ""),
    )  # fmt: skip


def add_origin(page: Page, facts: Computed) -> None:
    """Write how it was computed, and which files the book was made from."""
    _made_with(page, facts)
    _files(page, facts)


def _made_with(page: Page, facts: Computed) -> None:
    run = facts.run
    page.section("How it was computed")
    words = {
        "wall_seconds": (mark("wall time of the computation"), "s", "0.0"),
        "compile_seconds": (mark("time to prepare the tables and load or compile the kernels"), "s", "0.0"),
        "workers": (mark("cases at a time"), "", "0"),
        "seed": (mark("seed of everything that is drawn"), "", "0"),
    }
    rows = [(tr(told), run[name], unit, style) for name, (told, unit, style) in words.items() if run.get(name) is not None]
    versions = sorted(run.get("versions", {}).items())
    _values(page, [*rows, *((tr("version of {package}", package=name), version, "", "any") for name, version in versions)])


def _files(page: Page, facts: Computed) -> None:
    """List the files of the results with size and hash, so that the book can be matched with them."""
    files = facts.run.get("files") or {}
    page.section("Files that this workbook was made from")
    page.line(tr("Input hash (SHA-256 of scenario.json): {hash}", hash=facts.input_hash))
    if not files:
        page.line("The results were not read from a folder; there are no files to match.")
        return
    count, size = len(files), sum(told.get("size", 0) for told in files.values()) / 1e6
    page.note(
        trn("{count} file of {size} MB.", "{count} files of {size} MB.", count, size=number(size, 1))
        + " "
        + tr("Compare with sha256sum FILE, or on Windows with certutil -hashfile FILE SHA256.")
    )
    rows = [(told.get("sha256", ""), told.get("size"), name) for name, told in sorted(files.items())]
    page.table((Column("SHA-256", widest=_WIDEST), Column("size [bytes]", "0"), Column("file", "beside", widest=24)), rows)

"""What the cover of a study of outages says: the verdict in words, what fails and by which outage, what was not computed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tractionpower.model.base import format_time
from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages
from tractionpower.reporting.texts import number, recorded, tr, trn
from tractionpower.reporting.workbook.common.cover import MOST_NOTES, Said, fill_in
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.outages.outage_cases import grid_in_words
from tractionpower.reporting.workbook.outages.outage_table import BANNER

MOST_NAMED = 1
"""Outages that are named for each thing that fails."""


def fill(book: Book, page: Page, outages: Outages) -> None:
    """Write the cover, when all other sheets are there."""
    fill_in(book, page, (lambda facts: _head(facts, outages), lambda _: _verdicts(book, outages), _trust(outages)))


def _head(facts: Facts, outages: Outages) -> Iterator[Said]:
    cases = outages.cases
    own = cases[cases["kind"] != "base"].drop_duplicates(["kind", "subject", "mode"])
    kinds = [str(kind) for kind in own["kind"]]
    counts = ", ".join(f"{tr(KINDS_WORDS.get(kind, kind)).lower()}: {kinds.count(kind)}" for kind in dict.fromkeys(kinds))
    parts = [trn("{count} outage ({kinds})", "{count} outages ({kinds})", len(own), kinds=counts)]
    if len(outages.grids) > 1:
        parts.append(tr("each at {grids} grid voltage", grids=", ".join(map(grid_in_words, outages.grids))))
    parts.append(trn("{count} case", "{count} cases", len(cases)))
    yield tr("What was computed"), f"{'; '.join(parts)}.", "wrapped"
    clock = facts.scenario.clock
    span = tr(
        "{begin} to {end} in steps of {step} s",
        begin=format_time(clock.start), end=format_time(clock.end), step=number(clock.step_s, 3),
    )  # fmt: skip
    yield tr("Each case"), f"{span}, {trn('{count} train', '{count} trains', len(facts.scenario.runs))}.", "wrapped"


def _verdicts(book: Book, outages: Outages) -> Iterator[tuple[str, Any, str]]:
    groups = list(outages.groups())
    outs = [cases for first, cases in groups if first["kind"] != "base"]
    failing = [cases for cases in outs if any(map(outages.failures, cases.values()))]
    worse = sum(any(map(outages.is_worse, cases.values())) for cases in failing)
    if outs:
        words = tr("{failing} of {all} outages fail", failing=len(failing), all=len(outs))
        yield tr("Outages"), Formula(f"{{{BANNER}}}", words) if BANNER in book.names else words, "neutral"
    else:
        yield tr("Outages"), tr("No outage was looked at"), "doubt"
    if 0 < worse < len(failing):
        yield "", tr("{worse} of them at something that holds with nothing out.", worse=worse), "neutral"
    base = [case for first, cases in groups if first["kind"] == "base" for case in cases.values()]
    said = [(case, "; ".join(failure.words for failure in outages.failures(case))) for case in base]
    if said:
        lines = (
            tr("With nothing out, {grid} grid voltage: {found}.", grid=grid_in_words(case["grid"]), found=found or tr("holds"))
            for case, found in said
        )
        yield tr("Nothing out"), "\n".join(lines), "bad" if any(found for _, found in said) else "good"
    yield from _failing(outages)


def _failing(outages: Outages) -> Iterator[Said]:
    """Tell for each thing that fails in how many cases, and name the worst."""
    for what, cases in outages.failing().items():
        named = "\n".join(f"{outages.told(case)}: {words}" for case, words in cases[:MOST_NAMED])
        left = len(cases) - MOST_NAMED
        more = f"\n{trn('and {count} more case, see sheet What fails', 'and {count} more cases, see sheet What fails', left)}"
        yield tr("Fails at: {what}", what=recorded(what)), f"{named}{more if left > 0 else ''}", "bad"


def _trust(outages: Outages) -> Any:
    def said(facts: Facts) -> Iterator[Said]:
        cases = outages.cases
        counts = cases["status"].value_counts()
        parts = ", ".join(
            tr("{count} {status}", count=counts[status], status=recorded(status)) for status in sorted(counts.index)
        )
        bare = cases[~cases["status"].isin(COMPUTED)]
        yield (
            tr("Status of the cases"),
            f"{trn('{count} case', '{count} cases', len(cases))}: {parts}.",
            "good" if (cases["status"] == "complete").all() else "bad",
        )
        if facts.run.get("status") == "interrupted":
            words = tr("The study was interrupted: what follows is a part of it. The same command goes on with it.")
            yield "", words, "bad"
        for row in bare.head(MOST_NOTES).to_dict("records"):
            words = f"{outages.told(row['case'])}: {recorded(row['status'])}: {' '.join(row['reason'].split())}"
            yield tr("Not computed"), words, "bad"
        if len(bare) > MOST_NOTES:
            yield tr("Not computed"), tr("{more} more are on sheet What fails.", more=len(bare) - MOST_NOTES), "bad"
        notes = [*(facts.run.get("notes") or ()), *((facts.run.get("contingency") or {}).get("notes") or ())]
        for note in dict.fromkeys(map(str, notes[:MOST_NOTES])):
            yield tr("Note"), recorded(note), "wrapped"
        yield from _origin(facts)

    return said


def _origin(facts: Facts) -> Iterator[Said]:
    run = facts.run
    wall, workers = run.get("wall_seconds"), run.get("workers")
    if wall is not None:
        words = tr("{seconds} s", seconds=number(wall, 0))
        if workers and workers != 1:
            words = tr("{seconds} s on {workers} processes", seconds=number(wall, 0), workers=workers)
        yield tr("Time"), f"{words}.", "wrapped"

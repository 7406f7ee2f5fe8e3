"""What the cover of a study of outages says: the verdict in words, what fails and by which outage, what was not computed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tractionpower.io.wording import counted
from tractionpower.model.base import format_time
from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages, outcome_words
from tractionpower.reporting.workbook.common.cover import MOST_NOTES, Said, fill_in
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Page

MOST_NAMED = 2
"""Outages that are named for each thing that fails."""


def fill(book: Book, page: Page, outages: Outages) -> None:
    """Write the cover, when all other sheets are there."""
    fill_in(book, page, (lambda facts: _head(facts, outages), lambda facts: _verdicts(facts, outages), _trust(outages)))


def _head(facts: Facts, outages: Outages) -> Iterator[Said]:
    cases = outages.cases
    own = cases[cases["kind"] != "base"].drop_duplicates(["kind", "subject", "mode"])
    kinds = [str(kind) for kind in own["kind"]]
    counts = [f"{KINDS_WORDS.get(kind, kind).lower()}: {kinds.count(kind)}" for kind in dict.fromkeys(kinds)]
    grids = f", each at {', '.join(outages.grids)} grid voltage" if len(outages.grids) > 1 else ""
    clock = facts.scenario.clock
    what = f"{counted(len(own), 'outage')}{grids} ({', '.join(counts)}); {counted(len(cases), 'case')}."
    yield "What was computed", what, "wrapped"
    span = f"{format_time(clock.start)} to {format_time(clock.end)} in steps of {clock.step_s:g} s"
    yield "Each case", f"{span}, {counted(len(facts.scenario.runs), 'train')}.", "wrapped"


def _verdicts(facts: Facts, outages: Outages) -> Iterator[Said]:
    groups = list(outages.groups())
    outs = [cases for first, cases in groups if first["kind"] != "base"]
    failing = [cases for cases in outs if any(map(outages.failures, cases.values()))]
    worse = sum(any(map(outages.is_worse, cases.values())) for cases in failing)
    words = outcome_words(len(outs), len(failing), worse)
    yield "Verdict", words[0].upper() + words[1:], "big bad" if failing else "big good" if outs else "big doubt"
    base = [case for first, cases in groups if first["kind"] == "base" for case in cases.values()]
    said = [(case, "; ".join(failure.words for failure in outages.failures(case))) for case in base]
    if said:
        lines = (f"With nothing out, {case['grid']} grid voltage: {found or 'holds'}." for case, found in said)
        yield "", "\n".join(lines), "bad" if any(found for _, found in said) else "good"
    yield from _failing(outages)


def _failing(outages: Outages) -> Iterator[Said]:
    """Tell for each thing that fails in how many cases, and name the worst."""
    for what, cases in outages.failing().items():
        named = "\n".join(f"{outages.told(case)}: {words}" for case, words in cases[:MOST_NAMED])
        left = len(cases) - MOST_NAMED
        more = f"\nand {left} more case{'s' if left > 1 else ''}, see sheet Outages" if left > 0 else ""
        yield f"Fails at: {what}", f"{named}{more}", "bad"


def _trust(outages: Outages) -> Any:
    def said(facts: Facts) -> Iterator[Said]:
        cases = outages.cases
        counts = cases["status"].value_counts()
        parts = ", ".join(f"{counts[status]} {status}" for status in sorted(counts.index))
        bare = cases[~cases["status"].isin(COMPUTED)]
        yield (
            "Status of the cases",
            f"{counted(len(cases), 'case')}: {parts}.",
            "good" if (cases["status"] == "complete").all() else "bad",
        )
        if facts.run.get("status") == "interrupted":
            yield "", "The study was interrupted: what follows is a part of it. The same command goes on with it.", "bad"
        for row in bare.head(MOST_NOTES).to_dict("records"):
            yield "Not computed", f"{outages.told(row['case'])}: {row['status']}: {' '.join(row['reason'].split())}", "bad"
        if len(bare) > MOST_NOTES:
            yield "Not computed", f"{len(bare) - MOST_NOTES} more are on sheet All cases.", "bad"
        notes = [*(facts.run.get("notes") or ()), *((facts.run.get("contingency") or {}).get("notes") or ())]
        for note in dict.fromkeys(map(str, notes[:MOST_NOTES])):
            yield "Note", note, "wrapped"
        yield from _origin(facts)

    return said


def _origin(facts: Facts) -> Iterator[Said]:
    run = facts.run
    wall, workers = run.get("wall_seconds"), run.get("workers")
    if wall is not None:
        with_workers = f" on {workers} processes" if workers and workers != 1 else ""
        yield "Time", f"{wall:.0f} s{with_workers}.", "wrapped"

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
from tractionpower.reporting.workbook.outages.case_figures import grid_in_words, range_name
from tractionpower.reporting.workbook.outages.outage_reasons import Reasons, failing, span, spans
from tractionpower.reporting.workbook.outages.outage_table import BANNER
from tractionpower.reporting.workbook.sizing.judging import sentence
from tractionpower.studies.cases.judgement import Check


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
    if outs:
        worse = sum(any(map(outages.is_worse, cases.values())) for cases in outs)
        words = tr("{failing} of {all} outages fail", failing=len(failing), all=len(outs))
        words += tr(", {worse} of them at something that holds with nothing out", worse=worse) if failing else ""
        yield tr("Outages"), Formula(f"{{{BANNER}}}", words) if BANNER in book.names else words, "neutral"
    else:
        yield tr("Outages"), tr("No outage was looked at"), "doubt"
    reasons = Reasons(book, outages)
    base = [case for first, cases in groups if first["kind"] == "base" for case in cases.values()]
    if base:
        yield tr("Nothing out"), _base(reasons, base), "neutral"
    if len(base) < len(outages.by_id):
        yield from _failing(reasons)


def _base(reasons: Reasons, base: list[Any]) -> Formula:
    """Tell what fails with nothing out, a line for each grid voltage."""
    lines = []
    for case in base:
        cell = f"INDEX({{{range_name('how')}}},{reasons.numbers[case['case']]})"
        told = reasons.how(case)
        found = str(told.value) if isinstance(told, Formula) else told
        if case["status"] not in COMPUTED:
            found = recorded(case["status"])
        text = tr("With nothing out, {grid} grid voltage: {found}.", grid=grid_in_words(case["grid"]), found="{found}")
        spoken = f'IF({cell}="","{tr("holds")}",{cell})' if case["status"] in COMPUTED else f'"{recorded(case["status"])}"'
        lines.append(sentence(text, found=(spoken, found or tr("holds"))))
    return Formula("&CHAR(10)&".join(line.text for line in lines), "\n".join(str(line.value) for line in lines))


def _failing(reasons: Reasons) -> Iterator[Said]:
    """Tell for each limit that outages pass in how many cases, and the worst; and for all others together whether some do."""
    others = []
    label = tr("Fails at")
    for check in reasons.checks:
        count, cases = failing(reasons, check)
        if cases:
            told = _worst(reasons, check, count, cases)
            name = f"{recorded(check.name)}: "
            yield label, Formula(f'"{_quoted(name)}"&{told.text}', f"{name}{told.value}"), "neutral"
            label = ""
        else:
            others.append((check, count))
    if others:
        each = "&".join(f'IF({count}>0,"; {_quoted(recorded(check.name))}: "&{count},"")' for check, count in others)
        total = "+".join(count for _, count in others)
        yield (
            tr("Other limits"),
            Formula(f'IF({total}=0,"{tr("no case fails")}",MID({each},3,1000))', tr("no case fails")),
            "neutral",
        )


def _worst(reasons: Reasons, check: Check, count: str, cases: list[Any]) -> Formula:
    """Return how many cases fail at a limit, and how the worst of them stands."""
    rows = spans(reasons.outages)
    area, sign = span(check.figure, rows), 1.0 if check.is_floor else -1.0
    worst = min(cases, key=lambda case: sign * case[check.figure])
    most = f"{'MIN' if check.is_floor else 'MAX'}({area})"
    at = f"{rows[0] - 1}+MATCH({most},{area},0)"
    grid = tr("{grid} grid voltage", grid="{grid}")
    text = tr("cases: {count}; worst: {case}, {grid}: {how}", count="{count}", case="{case}", grid=grid, how="{how}")
    how = reasons.sentence(check, worst, most, at)
    told = sentence(
        text,
        count=(count, len(cases)), case=(f"INDEX({{{range_name('words')}}},{at})", worst["words"]),
        grid=(f"INDEX({{{range_name('grid')}}},{at})", grid_in_words(worst["grid"])), how=(how.text, how.value),
    )  # fmt: skip
    return Formula(f'IF({count}=0,"{tr("no case fails")}",{told.text})', told.value)


def _quoted(text: str) -> str:
    return text.replace('"', '""')


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

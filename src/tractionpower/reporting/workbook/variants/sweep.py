"""The workbook of a sweep: the cases with what they set, verdicts, differences from the base, charts."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import mark, number, tr, trn
from tractionpower.reporting.workbook.common import acceptance, assumptions, definitions, evidence, inputs, not_covered
from tractionpower.reporting.workbook.common.cover import MOST_NOTES, Said, fill_in
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.variants.sweep_cases import Cases, Cells
from tractionpower.reporting.workbook.variants.sweep_charts import add_charts
from tractionpower.reporting.workbook.variants.sweep_differences import add_best, add_differences
from tractionpower.reporting.workbook.variants.sweep_tables import add_figures, add_variants, add_verdicts
from tractionpower.reporting.workbook.variants.sweep_words import STATUSES, differing_figures, heading
from tractionpower.results.results import Results

MOST_SAID = 6
"""Figures whose best and worst case stand on the cover; sheet Best and worst has all of them."""

ENDS = {"best": mark("best"), "worst": mark("worst"), "lowest": mark("lowest"), "highest": mark("highest")}


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book, data = Book(Facts(results, scenario), report), SweepData(results, scenario)
    front = book.page("Cover", shorten(tr("{study}: variants", study=book.facts.study), TITLE_LENGTH))
    if len(data.cases):
        _tables(book, data)
    else:
        book.page("Variants", "Variants: what each case sets, and what came of it").line("No case has ended.")
    for add in (assumptions.add, inputs.add, definitions.add, not_covered.add, evidence.add, acceptance.add):
        add(book)
    fill_in(book, front, (lambda _: _head(data), lambda _: _verdicts(data), lambda _: _trust(data)))
    book.finish()
    return book


def _tables(book: Book, data: SweepData) -> None:
    """Add the sheets of the cases."""
    cases = Cases(data)
    cells = Cells(cases)
    variants = add_variants(book, data, cases, cells)
    add_figures(book, data, cases, cells)
    others = book.pages.pop()  # formulas of all sheets ask for its ranges, but it is the last that is read
    if cases.words:
        add_best(book, data, cases, cells)
        add_differences(book, data, cases, cells)
        add_charts(book, data, cases, cells, variants)
        add_verdicts(book, cases, cells)
    book.pages.append(others)


def _head(data: SweepData) -> Iterator[Said]:
    sweep, counts = data.run["sweep"], data.run["cases"]
    many = counts["all"] - 1
    yield (
        tr("What was computed"),
        trn("The base and {count} variant of it.", "The base and {count} variants of it.", many),
        "wrapped",
    )
    for path, values in data.keys.items():
        shown = ", ".join(values[:12])
        if len(values) > 12:
            shown = tr("{values}, ... ({count} values)", values=shown, count=len(values))
        yield tr("Varied"), f"{data.names[path]}: {shown}", "wrapped"
    if sweep.get("sample"):
        count, seed = sweep["sample"]["count"], sweep["sample"]["seed"]
        yield tr("Sample"), tr("{count} draws with seed {seed}.", count=count, seed=seed), "wrapped"


def _verdicts(data: SweepData) -> Iterator[Said]:
    extremes = data.run["sweep"]["extremes"]
    for name in differing_figures(data)[:MOST_SAID]:
        ends = (
            tr(
                "{end} {value} (case {case}: {subject})",
                end=tr(ENDS[word]), value=number(one["value"]), case=one["case"],
                subject=data.subject(str(one["case"])) or tr("nothing is changed"),
            )
            for word, one in extremes[name].items()
        )  # fmt: skip
        yield tr(heading(name)), f"{'; '.join(ends)}.", "wrapped"


def _trust(data: SweepData) -> Iterator[Said]:
    counts = data.cases["status"].value_counts()
    parts = ", ".join(
        tr("{count} {status}", count=counts[status], status=tr(STATUSES.get(status, status))) for status in sorted(counts.index)
    )
    style = "good" if set(counts.index) == {"complete"} else "doubt"
    told = trn("{count} case: {parts}.", "{count} cases: {parts}.", len(data.cases), parts=parts)
    yield tr("Status of the cases"), told, style
    bare = data.cases[~data.cases["case"].isin(data.measured["case"])]
    most = min(MOST_NOTES, 6)
    for row in bare.head(most).to_dict("records"):
        words = f"{row['case']} ({row['subject']}): {tr(STATUSES.get(row['status'], row['status']))}: {row['reason']}"
        yield tr("Not computed"), words, "bad"
    if len(bare) > most:
        yield tr("Not computed"), tr("{count} more are on sheet Variants.", count=len(bare) - most), "bad"

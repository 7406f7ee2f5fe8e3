"""The cover: what was computed, the verdicts in words, how far the run can be trusted, and what is where."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from datetime import datetime
from typing import Any

from openpyxl.worksheet.hyperlink import Hyperlink

from tractionpower.model.base import format_time
from tractionpower.reporting.workbook.common.acceptance import verdict_word
from tractionpower.reporting.workbook.feasibility.feasibility import verdict_in_words
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import put
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, STATES, Facts, limit_in_words
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Page
from tractionpower.reporting.workbook.sizing.ratings import one_for_each, ratings_in_words

LABEL_WIDTH, TEXT_WIDTH = 28.0, 100.0

CHARACTERS = 104
"""Characters of a text that fit into its width; most are narrower than a digit."""

MOST_NOTES = 30
TITLE_LENGTH = 80
"""Characters of the study's name in its title; a longer one is written in full below."""

_LEDGERS = {
    "electric": "Electric ledger",
    "mechanical": "Mechanical ledger",
    "pantograph_to_wheel": "Pantograph to wheel",
}

Said = tuple[str, str, str]
"""Label, text, and style of the text."""


def fill_in(book: Book, page: Page, groups: Sequence[Callable[[Facts], Iterable[Said]]] = ()) -> None:
    """Write the cover, when all other sheets are there; `groups` tell what stands on it, none: what that of a run tells."""
    facts = book.facts
    page.widen(LABEL_WIDTH, TEXT_WIDTH)
    for group in groups or (_head, _verdicts, _trust):
        page.next += 1
        for label, text, style in group(facts):
            _say(page, label, text, style)
    page.next += 1
    page.section("Sheets")
    for other in book.pages[1:]:
        name = other.sheet.title
        put(page.sheet, page.next, 1, name, page.styles["link"])
        page.sheet.cell(page.next, 1).hyperlink = Hyperlink(ref="", location=f"'{name}'!A1", display=name)
        put(page.sheet, page.next, 2, other.title, page.styles["wrapped"])
        page.next += 1
    page.sheet.print_area = f"A1:B{page.next - 1}"


def verdict_sentence(verdict: dict[str, Any]) -> str:
    """Return a verdict in a sentence, with how the value of its limit is known."""
    name, unit = str(verdict["name"]), verdict["unit"] or ""
    found = "nothing found" if verdict["value"] is None else f"{_number(verdict['value'])} {unit}".strip()
    where = ", ".join(str(part) for part in (verdict["place"], verdict["time"]) if part)
    limit = f"{limit_in_words(verdict['limit'] or 'limit')} {_limit_value(verdict, unit)}".strip()
    sentence = f"{name[:1].upper()}{name[1:]}: {found}{f' ({where})' if where else ''}; limit {limit}: {verdict_word(verdict)}."
    status, source = verdict["status"], verdict["source"]
    if status == "verified":
        return f"{sentence} The value of the limit is verified: {source}."
    known = KNOWN_AS.get(status, status or "of unknown origin")
    return f"{sentence} Checked against an editable value, {known}{f' ({source})' if source else ''}."


def _say(page: Page, label: str, text: str, style: str) -> None:
    """Write a label and a text that is broken into lines."""
    size = 1.35 if style.startswith("big ") else 1.0
    put(page.sheet, page.next, 1, label, page.styles["label"])
    shown = put(page.sheet, page.next, 2, text, page.styles[style]).value or ""
    lines = sum(max(1, math.ceil(len(line) * size / CHARACTERS)) for line in str(shown).split("\n"))
    page.sheet.row_dimensions[page.next].height = min(lines * LINE_POINTS * size + (10.0 if size > 1.0 else 2.0), 400.0)
    page.next += 1


def _head(facts: Facts) -> Iterator[Said]:
    clock, run = facts.scenario.clock, facts.run
    step = run.get("step_s", clock.step_s)
    begin, end = format_time(run.get("start_s", clock.start)), format_time(run.get("end_s", clock.end))
    supply = facts.scenario.supply
    kinds = (
        (len(facts.scenario.runs), "train"),
        (len(supply.substations), "substation"),
        (len(supply.section_cabins), "section cabin"),
        (len(supply.loads), "fixed load"),
    )
    if len(facts.study) > TITLE_LENGTH:
        yield "Study", facts.study, "wrapped"
    yield (
        "What was computed",
        f"{begin} to {end} in steps of {step:g} s: {', '.join(_count(*kind) for kind in kinds)}.",
        "wrapped",
    )
    yield "Coupling", _coupling(facts), "wrapped"


def _count(number: int, kind: str) -> str:
    return f"{number} {kind}" if number == 1 else f"{number} {kind}s"


def _coupling(facts: Facts) -> str:
    if not facts.scenario.runs:
        return "A network calculation: the study has no trains."
    if facts.run.get("coupling", facts.scenario.coupling) == "full":
        return "Full: trains and network limit each other in the same step."
    volts = facts.run.get("coupling_voltage_v", facts.scenario.coupling_voltage_v)
    nominal = facts.limit("u_n")
    if volts is None and nominal is not None:
        volts = nominal.value
    given = f" of {volts:g} V" if volts is not None else ""
    return (
        f"Constant voltage: trains take their currents at a constant voltage{given}, and the network only tells the voltages that"
        " follow. A simplification: low voltages do not slow trains down."
    )


def _verdicts(facts: Facts) -> Iterator[Said]:
    if facts.feasibility is not None:
        sentence, style = verdict_in_words(facts.feasibility)
        yield "Feasibility", sentence, f"big {style}"
    ratings = facts.table("ratings")
    if len(ratings):
        sentence, style = ratings_in_words(one_for_each(ratings), facts.scenario.sizing.utilisation_percent)
        yield "Ratings", sentence, f"big {style}"
    verdicts = facts.verdicts
    violated = [verdict for verdict in verdicts if verdict["met"] is False]
    if violated:
        names = ", ".join(str(verdict["name"]) for verdict in violated)
        yield "Verdict", f"{len(violated)} of {len(verdicts)} limits violated: {names}", "big bad"
    elif verdicts and all(verdict["met"] for verdict in verdicts):
        editable = sum(verdict["status"] != "verified" for verdict in verdicts)
        known = f"; {editable} of their values are editable, not verified" if editable else ""
        yield "Verdict", f"All {len(verdicts)} limits are met{known}", "big good"
    else:
        yield "Verdict", "Not all limits could be judged" if verdicts else "No limits were judged", "big doubt"
    if facts.run.get("status") == "interrupted":
        yield "", "The run was interrupted: all this holds for the part that was computed.", "doubt"
    for verdict in verdicts:
        yield "", verdict_sentence(verdict), {True: "good", False: "bad"}.get(verdict["met"], "doubt")


def _trust(facts: Facts) -> Iterator[Said]:
    """Tell how the run ended, whether its ledgers close, and what it notes; then where it comes from."""
    run = facts.run
    yield "Status of the run", *_status(run)
    if run.get("trains"):
        stuck = any(train.get("status") == "stuck" for train in run["trains"])
        yield "Trains", _trains(run["trains"]), "bad" if stuck else "wrapped"
        yield "Timetable", *_timetable(facts)
    for name, ledger in facts.ledgers.items():
        yield _LEDGERS.get(name, name), *_ledger(ledger)
    overlaps = run.get("overlaps") or {}
    if overlaps.get("count"):
        yield (
            "Overlaps",
            str(overlaps.get("message") or f"{overlaps['count']} times two trains stood on the same place."),
            "doubt",
        )
    notes = run.get("notes") or []
    for note in notes[:MOST_NOTES]:
        yield "Note", str(note), "wrapped"
    if len(notes) > MOST_NOTES:
        yield "Note", f"{len(notes) - MOST_NOTES} more notes are in run.json.", "wrapped"
    yield (
        "Written",
        f"{datetime.now().astimezone():%Y-%m-%d %H:%M} by tractionpower {run.get('versions', {}).get('tractionpower', '')}",
        "wrapped",
    )
    yield "Study, input hash", f"{run.get('study', '')}, {run.get('input_hash', facts.scenario.input_hash)}", "wrapped"


def _timetable(facts: Facts) -> tuple[str, str]:
    """Tell how many trains are late or overdue, and which most."""
    late = sorted((f["value"], f["place"]) for f in facts.results.key_figures if f["name"] == "late_at_end_s")
    overdue = [str(train["train"]) for train in facts.run["trains"] if train.get("overdue_s")]
    if not late:
        return "No call with a planned time.", "wrapped"
    many = sum(value >= 0.5 for value, _ in late)
    text = f"{many} of {len(late)} trains are late at their last timed call"
    text += f", most {late[-1][1]} by {late[-1][0]:.0f} s." if many else "."
    if overdue:
        more = f" and {len(overdue) - MOST_NOTES} more" if len(overdue) > MOST_NOTES else ""
        text += f" Overdue at a call not reached: {', '.join(overdue[:MOST_NOTES])}{more}."
    return text, "bad" if overdue else "doubt" if many else "good"


def _status(run: dict[str, Any]) -> tuple[str, str]:
    steps, flagged = run.get("steps", 0), run.get("flagged_steps", 0)
    status = run.get("status", "unknown")
    if status == "complete":
        return f"Complete: {steps} steps, none flagged.", "good"
    if status == "flagged":
        return f"Flagged: {flagged} of {steps} steps are flagged, or a ledger does not close; sheet Events tells which.", "bad"
    if status == "interrupted":
        return f"Interrupted after {steps} steps: what follows is a part of the run.", "bad"
    return f"{status}: {steps} steps.", "doubt"


def _trains(trains: list[dict[str, Any]]) -> str:
    counts: dict[str, int] = {}
    for train in trains:
        state = str(train.get("status", ""))
        counts[state] = counts.get(state, 0) + 1
    parts = [f"{count} {STATES.get(state, state)}" for state, count in sorted(counts.items())]
    return f"{len(trains)} trains: {', '.join(parts)}."


def _ledger(ledger: dict[str, Any]) -> tuple[str, str]:
    gap = []
    if "worst_gap_w" in ledger:
        gap.append(f"worst gap {ledger['worst_gap_w']:.2g} W")
    if "worst_gap_share" in ledger:
        train = f" (train {ledger['train']})" if ledger.get("train") else ""
        gap.append(f"worst gap {max(ledger['worst_gap_share'], 0.0) * 100.0:.2g} % of what is exchanged{train}")
    words = "Closes" if ledger.get("closes") else "Does not close"
    return f"{words}: {', '.join(gap)}." if gap else f"{words}.", "good" if ledger.get("closes") else "bad"


def _limit_value(verdict: dict[str, Any], unit: str) -> str:
    return "" if verdict["limit_value"] is None else f"= {_number(verdict['limit_value'])} {unit}".strip()


def _number(value: float) -> str:
    return f"{value:z.1f}".removesuffix(".0") if abs(value) < 1e15 else f"{value:g}"

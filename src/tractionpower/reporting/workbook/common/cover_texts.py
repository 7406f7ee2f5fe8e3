"""What the cover of a run tells in sentences: what was computed, how the run ended, how far it can be trusted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tractionpower.model.base import format_time
from tractionpower.reporting.texts import decimal, mark, number, recorded, tr, trn
from tractionpower.reporting.workbook.feasibility.feasibility import verdict_in_words
from tractionpower.reporting.workbook.frame.facts import STATES, Computed, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.sizing.ratings import BANNER as RATINGS
from tractionpower.reporting.workbook.sizing.ratings import one_for_each, ratings_in_words

MOST_NOTES = 8
"""Notes, and cases that were not computed, that a cover tells; it is to stay one page."""

LEDGERS = {
    "electric": mark("Electric ledger"),
    "mechanical": mark("Mechanical ledger"),
    "pantograph_to_wheel": mark("Pantograph to wheel"),
}
"""Names of the ledgers, by the keys of ``run.json``."""

Said = tuple[str, str | Formula, str]
"""Label, text, and style of the text."""


def run_head(facts: Facts) -> Iterator[Said]:
    """Tell what was computed."""
    clock, run = facts.scenario.clock, facts.run
    step = run.get("step_s", clock.step_s)
    begin, end = format_time(run.get("start_s", clock.start)), format_time(run.get("end_s", clock.end))
    supply, trains = facts.scenario.supply, len(facts.scenario.runs)
    of_part = tr("{shown} of {all} trains", shown=len(facts.run.get("trains", ())), all=trains) if facts.part else ""
    parts = (
        of_part or trn("{count} train", "{count} trains", trains),
        trn("{count} substation", "{count} substations", len(supply.substations)),
        trn("{count} section cabin", "{count} section cabins", len(supply.section_cabins)) if supply.section_cabins else "",
        trn("{count} fixed load", "{count} fixed loads", len(supply.loads)) if supply.loads else "",
    )
    words = tr("{begin} to {end} in steps of {step} s", begin=begin, end=end, step=number(step, 3))
    if facts.part:
        yield tr("Part of the run"), facts.part, "wrapped"
    yield tr("What is shown") if facts.part else tr("What was computed"), f"{words}: {', '.join(filter(None, parts))}.", "wrapped"
    yield tr("Coupling"), _coupling(facts), "wrapped"


def judged_elsewhere(facts: Computed) -> str:
    """Return what there is to say of the verdicts in the report of a part."""
    counts = facts.run.get("whole_run") or {}
    words = tr("Limits are judged for the whole run, not for a part of it.")
    if not counts or not sum(counts.values()):
        return words
    told = tr(
        "There {met} of {all} limits are met, {violated} violated, {open} not judged; its report names them.",
        all=sum(counts.values()),
        **counts,
    )
    return f"{words} {told}"


def _coupling(facts: Facts) -> str:
    if not facts.scenario.runs:
        return tr("A network calculation: the study has no trains.")
    if facts.run.get("coupling", facts.scenario.coupling) == "full":
        return tr("Full: trains and network limit each other in the same step.")
    volts = facts.run.get("coupling_voltage_v", facts.scenario.coupling_voltage_v)
    nominal = facts.limit("u_n")
    if volts is None and nominal is not None:
        volts = nominal.value
    if volts is None:
        given = tr("Constant voltage: trains take their currents at a constant voltage")
    else:
        given = tr("Constant voltage: trains take their currents at a constant voltage of {volts} V", volts=number(volts))
    so = tr("and the network only tells the voltages that follow. A simplification: low voltages do not slow trains down.")
    return f"{given}, {so}"


def run_verdicts(facts: Facts) -> Iterator[Said]:
    """Tell what was found on timetable and ratings, beside the limits."""
    if facts.feasibility is not None:
        sentence, style = verdict_in_words(facts.feasibility)
        yield tr("Feasibility"), sentence, style
    ratings = facts.table("ratings")
    if len(ratings):
        sentence, _ = ratings_in_words(one_for_each(ratings), facts.scenario.sizing.utilisation_percent)
        yield tr("Ratings"), Formula(f"{{{RATINGS}}}", sentence), "neutral"
    if facts.run.get("status") == "interrupted":
        yield "", tr("The run was interrupted: all this holds for the part that was computed."), "doubt"


def run_trust(facts: Facts) -> Iterator[Said]:
    """Tell how the run ended, whether its ledgers close, and what it notes."""
    run = facts.run
    yield tr("Status of the run"), *_status(run)
    if run.get("trains"):
        stuck = any(train.get("status") == "stuck" for train in run["trains"])
        yield tr("Trains"), _trains(run["trains"]), "bad" if stuck else "wrapped"
        yield tr("Timetable"), *_timetable(facts)
    for name, ledger in facts.ledgers.items():
        yield tr(LEDGERS.get(name, name)), *_ledger(ledger)
    overlaps = run.get("overlaps") or {}
    if overlaps.get("count"):
        said, count = overlaps.get("message"), int(overlaps["count"])
        met = trn("Two trains stood on the same place once.", "Two trains stood on the same place {count} times.", count)
        yield tr("Overlaps"), recorded(str(said)) if said else met, "doubt"
    yield from notes_of(run.get("notes") or [])


def notes_of(notes: list[Any]) -> Iterator[Said]:
    """Tell the first notes, and how many more there are."""
    for note in notes[:MOST_NOTES]:
        yield tr("Note"), recorded(str(note)), "wrapped"
    more = len(notes) - MOST_NOTES
    if more > 0:
        yield tr("Note"), trn("{count} more note is in run.json.", "{count} more notes are in run.json.", more), "wrapped"


def _status(run: dict[str, Any]) -> tuple[str, str]:
    steps, flagged = run.get("steps", 0), run.get("flagged_steps", 0)
    status = run.get("status", "unknown")
    if status == "complete":
        return tr("Complete: {steps} steps, none flagged.", steps=steps), "good"
    if status == "flagged":
        words = tr("Flagged: {flagged} of {steps} steps are flagged, or a ledger does not close;", flagged=flagged, steps=steps)
        return f"{words} {tr('sheet Events tells which.')}", "bad"
    if status == "interrupted":
        return tr("Interrupted after {steps} steps: what follows is a part of the run.", steps=steps), "bad"
    return f"{recorded(str(status))}: {trn('{count} step', '{count} steps', steps)}.", "doubt"


def _trains(trains: list[dict[str, Any]]) -> str:
    counts: dict[str, int] = {}
    for train in trains:
        state = str(train.get("status", ""))
        counts[state] = counts.get(state, 0) + 1
    parts = [tr("{count} {status}", count=count, status=tr(STATES.get(state, state))) for state, count in sorted(counts.items())]
    return f"{trn('{count} train', '{count} trains', len(trains))}: {', '.join(parts)}."


def _timetable(facts: Facts) -> tuple[str, str]:
    """Tell how many trains are late or overdue, and which most."""
    late = sorted((f["value"], f["place"]) for f in facts.results.key_figures if f["name"] == "late_at_end_s")
    overdue = [str(train["train"]) for train in facts.run["trains"] if train.get("overdue_s")]
    if not late:
        return tr("No call with a planned time."), "wrapped"
    many = sum(value >= 0.5 for value, _ in late)
    text = tr("Late at their last timed call: {late} of {all} trains", late=many, all=len(late))
    if many:
        text += tr(", most {train} by {seconds} s", train=recorded(late[-1][1]), seconds=number(late[-1][0], 0))
    if overdue:
        more = tr(" and {more} more", more=len(overdue) - MOST_NOTES) if len(overdue) > MOST_NOTES else ""
        text += f". {tr('Overdue at a call not reached:')} {', '.join(overdue[:MOST_NOTES])}{more}"
    return f"{text}.", "bad" if overdue else "doubt" if many else "good"


def _ledger(ledger: dict[str, Any]) -> tuple[str, str]:
    gap = []
    if "worst_gap_w" in ledger:
        gap.append(tr("worst gap {gap} W", gap=decimal(f"{ledger['worst_gap_w']:.2g}")))
    if "worst_gap_share" in ledger:
        share = tr("worst gap {gap} % of what is exchanged", gap=decimal(f"{max(ledger['worst_gap_share'], 0.0) * 100.0:.2g}"))
        gap.append(f"{share} ({tr('train')} {ledger['train']})" if ledger.get("train") else share)
    words = tr("Closes") if ledger.get("closes") else tr("Does not close")
    return f"{words}: {', '.join(gap)}." if gap else f"{words}.", "good" if ledger.get("closes") else "bad"

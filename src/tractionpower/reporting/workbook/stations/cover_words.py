"""What the cover of a case of stations tells in sentences, and how far to trust it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tractionpower.reporting.texts import mark, number, tr, trn
from tractionpower.reporting.workbook.common.cover_texts import Said, notes_of
from tractionpower.reporting.workbook.common.evidence import add_origin
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.stations.station_facts import StationFacts, facts_of

METHODS = {
    "euler": mark("Euler with the forces at the beginning of a period of {period} s (TrainDyn, equations 21 and 22)."),
    "fine": mark("Midpoint rule in substeps of 0.1 s, scanned every {period} s."),
    "held_speed": mark("Places by the speed of the sample before, every {period} s; for comparison only."),
}
"""Methods in words."""


def head(facts: StationFacts) -> Iterator[Said]:
    """Tell what was computed."""
    case, run = facts.scenario, facts.run
    line = trn("{count} station", "{count} stations", len(case.stations))
    text = tr("{length} km at {speed} km/h, {stations}.", length=number(case.length_m / 1e3, 3), speed=number(case.speed_kmh),
              stations=line)  # fmt: skip
    yield tr("Line"), text, "wrapped"
    traffic = trn("{count} train", "{count} trains", case.traffic.trains)
    headway = tr("every {seconds} s in the mean, seed {seed}.", seconds=number(case.traffic.headway_s), seed=case.seed)
    yield tr("Traffic"), f"{traffic}, {headway}", "wrapped"
    end = tr("{seconds} s of the traffic.", seconds=number(float(run.get("end_s") or case.run.duration_s), 2))
    method = tr(METHODS[case.run.method], period=number(case.run.period_s, 3))
    yield tr("What was computed"), f"{end} {method}", "wrapped"
    if case.source:
        yield tr("Case"), case.source, "wrapped"


def found(facts: StationFacts) -> Iterator[Said]:
    """Tell what became of the trains."""
    trains = facts.trains
    running = [train.running_s for train in trains if math.isfinite(train.running_s)]
    text = tr("{left} of {all} trains have left the line", left=len(running), all=facts.scenario.traffic.trains)
    if running:
        times = tr("running time {least} to {most} s, mean {mean} s", least=number(min(running)), most=number(max(running)),
                   mean=number(math.fsum(running) / len(running)))  # fmt: skip
        text = f"{text}; {times}"
    yield tr("Trains"), f"{text}.", "neutral"
    waiting = [train for train in trains if train.waited_s > 0.0]
    if waiting:
        longest = max(waiting, key=lambda train: train.waited_s)
        text = tr("{count} trains waited, {name} longest: {seconds} s.", count=len(waiting), name=longest.name,
                  seconds=number(longest.waited_s))  # fmt: skip
        yield tr("Waiting"), text, "neutral"


def trust(facts: StationFacts) -> Iterator[Said]:
    """Tell how the run ended, and what is not covered."""
    status = str(facts.run.get("status", ""))
    if status == "complete":
        yield tr("Status of the run"), tr("Complete."), "good"
    else:
        yield tr("Status of the run"), tr("Interrupted: what follows is a part of the run."), "bad"
    text = tr("Each train is one point at its front; the supply, signals and trains of the other direction are not computed.")
    yield tr("Not covered"), text, "wrapped"
    yield from notes_of(facts.run.get("notes") or [])


def add_evidence(book: Book) -> None:
    """Add the sheet of how it was computed, and from which files."""
    facts = facts_of(book)
    page = book.page("Solver evidence", "Solver evidence: how far these figures can be trusted")
    page.line(tr(METHODS[facts.scenario.run.method], period=number(facts.scenario.run.period_s, 3)))
    page.next += 1
    add_origin(page, facts)

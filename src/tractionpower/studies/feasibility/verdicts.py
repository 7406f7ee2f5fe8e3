"""The verdict on one train: its delays, sections and lost seconds as rows, and why the timetable holds or not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tractionpower.model.scenario import ROUNDING_S
from tractionpower.studies.feasibility.areas import Areas
from tractionpower.studies.feasibility.chain import START, Chain, Link, TrainFacts
from tractionpower.studies.feasibility.judgement import (
    FEASIBLE,
    INFEASIBLE,
    NAN,
    NOT_FINISHED,
    NOT_JUDGED,
    CallDelay,
    LostTime,
    SectionVerdict,
    TrainVerdict,
    Verdict,
)
from tractionpower.studies.feasibility.lost import LossProfile, loss_profile, lost_times
from tractionpower.studies.feasibility.words import Story, why

NOT_REACHED = "not_reached"
"""Cause of a timed call that a train did not come to, though it was due."""


@dataclass(frozen=True, slots=True)
class Span:
    """The time that counts [s], and the lateness from which on a train is late [s]."""

    from_s: float
    until_s: float
    tolerance_s: float


@dataclass(frozen=True, eq=False)
class Judged:
    """Everything that is found of one train."""

    verdict: TrainVerdict
    delays: list[CallDelay]
    sections: list[SectionVerdict]
    lost: list[LostTime]


def judge_train(facts: TrainFacts, chain: Chain, areas: Areas, span: Span, useful_v: tuple[float, float]) -> Judged:
    """Return what is found of a train.

    Parameters
    ----------
    facts, chain, areas
        What is known of it, its timed calls, and the areas in which it may lose seconds to low voltage.
    span
        The time that counts.
    useful_v
        Mean useful voltage by both definitions [V].
    """
    counted = [n for n, link in enumerate(chain.links) if _counts(link, span)]
    links = [chain.links[n] for n in counted]
    profile = loss_profile(facts, areas, -np.inf)  # a delay that counts may have arisen before
    span = replace(span, from_s=_counts_from(links, span))
    lost = loss_profile(facts, areas, span.from_s)
    delays = [_delay(facts, link, span) for link in links]
    sections = [_section(facts, link, profile) for link in links if link.moves]
    verdict = _verdict(facts, chain, counted, profile, span)
    shortest, ratio = _whole_run(facts, span)
    verdict = replace(
        verdict,
        shortest_s=shortest,
        running_time_ratio=ratio,
        mean_useful_voltage_current_weighted_v=useful_v[0],
        mean_useful_voltage_time_mean_v=useful_v[1],
        lost_voltage_s=float(lost.lost_s.sum()),
        lost_area=lost.worst_area(),
    )
    return Judged(verdict, delays, sections, list(lost_times(facts.name, lost)))


def _counts_from(links: Sequence[Link], span: Span) -> float:
    """Return from when on the seconds of a train count [s]: a section counts as a whole if its end does."""
    begins = [link.before.actual_s for link in links[:1] if np.isfinite(link.before.actual_s)]
    return min([span.from_s, *begins])


def _counts(link: Link, span: Span) -> bool:
    """Tell whether a timed call lies within the time that counts: neither in the warm-up nor before the clock."""
    time_s = link.event.actual_s if np.isfinite(link.event.actual_s) else max(link.event.planned_s, span.from_s)
    return bool(time_s >= span.from_s - ROUNDING_S)


def _is_overdue(link: Link, span: Span) -> bool:
    return not np.isfinite(link.event.actual_s) and link.event.planned_s + span.tolerance_s < span.until_s


def _delay(facts: TrainFacts, link: Link, span: Span) -> CallDelay:
    event = link.event
    station = facts.calls[event.call].station
    if link.lateness is None:
        cause = NOT_REACHED if _is_overdue(link, span) else ""
        return CallDelay(facts.name, station, event.kind, event.planned_s, event.actual_s, cause=cause)
    parts = link.lateness.parts
    cause = max(parts, key=lambda name: parts[name]) if link.lateness.delay_s > span.tolerance_s else ""
    values = {f"{name}_s": value for name, value in parts.items()}
    values |= {f"origin_{name}_s": value for name, value in link.lateness.origins.items()}
    return CallDelay(
        facts.name, station, event.kind, event.planned_s, event.actual_s, link.lateness.delay_s, cause=cause, **values
    )


def _section(facts: TrainFacts, link: Link, profile: LossProfile) -> SectionVerdict:
    first, event = link.before, link.event
    from_m = facts.calls[first.call].at_m if first.call != START else 0.0
    to_m = facts.calls[event.call].at_m
    track, km, area = profile.within(from_m, to_m).worst()
    return SectionVerdict(
        facts.name,
        facts.calls[first.call].station if first.call != START else "",
        facts.calls[event.call].station,
        facts.planned.path.place(from_m)[1],
        facts.planned.path.place(to_m)[1],
        link.planned_s,
        link.shortest_s,
        link.limited_s,
        link.recorded_s if link.lateness is not None else NAN,
        link.actual_s if link.lateness is not None else NAN,
        track,
        km,
        area,
        facts.trace.lowest_v(first.actual_s, event.actual_s) if np.isfinite(event.actual_s) else NAN,
    )


def _whole_run(facts: TrainFacts, span: Span) -> tuple[float, float]:
    """Return the running time alone at nominal voltage [s], and what it grows to on the recorded voltages, as a ratio."""
    shortest = facts.alone.shortest
    rows = facts.trace.rows
    counts = rows["time_s"] >= span.from_s - ROUNDING_S
    counted = rows[counts]
    whole = float(shortest.time_s[-1]) if len(shortest.time_s) else NAN
    if not len(counted):
        return whole, NAN
    ends = np.array([float(counted["s_m"][0]), facts.reached_m])
    recorded = float(np.diff(facts.alone.recorded.until(ends))[0])
    recorded += float(facts.held_s[counts].sum())
    limited = float(np.diff(facts.alone.limited.until(ends))[0])
    return whole, recorded / limited if limited > 0.0 else NAN


def _verdict(facts: TrainFacts, chain: Chain, counted: list[int], profile: LossProfile, span: Span) -> TrainVerdict:
    """Return verdict, reserve, the worst call, and the sentence that says why."""
    links = [chain.links[n] for n in counted]
    came = [link for link in links if link.lateness is not None]
    worst = max(came, key=lambda link: link.lateness.late_s if link.lateness else 0.0, default=None)
    missing = next((link for link in links if _is_overdue(link, span)), None)
    spares = [(float(chain.spare[n]), n) for n in counted if np.isfinite(chain.spare[n])]
    spare, at = min(spares, default=(NAN, None))
    verdict: Verdict = FEASIBLE
    if missing is not None or (facts.is_stuck and not facts.is_finished):
        verdict = NOT_FINISHED
    elif worst is not None and worst.lateness is not None and worst.lateness.late_s > span.tolerance_s:
        verdict = INFEASIBLE
    elif not chain.links or not len(facts.trace.rows[facts.trace.rows["time_s"] >= span.from_s - ROUNDING_S]):
        verdict = NOT_JUDGED
    story = Story(
        facts, chain, worst, missing, profile, span.until_s, verdict, spare, chain.links[at] if at is not None else None
    )
    late = worst.lateness if worst is not None else None
    is_late = late is not None and late.late_s > span.tolerance_s
    return TrainVerdict(
        facts.name,
        verdict,
        spare,
        story.reserve_at,
        facts.calls[worst.event.call].station if worst is not None else "",
        late.late_s if late is not None else NAN,
        max(late.origins, key=lambda name: late.origins[name]) if late is not None and is_late else "",
        why(story),
    )

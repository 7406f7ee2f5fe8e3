"""Verdicts in words: where a train is late, and where it lost the seconds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tractionpower.model.base import format_time
from tractionpower.studies.feasibility.chain import START, Chain, Link, TrainFacts
from tractionpower.studies.feasibility.judgement import FEASIBLE, INFEASIBLE, NOT_JUDGED
from tractionpower.studies.feasibility.lost import LossProfile

TOLD_S = 0.5
"""Parts of a delay that are smaller are not told [s]."""

CAUSES = {
    "current_limit": "{s:.0f} s to train current limits",
    "driving": "{s:.0f} s to driving that is not flat out",
    "dwell": "{s:.0f} s at stops and turn-rounds",
    "timetable": "{s:.0f} s to a timetable that gives too little time",
}


@dataclass(frozen=True, eq=False)
class Story:
    """What is told of one train.

    Attributes
    ----------
    facts, chain, profile
        The train, its timed calls, and where it loses seconds.
    worst, missing
        The timed call at which it is latest, and the first one that it did not come to though it was due; None: none.
    until_s
        End of the run [s].
    verdict
        The verdict.
    spare_s, tightest
        Least time by which it could come earlier [s], and to which timed call.
    """

    facts: TrainFacts
    chain: Chain
    worst: Link | None
    missing: Link | None
    profile: LossProfile
    until_s: float
    verdict: str
    spare_s: float
    tightest: Link | None

    @property
    def reserve_at(self) -> str:
        """The section at whose end the least reserve is left."""
        if self.tightest is None:
            return ""
        first, last = self.tightest.before.call, self.station(self.tightest)
        if first == START or not self.tightest.moves:
            return last
        return f"{self.facts.calls[first].station}–{last}"

    def station(self, link: Link) -> str:
        """Return the station of a timed call."""
        return self.facts.calls[link.event.call].station


def why(story: Story) -> str:
    """Return the verdict in a sentence."""
    if story.verdict == NOT_JUDGED:
        if not story.chain.links:
            return f"has no call with a planned time: no verdict on delays; {_running(story)}"
        return "nothing of its run lies within the time that counts"
    if story.verdict == INFEASIBLE and story.worst is not None:
        return _late(story, story.worst)
    if story.verdict != FEASIBLE:
        return _not_there(story)
    words = "on time"
    if np.isfinite(story.spare_s):
        words += f", with {story.spare_s:.0f} s of reserve left at {story.reserve_at}"
    unreached = next((link for link in story.chain.links if link.lateness is None), None)
    if unreached is not None:
        words += f"; the clock ends before its planned time at {story.station(unreached)}"
    return words


def _late(story: Story, worst: Link) -> str:
    lateness = worst.lateness
    assert lateness is not None
    told = sorted(((s, name) for name, s in lateness.origins.items() if s >= TOLD_S), reverse=True)
    parts = [_part(story, worst, name, s) for s, name in told]
    words = f"late {lateness.late_s:.0f} s at {story.station(worst)}"
    return f"{words}: {', '.join(parts)}" if parts else words


def _part(story: Story, worst: Link, name: str, seconds: float) -> str:
    if name != "voltage":
        return CAUSES[name].format(s=seconds)
    profile = _where_lost(story, worst)
    words, stretch, area = f"{seconds:.0f} s lost to low voltage", profile.stretch(), profile.worst_area()
    if stretch is not None:
        words += f" between km {stretch[0]:.0f} and {stretch[1]:.0f}"
    if not area:
        return words
    whole = float(np.maximum(profile.lost_s, 0.0).sum())
    more = f"; of {whole:.0f} s lost there its reserve takes up the rest" if round(whole) > round(seconds) else ""
    return f"{words} (area {area}{more})"


def _where_lost(story: Story, worst: Link) -> LossProfile:
    """Return the losses on the way on which the delay by low voltage at a call arose: since it last left a stop without one."""
    links = story.chain.links
    last = links.index(worst)
    first = last
    while first > 0 and (before := links[first - 1]).lateness is not None:
        if before.event.kind == "departure" and not before.lateness.origins["voltage"] > 0.0:
            break
        first -= 1
    begin = links[first].before.call
    calls = story.facts.calls
    return story.profile.within(calls[begin].at_m if begin != START else 0.0, calls[worst.event.call].at_m)


def _not_there(story: Story) -> str:
    facts = story.facts
    track, km = facts.planned.path.place(facts.reached_m)
    if facts.is_stuck:
        words = f"stuck on track {track} at km {km:.1f}, since effort or power lack"
    elif not np.isfinite(facts.entered_s):
        words = "does not enter"
    else:
        words = f"on track {track} at km {km:.1f} when the clock ends"
    if story.missing is None:
        return words
    planned = format_time(round(story.missing.event.planned_s))
    overdue = story.until_s - story.missing.event.planned_s
    return f"{words}: not at {story.station(story.missing)}, planned {planned}, {overdue:.0f} s before the end of the run"


def _running(story: Story) -> str:
    """Return the running time in words."""
    profile, alone = story.profile, story.facts.alone
    lost, shortest = float(profile.lost_s.sum()), float(alone.shortest.time_s[-1])
    words = f"alone at nominal voltage it runs {shortest:.0f} s"
    if abs(lost) < TOLD_S:
        return f"{words}, low voltage costs it nothing"
    return f"{words}, low voltage costs it {lost:.0f} s" if lost > 0.0 else f"{words}, higher voltage saves it {-lost:.0f} s"

"""From what a timetable file tells of a train to a run of the timetable: times in order, stops told from passings, a route."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.imports.tables.cell_times import CellTime
from tractionpower.io.imports.tables.day_words import DAYS, days_of
from tractionpower.io.imports.tables.drafts import Draft, Stop
from tractionpower.io.imports.tables.headings import plain_words
from tractionpower.io.imports.tables.station_names import listed
from tractionpower.io.imports.tables.ways import Ways
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.model.base import DAY_S, format_time

OVER_MIDNIGHT_S = 43200.0
"""A time that falls by more than this is one of the next day; by less it is an error, as it is to rise by more [s]."""

LATEST_START_S = 36 * 3600.0
"""A train that starts after noon of the day after is doubted [s]."""


@dataclass(slots=True)
class Settler:
    """Makes runs of drafts; counts what it assumes.

    Attributes
    ----------
    ways
        Finds routes.
    known_trains
        Ids of trains that exist.
    train
        Train of runs that name none.
    dwell_s
        Shortest dwell at stops that name none [s]; None: no least dwell.
    counts
        How often each assumption was made.
    problems
        What is wrong.
    doubts
        What is doubtful.
    span_s
        First and last time of all trains [s].
    """

    ways: Ways
    known_trains: list[str]
    train: str | None = None
    dwell_s: float | None = None
    counts: Counter[str] = field(default_factory=Counter)
    problems: list[Problem] = field(default_factory=list)
    doubts: list[Problem] = field(default_factory=list)
    span_s: list[float] = field(default_factory=list)

    def run(self, draft: Draft) -> dict[str, Any] | None:
        """Return a run as the timetable file has it, or None if something of it is wrong."""
        before = len(self.problems)
        run: dict[str, Any] = {"id": draft.id, **self._words(draft)}
        if len(draft.stops) < 2 and draft.is_whole:
            found = "one call only" if draft.stops else "no calls"
            self.problems.append(draft.problem("too_few_calls", found, "two calls or more"))
        legs: list[dict[str, Any]] | int = []
        if len(draft.stops) > 1 and draft.is_whole:
            legs = self.ways.find([stop.station for stop in draft.stops], [stop.track for stop in draft.stops])
        twice = _twice(draft) if isinstance(legs, int) else None
        calls = list(self._calls(draft)) if twice is None else []  # times of two trains are in no order
        if twice is not None:
            self.problems.append(twice)
        elif isinstance(legs, int):
            self.problems.append(_out_of_reach(draft, legs))
        if len(self.problems) > before or isinstance(legs, int) or not legs:
            return None
        run["route"] = legs
        if "departure" not in calls[0]:  # it comes through: where the route begins it is at speed
            self.counts["enters"] += 1
            run["start"] = {"time": calls[0]["arrival"]}
            calls = calls[1:]
        run["calls"] = calls
        return run

    def told(self) -> Iterator[str]:
        """Yield what was assumed, in words with counts."""
        for key, words in _ASSUMED.items():
            if self.counts[key]:
                yield words.format(self.counts[key], dwell=self.dwell_s, **_forms(self.counts[key]))

    def _words(self, draft: Draft) -> dict[str, Any]:
        words: dict[str, Any] = {}
        known = {plain_words(name): name for name in self.known_trains}
        wanted = draft.train_type or self.train or ""
        if not wanted:
            remedy = "a column with the train of each run, or --train ID for all"
            self.problems.append(
                draft.problem("no_train_type", "nothing says what train it is", listed(self.known_trains), remedy)
            )
        elif plain_words(wanted) not in known:
            hint = did_you_mean(wanted, self.known_trains) or "add the file in rollingstock/trains, or --train ID"
            self.problems.append(draft.problem("unknown_train", f"no train {shown(wanted)}", listed(self.known_trains), hint))
        else:
            words["train"] = known[plain_words(wanted)]
        if draft.category:
            words["category"] = draft.category
        if draft.days:
            try:
                days = days_of(draft.days)
            except ValueError as error:
                allowed = "mon tue wed thu fri sat sun, Mo-Fr, 1-5, daily"
                self.problems.append(draft.problem("bad_days", f"days {shown(draft.days)}: no day {error}", allowed))
            else:
                words |= {"days": list(days)} if days != DAYS else {}
        return words

    def _calls(self, draft: Draft) -> Iterator[dict[str, Any]]:
        """Yield the calls of a train with its times in order."""
        clock = _Clock()
        early = next((each for stop in draft.stops[:1] for each in (stop.departure, stop.arrival) if each is not None), None)
        if early is not None and early.seconds is not None and early.seconds >= LATEST_START_S:
            found = f"it starts at {format_time(early.seconds)}, which is {format_time(early.seconds % DAY_S)} a day later"
            remedy = "it is read as it stands; correct the hour if it is wrong"
            doubt = draft.problem("late_in_the_day", found, remedy=remedy, stop=draft.stops[0])
            self.doubts.append(replace(doubt, severity="warning"))
        last = len(draft.stops) - 1
        for k, stop in enumerate(draft.stops):
            arrival, departure, stops = self._kind(draft, stop, k == 0, k == last)
            call: dict[str, Any] = {"station": stop.station.id}
            for name, said in (("arrival", arrival), ("departure", departure)):
                if said is None:
                    continue
                what = f"{name} {format_time(said)} at {stop.station.id}"
                seconds = clock.at(said)
                own = name == "departure" and arrival is not None and said < arrival <= said + OVER_MIDNIGHT_S
                if own or seconds is None:
                    earlier = format_time(arrival if own and arrival is not None else clock.last_s)
                    found = f"{what} is before {earlier}, the time before it"
                    self.problems.append(draft.problem("times_fall", found, "times that rise, or fall past midnight", stop=stop))
                elif seconds - clock.before_s > OVER_MIDNIGHT_S:
                    found = f"{what} is {(seconds - clock.before_s) / 3600.0:.1f} h after the time before it"
                    allowed = f"at most {OVER_MIDNIGHT_S / 3600.0:g} h"
                    self.problems.append(draft.problem("implausible_time", found, allowed, "correct the hour", stop=stop))
                    clock.forget()
                else:
                    call[name] = format_time(seconds)
                    self.span_s += [seconds]
            if stops and k < last and k > 0:
                least = self._dwell(stop, arrival, departure)
                call |= {"min_dwell_s": least} if least else {}
            yield call if stops else call | {"stops": False}
        self.counts["midnight"] += clock.rolled > 0

    def _kind(self, draft: Draft, stop: Stop, first: bool, last: bool) -> tuple[float | None, float | None, bool]:
        """Return arrival and departure as they stand in the file [s], and whether the train stops."""
        said = [each for each in (stop.arrival, stop.departure) if each is not None]
        arrival, departure = _seconds(stop.arrival), _seconds(stop.departure)
        for each in said:
            self.counts[each.way] += each.seconds is not None
        either = departure if departure is not None else arrival
        passes = stop.stops is False or (stop.stops is None and any(each.passes for each in said))
        if not passes and either is None and not stop.min_dwell_s and stop.stops is None:
            passes = True
            self.counts["bare"] += 1
        if first or last:
            if either is None and draft.is_whole:
                what = "departure" if first else "arrival"
                self.problems.append(draft.problem("no_time", f"no {what} at {stop.station.id}", "a time", stop=stop))
            return (
                (either, None, False)
                if passes
                else (None, either, True)
                if first
                else (either if arrival is None else arrival, None, True)
            )
        if passes:
            return either, None, False
        self.counts["single"] += (arrival is None) != (departure is None)
        return arrival, departure, True

    def _dwell(self, stop: Stop, arrival: float | None, departure: float | None) -> float:
        self.counts["zero"] += arrival is not None and arrival == departure and stop.min_dwell_s is None and self.dwell_s is None
        if stop.min_dwell_s is not None:
            return stop.min_dwell_s
        self.counts["dwell"] += self.dwell_s is not None
        return self.dwell_s or 0.0


@dataclass(slots=True)
class _Clock:
    # Times of a train one after the other; past midnight they fall.
    last_s: float = -1.0
    before_s: float = 0.0
    _offset_s: float = 0.0
    rolled: int = 0

    def at(self, said: float) -> float | None:
        """Return the time with the days that have passed, or None if it falls without passing midnight."""
        seconds = said + self._offset_s
        self.before_s = self.last_s if self.last_s >= 0.0 else seconds
        if seconds < self.last_s - OVER_MIDNIGHT_S:
            self._offset_s += DAY_S
            self.rolled += 1
            seconds += DAY_S
        if seconds < self.last_s:
            return None
        self.last_s = seconds
        return seconds

    def forget(self) -> None:
        """Take back the last time."""
        self.last_s = self.before_s


def _forms(number: int) -> dict[str, str]:
    return {"s": "s" if number > 1 else "", "verb": "" if number > 1 else "s"}


def _seconds(said: CellTime | None) -> float | None:
    return None if said is None else said.seconds


def _twice(draft: Draft) -> Problem | None:
    """Return what is wrong where calls come twice: those of two trains, or a station that follows itself."""
    names = [stop.station.id for stop in draft.stops]
    for k in range(2, len(names) - 1):
        if names[k : k + 2] == names[:2]:
            found = "a second train of this number, from here on it calls again where it began"
            return draft.problem("duplicate_id", found, "each number once", "number the trains apart", draft.stops[k])
    for k, (before, here) in enumerate(pairwise(names), start=1):
        if before == here:
            found = f"{here} twice running"
            remedy = "one row holds arrival and departure; if these are two trains, number them apart"
            return draft.problem("station_twice", found, "each call once", remedy, draft.stops[k])
    return None


def _out_of_reach(draft: Draft, reached: int) -> Problem:
    stop = draft.stops[reached]
    track = f" on track {stop.track}" if stop.track else ""
    if reached == 0:
        return draft.problem("no_way", f"no track at {stop.station.id}{track}", "a station on a track", stop=stop)
    before = draft.stops[reached - 1].station.id
    found = f"no way from {before} on to {stop.station.id}{track} without turning round"
    remedy = (
        "a train that turns round is two runs, and two trains have two numbers; tracks are joined by line.connections; a column"
        " track names them"
    )
    return draft.problem("no_way", found, remedy=remedy, stop=stop)


_ASSUMED = {
    "midnight": "{} train{s} past midnight: a time that falls by more than 12 hours is of the next day",
    "dots": "{} time{s} with a point (7.30): hours and minutes",
    "number": "{} number{s} without a time format: parts of a day",
    "date": "{} time{s} with a date: the date is left out",
    "single": "{} stop{s} with one time: the departure (at the last stop the arrival); the other is not judged",
    "bare": "{} station{s} without a time: passed without a stop",
    "zero": "{} stop{s} with equal arrival and departure: no shortest dwell (--dwell S gives one)",
    "dwell": "{} stop{s} without a shortest dwell: {dwell:g} s (--dwell)",
    "enters": "{} train{s} that begin{verb} by passing a station: from rest; `start: {{time, speed_kmh}}` gives a speed",
}

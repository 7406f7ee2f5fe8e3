"""Which services of a feed run on a day, and which day is taken where none is named."""

from __future__ import annotations

import re
from datetime import date, datetime, timedelta

import pandas as pd

from tractionpower.errors import Problem, UsageError
from tractionpower.io.imports.gtfs.feed import WEEKDAYS, Feed, rows_of
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.imported import Notes
from tractionpower.io.wording import counted, printable

_LONGEST_DAYS = 3660
_NAMES = tuple(name[:3] for name in WEEKDAYS)


def services_of_the_day(feed: Feed, trips: pd.DataFrame, options: GtfsOptions, notes: Notes) -> set[str]:
    """Return the services whose trips run on the day asked for, or on the one that is chosen; tells which it is."""
    if not (feed.has("calendar") or feed.has("calendar_dates")):
        return _without_calendar(trips, options, notes)
    calendar = _Calendar(feed, notes)
    wanted = _wanted(options)
    if not calendar.days:
        return set()
    if isinstance(wanted, date):
        services = calendar.services(wanted)
        notes.read.append(f"services of {wanted} ({WEEKDAYS[wanted.weekday()]}): {', '.join(sorted(services)) or 'none'}")
        if not trips["service_id"].isin(services).any():
            found = f"no trip by rail runs on {wanted}"
            allowed = f"the feed is valid from {calendar.days[0]} to {calendar.days[-1]}"
            notes.problems.append(Problem("no_trips", "", found, allowed, "choose another date", place="calendar.txt"))
        return services
    return _choose(calendar, trips, wanted, options, notes)


def _choose(calendar: _Calendar, trips: pd.DataFrame, weekday: int, options: GtfsOptions, notes: Notes) -> set[str]:
    counts = trips["service_id"].value_counts().to_dict()

    def trips_on(day: date) -> int:
        return sum(int(counts.get(service, 0)) for service in calendar.services(day))

    days = [day for day in calendar.days if day.weekday() == weekday]
    best = max(days, key=trips_on, default=None)  # the first of equals
    if best is None or trips_on(best) == 0:
        if options.day is None:
            best = max(calendar.days, key=trips_on)
        if best is None or trips_on(best) == 0:
            found = f"no trip by rail runs on any {WEEKDAYS[weekday] if options.day else 'day'} of the feed"
            allowed = f"the feed is valid from {calendar.days[0]} to {calendar.days[-1]}"
            notes.problems.append(Problem("no_trips", "", found, allowed, place="calendar.txt"))
            return set()
    services = calendar.services(best)
    notes.assumed.append(
        f"no date was asked for: {best}, a {WEEKDAYS[best.weekday()].capitalize()}, is the first such day with most trips by rail"
        f" (services {', '.join(sorted(services & set(counts)))})"
    )
    return services


def check_day(options: GtfsOptions) -> None:
    """Refuse a date or a day of the week that is none.

    Raises
    ------
    UsageError
        If there is no such day.
    """
    _wanted(options)


def _wanted(options: GtfsOptions) -> date | int:
    """Return the date asked for, or the number of the day of the week."""
    name = None if options.day is None else options.day[:3].lower()
    if name is not None and name not in _NAMES:
        raise UsageError(f"--day {printable(options.day or '')}: no day of the week; allowed: {', '.join(_NAMES)}")
    if options.date is None:
        return _NAMES.index(name or "wed")
    parsed = _date(options.date.replace("-", ""))
    if parsed is None:
        text = printable(options.date)
        is_written_well = re.fullmatch(r"\d{4}-?\d\d-?\d\d", options.date) is not None
        raise UsageError(f"--date {text}: " + ("there is no such day" if is_written_well else "give YYYYMMDD or YYYY-MM-DD"))
    if name is not None and _NAMES[parsed.weekday()] != name:
        raise UsageError(f"--day {name}: {parsed} is a {WEEKDAYS[parsed.weekday()]}; leave out --date or --day")
    return parsed


def _without_calendar(trips: pd.DataFrame, options: GtfsOptions, notes: Notes) -> set[str]:
    if options.repair:
        notes.repaired.append("neither calendar.txt nor calendar_dates.txt has rows: all trips are taken as those of one day")
        return set(trips["service_id"])
    found = "neither calendar.txt nor calendar_dates.txt has rows, so that no day is known"
    remedy = "add one of them; with repair all trips are taken as those of one day"
    notes.problems.append(Problem("no_calendar", "", found, remedy=remedy, place="calendar.txt"))
    return set()


def _date(text: str) -> date | None:
    try:
        return datetime.strptime(text, "%Y%m%d").date()
    except ValueError:
        return None


class _Calendar:
    """The days of a feed with the services that run on each."""

    def __init__(self, feed: Feed, notes: Notes) -> None:
        self._weekly: list[tuple[str, date, date, tuple[bool, ...]]] = []
        self._exceptions: dict[date, dict[str, bool]] = {}
        bad: list[str] = []
        for line, row in rows_of(feed.table("calendar")):
            first, last = _date(row["start_date"]), _date(row["end_date"])
            if first is None or last is None:
                bad.append(f"calendar.txt:{line}")
            else:
                runs = tuple(row[name] == "1" for name in WEEKDAYS)
                self._weekly.append((row["service_id"], first, last, runs))
        for line, row in rows_of(feed.table("calendar_dates")):
            day = _date(row["date"])
            if day is None or row["exception_type"] not in ("1", "2"):
                bad.append(f"calendar_dates.txt:{line}")
            else:
                self._exceptions.setdefault(day, {})[row["service_id"]] = row["exception_type"] == "1"
        if bad:
            found = f"{counted(len(bad), 'row')} without a date YYYYMMDD, or with an exception_type that is neither 1 nor 2"
            notes.problems.append(Problem("bad_calendar", "", found, remedy="correct them", place=bad[0]))
        if not feed.has("calendar"):
            notes.read.append("the feed has no calendar.txt: its days are those of calendar_dates.txt")
        if not feed.has("calendar_dates"):
            notes.read.append("the feed has no calendar_dates.txt: its days are those of calendar.txt, without exceptions")
        self.days = self._all_days()

    def _all_days(self) -> list[date]:
        ends = [day for _, first, last, _ in self._weekly for day in (first, last)] + list(self._exceptions)
        if not ends:
            return []
        first, last = min(ends), max(ends)
        return [first + timedelta(days=k) for k in range(min((last - first).days + 1, _LONGEST_DAYS))]

    def services(self, day: date) -> set[str]:
        """Return the services that run on a day."""
        found = {name for name, first, last, runs in self._weekly if first <= day <= last and runs[day.weekday()]}
        for name, added in self._exceptions.get(day, {}).items():
            (found.add if added else found.discard)(name)
        return found

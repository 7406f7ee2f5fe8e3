"""Stations of a line by what a timetable calls them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from tractionpower.errors import Problem
from tractionpower.io.excel import Sheet
from tractionpower.io.imports.tables.headings import plain_words
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.model.line import Line, Station

_MOST_LISTED = 12


@dataclass(slots=True)
class StationNames:
    """Finds stations by id or name, and keeps in mind the names that it does not know.

    Parameters
    ----------
    line
        The line.
    """

    line: Line
    _known: dict[str, list[Station]] = field(default_factory=dict)
    _missed: dict[str, tuple[Sheet, int, int]] = field(default_factory=dict)
    _times: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        for station in self.line.stations:
            for word in dict.fromkeys((plain_words(station.id), plain_words(station.name))):
                if word and station not in (known := self._known.setdefault(word, [])):
                    known.append(station)

    def knows(self, text: str) -> bool:
        """Return whether a text names a station."""
        return plain_words(text) in self._known

    def find(self, text: str, sheet: Sheet, row: int, column: int) -> Station | None:
        """Return the station that a cell names; None, and a problem later, if there is none or more than one."""
        found = self._known.get(plain_words(text), [])
        exact = [station for station in found if station.id == text]
        if len(found) == 1 or exact:
            return (exact or found)[0]
        self._missed.setdefault(text, (sheet, row, column))
        self._times[text] += 1
        return None

    def problems(self) -> Iterator[Problem]:
        """Yield one problem for each name that was not found."""
        for text, (sheet, row, column) in self._missed.items():
            many = f", {self._times[text]} times in all" if self._times[text] > 1 else ""
            same = self._known.get(plain_words(text), [])
            if same:
                ids = ", ".join(station.id for station in same)
                yield sheet.problem(
                    "ambiguous_station", row, column, f"{shown(text)} names {len(same)} stations{many}", f"ids: {ids}"
                )
                continue
            hint = did_you_mean(text, self._names()) or "write the station as line.yaml does, or add it there"
            yield sheet.problem("unknown_station", row, column, f"the station {shown(text)}{many}", listed(self._names()), hint)

    def _names(self) -> list[str]:
        return list(dict.fromkeys(name for s in self.line.stations for name in (s.name or s.id, s.id)))


def listed(names: Iterable[str]) -> str:
    """Return some names in a row, and how many there are if not all are shown."""
    every = list(names)
    more = f", ... ({len(every)} in all)" if len(every) > _MOST_LISTED else ""
    return ", ".join(every[:_MOST_LISTED]) + more

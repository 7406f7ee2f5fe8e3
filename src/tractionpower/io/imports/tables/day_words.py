"""Days of operation as timetables write them: names and numbers of days, and ranges of them."""

from __future__ import annotations

import re

from tractionpower.io.imports.tables.headings import plain_words

DAYS = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
_NAMES = {
    "mon": ("1", "mo", "monday", "pn", "pon", "poniedzialek", "montag", "lun", "lunedi"),
    "tue": ("2", "tu", "tuesday", "wt", "wto", "wtorek", "di", "die", "dienstag", "mar", "martedi"),
    "wed": ("3", "we", "wednesday", "sr", "sro", "sroda", "mi", "mit", "mittwoch", "mer", "mercoledi"),
    "thu": ("4", "th", "thursday", "cz", "czw", "czwartek", "do", "don", "donnerstag", "gio", "giovedi"),
    "fri": ("5", "fr", "friday", "pt", "pia", "piatek", "fre", "freitag", "ven", "venerdi"),
    "sat": ("6", "sa", "saturday", "so", "sob", "sobota", "sam", "samstag", "sab", "sabato"),
    "sun": ("7", "su", "sunday", "nd", "nie", "ndz", "niedziela", "sonntag", "dom", "domenica"),
}
_DAY = {name: day for day, names in _NAMES.items() for name in (day, *names)}
_GROUPS = {
    "daily": DAYS, "every day": DAYS, "all": DAYS, "codziennie": DAYS, "taglich": DAYS, "giornaliero": DAYS,
    "tutti i giorni": DAYS,
    "workdays": DAYS[:5], "weekdays": DAYS[:5], "robocze": DAYS[:5], "dni robocze": DAYS[:5], "werktags": DAYS[:6],
    "feriali": DAYS[:6],
    "weekend": DAYS[5:], "weekends": DAYS[5:], "wochenende": DAYS[5:],
}  # fmt: skip


def days_of(text: str) -> tuple[str, ...]:
    """Return the days that a text names, in the order of the week.

    >>> days_of("Mo-Fr"), days_of("(1)-(5), nd"), days_of("sat sun")
    (('mon', 'tue', 'wed', 'thu', 'fri'), ('mon', 'tue', 'wed', 'thu', 'fri', 'sun'), ('sat', 'sun'))

    Raises
    ------
    ValueError
        If a word is no day.
    """
    words = plain_words(text)
    if words in _GROUPS:
        return _GROUPS[words]
    if re.fullmatch(r"[1-7]{2,7}", words):  # 12345
        return tuple(day for day in DAYS if day in {_DAY[digit] for digit in words})
    found: set[str] = set()
    for part in re.split(r"[,;+/&]|\s+(?![-–])(?<![-–]\s)", text.strip()):
        ends = [_day(plain_words(end)) for end in re.split(r"[-–]", part) if end.strip()]
        if len(ends) > 2:
            raise ValueError(part)
        if ends:
            first, last = DAYS.index(ends[0]), DAYS.index(ends[-1])
            found.update(DAYS[k % 7] for k in range(first, last + 1 + 7 * (last < first)))
    if not found:
        raise ValueError(text)
    return tuple(day for day in DAYS if day in found)


def _day(word: str) -> str:
    if word not in _DAY:
        raise ValueError(word)
    return _DAY[word]

"""Which names fit along an axis, and which ticks suit a clock."""

from __future__ import annotations

from collections.abc import Sequence

CLOCK_STEPS_S = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 21600)
"""Steps between ticks of a clock [s]."""

LETTER, LINE = 0.075, 0.17
"""Width of a letter and height of a line of small text [inches]."""


MOST_STATION_LETTERS = 24
"""Letters of the name of a station or device along an axis; of a longer one the beginning stands there."""

MOST_LETTERS = 44
"""Letters of a name beside a row of a figure."""


def row_name(text: str) -> str:
    """Return a name beside a row of a figure, cut where it would take the room of what it names.

    >>> row_name("track 1")
    'track 1'
    """
    return shortened(text, MOST_LETTERS)


def shortened(text: str, most: int) -> str:
    """Return a text of `most` letters at most; of a longer one the beginning.

    >>> shortened("Grodzisk Mazowiecki", 10)
    'Grodzisk …'
    """
    return text if len(text) <= most else f"{text[: most - 1]}…"


def fitting(places: Sequence[float], important: Sequence[bool], gap: float | Sequence[float]) -> list[int]:
    """Return the indices of the labels to show, rising by place, so that any two are `gap` or more apart.

    Important ones come first, then those at the ends, then the others. Where each label has a gap of its own, two need the
    mean of theirs.

    >>> fitting([0.0, 1.0, 5.0, 5.5, 9.0], [False, True, False, False, False], 2.0)
    [1, 2, 4]
    >>> fitting([0.0, 1.0, 2.0], [False, False, False], [1.0, 1.0, 3.0])
    [0, 2]
    """
    wide = [gap] * len(places) if isinstance(gap, int | float) else gap
    ends = {min(places, default=0.0), max(places, default=0.0)}
    order = sorted(range(len(places)), key=lambda k: (not important[k], places[k] not in ends, places[k]))
    kept: list[int] = []
    for k in order:
        if all(abs(places[k] - places[other]) >= (wide[k] + wide[other]) / 2 for other in kept):
            kept.append(k)
    return sorted(kept, key=lambda k: places[k])


def clock_ticks(begin_s: float, end_s: float, most: int = 10) -> list[float]:
    """Return round times of day [s] from `begin_s` to `end_s`, at most some `most` of them."""
    width = max(end_s - begin_s, 1e-9)
    step = next((step for step in CLOCK_STEPS_S if width / step <= most), 3600 * 24)
    first = -int(-begin_s // step)
    return [float(k * step) for k in range(first, int(end_s // step) + 1)]


def clock(seconds: float, ticks: Sequence[float] = ()) -> str:
    """Return a time of day as HH:MM, with seconds if one of `ticks` has some.

    >>> clock(90000.0), clock(90015.0, [90015.0])
    ('25:00', '25:00:15')
    """
    whole = round(seconds)
    text = f"{whole // 3600:02d}:{whole // 60 % 60:02d}"
    return f"{text}:{whole % 60:02d}" if any(round(tick) % 60 for tick in ticks) else text

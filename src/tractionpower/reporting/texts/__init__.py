"""All texts of reports go through here: English as it is written in the code, other languages by their catalogues.

``tr`` translates a text where it is used, ``mark`` marks one that is declared where no language is known yet, ``recorded``
translates what an earlier run has recorded in English. Catalogues are gettext files, ``pl.po`` for translators and ``pl.mo``
for the program; ``docs/make_texts.py`` keeps them in step with the code.
"""

from __future__ import annotations

import gettext
import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache, lru_cache
from pathlib import Path

from tractionpower.model.report import Language
from tractionpower.reporting.texts.recorded import SENTENCES, TOGETHER

_FOLDER = Path(__file__).parent
_language: ContextVar[Language] = ContextVar("language of reports", default="en")
_PLACE = re.compile(r"\{(\w+)\}")
_NUMBERS = frozenset({
    "air", "all", "allowed", "before", "begin", "count", "current", "end", "in_service", "km", "leakage", "number",
    "percent", "seconds", "share", "sun", "units", "value", "volts", "wind",
})  # fmt: skip
"""Places of recorded sentences that hold a number, a time or a length of time: other text there is of another sentence."""
_NUMBER = r"-?\d[\d.,:e+-]*(?: h| min| s)?"
_BARE = r"[^,;()]+?"  # a name in a list of pairs of trains
_DECIMAL = re.compile(r"(?<![\d.:])(-?\d+)\.(\d+)(?![\d.:])")


@contextmanager
def language(chosen: Language) -> Iterator[None]:
    """Let all texts made inside be in a language."""
    token = _language.set(chosen)
    try:
        yield
    finally:
        _language.reset(token)


def current_language() -> Language:
    """Return the language that texts are made in."""
    return _language.get()


def mark(text: str) -> str:
    """Return a text as it is: it is translated where it is used, by `tr`, and the catalogue has it.

    >>> mark("train")
    'train'
    """
    return text


def tr(text: str, /, **values: object) -> str:
    """Return a text in the language of the report, with `values` in the places that it has for them.

    >>> tr("{count} trains", count=3)
    '3 trains'
    """
    told = _catalogue(_language.get()).gettext(text) if text else ""
    return told.format(**values) if values else told


def trn(one: str, many: str, count: int, /, **values: object) -> str:
    """Return a text for a number of things, which its place ``{count}`` shows.

    >>> trn("{count} train", "{count} trains", 1)
    '1 train'
    """
    return _catalogue(_language.get()).ngettext(one, many, count).format(count=count, **values)


def recorded(text: str) -> str:
    """Return in the language of the report a sentence that a run has recorded in English.

    Sentences with places for names and numbers are found by their pattern; one that no catalogue has stays English.

    >>> recorded("mean over the run")
    'mean over the run'
    """
    chosen = _language.get()
    return text if chosen == "en" or not text else _recorded(text, chosen)


def number(value: float, digits: int = 1, *, bare: bool = True) -> str:
    """Return a number with the decimal sign of the language; with `bare` a fraction of zeros is left out.

    >>> number(2700.0), number(0.25, 2)
    ('2700', '0.25')
    """
    text = f"{value:z.{digits}f}"
    if bare and "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace(".", ",") if _language.get() == "pl" else text


def decimal(text: str) -> str:
    """Return a text with the decimal sign of the language in its numbers.

    >>> decimal("0.95")
    '0.95'
    """
    return _number(text, _language.get())


@cache
def _catalogue(chosen: Language) -> gettext.NullTranslations:
    if chosen == "en":
        return gettext.NullTranslations()
    with (_FOLDER / f"{chosen}.mo").open("rb") as file:
        return gettext.GNUTranslations(file)


@cache
def _patterns() -> list[tuple[str, re.Pattern[str]]]:
    """Return recorded sentences that have places, each as a pattern: the most specific first, those that part a text last."""
    found = []
    whole = {each for each in SENTENCES if "{" in each}.difference(TOGETHER)
    for sentence in (*sorted(whole, key=lambda each: (-len(_PLACE.sub("", each)), each)), *TOGETHER):
        parts = _PLACE.split(sentence)
        held = [_NUMBER if part in _NUMBERS else _BARE if part in ("one", "other", "time", "track") else ".+?" for part in parts]
        pattern = "".join(re.escape(part) if k % 2 == 0 else f"(?P<{part}>{held[k]})" for k, part in enumerate(parts))
        found.append((sentence, re.compile(pattern, re.DOTALL)))
    return found


@lru_cache(maxsize=20_000)
def _recorded(text: str, chosen: Language) -> str:
    catalogue = _catalogue(chosen)
    told = catalogue.gettext(text)
    if told != text:
        return told
    for sentence, pattern in _patterns():
        match = pattern.fullmatch(text)
        if match is None:
            continue
        found = match.groupdict()
        numbers = {*_NUMBERS, "limit"}  # a limit may be a name as well
        parts = {name: _number(part, chosen) if name in numbers else _recorded(part, chosen) for name, part in found.items()}
        if sentence not in TOGETHER or parts != found:  # parts of which none is known are words of the user
            return catalogue.gettext(sentence).format(**parts)
    return text


def _number(text: str, chosen: Language) -> str:
    """Return a recorded number with the decimal sign of a language; times and lengths of time hold as they are."""
    return _DECIMAL.sub(r"\1,\2", text) if chosen == "pl" else text

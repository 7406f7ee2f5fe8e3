"""What people write above the columns of a timetable, in English, Polish, German and Italian."""

from __future__ import annotations

import re
import unicodedata

from tractionpower.io.excel import Cell

HEADINGS: dict[str, tuple[str, ...]] = {
    "train": (
        "train", "train id", "train no", "train number", "trip", "run", "id", "no", "number",
        "pociag", "nr pociagu", "numer pociagu", "numer", "nr",
        "zug", "zugnummer", "zug nr", "zugfahrt", "fahrt", "nummer",
        "treno", "numero treno", "n treno", "treno n", "corsa", "numero",
    ),
    "station": (
        "station", "stop", "place", "timing point", "location", "station name", "stop name", "stations",
        "stacja", "przystanek", "punkt", "posterunek", "nazwa stacji", "stacje",
        "bahnhof", "haltestelle", "betriebsstelle", "halt", "ort", "bahnhofe",
        "stazione", "fermata", "localita", "luogo", "stazioni",
    ),
    "arrival": (
        "arrival", "arr", "arrival time", "przyjazd", "przyj", "p", "ankunft", "an", "ank", "ankunftszeit", "arrivo", "a",
    ),
    "departure": (
        "departure", "dep", "departure time", "odjazd", "odj", "o", "abfahrt", "ab", "abf", "abfahrtszeit", "partenza", "part",
    ),
    "time": ("time", "passing time", "pass", "passing", "czas", "godzina", "przelot", "zeit", "uhrzeit", "durchfahrt",
             "ora", "orario", "transito"),
    "min_dwell_s": (
        "min dwell s", "min dwell", "dwell", "dwell s", "minimum dwell", "stopping time", "stop time",
        "postoj", "postoj s", "minimalny postoj", "czas postoju", "postoj min s",
        "haltezeit", "haltezeit s", "mindesthaltezeit", "mindesthaltezeit s", "aufenthalt",
        "sosta", "sosta s", "sosta minima", "tempo di sosta",
    ),
    "stops": ("stops", "stopping", "kind", "type of call", "zatrzymanie", "postoj tak nie", "halt ja nein",
              "halt oder durchfahrt", "haltart", "ferma", "fermata si no", "tipo fermata"),
    "track": ("track", "tor", "nr toru", "gleis", "streckengleis", "binario"),
    "train_type": (
        "train type", "type", "typ", "formation", "rolling stock", "vehicle", "consist", "stock",
        "tabor", "rodzaj taboru", "zestaw", "pojazd",
        "zugtyp", "fahrzeug", "zugbildung", "baureihe",
        "materiale", "materiale rotabile", "composizione", "tipo treno",
    ),
    "category": ("category", "train category", "kategoria", "rodzaj pociagu", "zuggattung", "gattung", "kategorie", "categoria"),
    "days": ("days", "days of operation", "dni", "dni kursowania", "kursuje", "verkehrstage", "tage", "giorni", "circola"),
    "order": ("order", "sequence", "stop sequence", "seq", "kolejnosc", "lp", "l p", "reihenfolge", "lfd nr", "ordine"),
    "km": ("km", "kilometre", "kilometer", "kilometr", "chilometro", "progressiva", "chainage", "place km", "distance",
           "entfernung", "odleglosc", "distanza", "kilometraz"),
}  # fmt: skip
"""Fields by what they are called; compared without accents, capitals and signs."""

_BY_WORD = {word: name for name, words in HEADINGS.items() for word in words}

PASSES = ("pass", "passes", "passing", "no", "n", "nein", "durchfahrt", "d", "nie", "przelot", "bez zatrzymania", "false", "0",
          "transito", "x passes")  # fmt: skip
STOPS = ("stop", "stops", "yes", "y", "ja", "j", "halt", "h", "tak", "t", "postoj", "ph", "true", "1", "x", "si", "s", "fermata")
_LETTERS = str.maketrans({"ł": "l", "Ł": "l", "ø": "o", "đ": "d", "æ": "ae"})


def plain_words(text: str) -> str:
    """Return a text for comparison: small letters without accents, signs as blanks.

    >>> plain_words("Łódź Widzew (os.)"), plain_words("Müllheim/Baden")
    ('lodz widzew os', 'mullheim baden')
    """
    bare = unicodedata.normalize("NFKD", text.translate(_LETTERS).casefold())
    letters = "".join(letter for letter in bare if not unicodedata.combining(letter))
    return " ".join(re.findall(r"\w+", letters.replace("_", " ")))


def field_of(cell: Cell) -> str | None:
    """Return the field that a heading stands for, or None; a unit in brackets behind it is left out.

    >>> field_of("Nr. pociągu"), field_of("Ankunft"), field_of("min. dwell [s]"), field_of("Roma")
    ('train', 'arrival', 'min_dwell_s', None)
    """
    if not isinstance(cell, str):
        return None
    return _BY_WORD.get(plain_words(re.sub(r"[\[(][^\])]{0,12}[\])]\s*$", "", cell)))


def text_of(cell: Cell) -> str:
    """Return a cell as text; a whole number without its point.

    >>> text_of(1301.0), text_of(None)
    ('1301', '')
    """
    if cell is None:
        return ""
    if isinstance(cell, float) and cell.is_integer() and abs(cell) < 1e15:
        return str(int(cell))
    return str(cell).strip()


def stops_of(cell: Cell) -> bool | None:
    """Return whether a cell says that the train stops; None if it says neither."""
    if isinstance(cell, bool):
        return cell
    words = plain_words(text_of(cell))
    return True if words in STOPS else False if words in PASSES else None

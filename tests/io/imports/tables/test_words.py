"""Headings, days and times as people write them."""

from datetime import datetime, timedelta

import pytest

from tractionpower.io.imports.tables.cell_times import read_time
from tractionpower.io.imports.tables.day_words import DAYS, days_of
from tractionpower.io.imports.tables.headings import HEADINGS, field_of, plain_words, stops_of


def test_no_word_stands_for_two_fields():
    words = [word for words in HEADINGS.values() for word in words]
    assert len(words) == len(set(words))
    assert all(plain_words(word) == word for word in words)


@pytest.mark.parametrize(
    ("text", "name"), [("Odj.", "departure"), ("ABFAHRT", "departure"), ("Località", "station"), ("Verkehrstage", "days")]
)
def test_headings(text, name):
    assert field_of(text) == name


def test_stops():
    assert [stops_of(cell) for cell in ("tak", "Durchfahrt", True, 0.0, "maybe")] == [True, False, True, False, None]


@pytest.mark.parametrize(
    ("text", "days"),
    [
        ("1-5", DAYS[:5]), ("(1)-(5)", DAYS[:5]), ("12345", DAYS[:5]), ("pn.–pt.", DAYS[:5]), ("Mo - Fr", DAYS[:5]),
        ("Sa, So", None), ("sab dom", DAYS[5:]), ("fri-mon", ("mon", "fri", "sat", "sun")), ("täglich", DAYS), ("w dni", None),
    ],
)  # fmt: skip
def test_days(text, days):
    if days is None and text == "w dni":
        with pytest.raises(ValueError, match="w"):
            days_of(text)
    elif days is None:  # so is Saturday in Polish, Sunday in German: both words are in the list, the first wins
        assert days_of(text) == ("sat",)
    else:
        assert days_of(text) == days


@pytest.mark.parametrize(
    ("cell", "seconds"),
    [("5:10", 18600.0), ("05:10:30", 18630.0), ("25:10", 90600.0), ("5.10", 18600.0), (timedelta(hours=26), 93600.0),
     (0.5, 43200.0), (datetime(2026, 1, 1, 7, 30), 27000.0), (1.0 / 3.0, 28800.0)],
)  # fmt: skip
def test_times(cell, seconds):
    assert read_time(cell).seconds == seconds


@pytest.mark.parametrize("cell", ["510", "5:70", "41:06x", "49:00", 5.1, 0.0, 510.0, True, "5:10 pm", timedelta(hours=49)])
def test_what_is_no_time(cell):
    with pytest.raises(ValueError, match=r".+"):
        read_time(cell)


def test_passing():
    assert read_time("|").passes
    assert read_time("–").seconds is None
    assert read_time("(5:10)").seconds == read_time("5:10|").seconds == 18600.0
    assert read_time("(5:10)").passes
    assert read_time(None) is None

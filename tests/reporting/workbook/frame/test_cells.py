import math

import numpy as np
import pytest
from openpyxl import Workbook

from tractionpower.reporting.workbook.frame.cells import LONGEST, Styles, clean, days, plain, put, shorten


@pytest.fixture
def sheet():
    return Workbook().active


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@a", "#N/A", "#REF!", "'x", "=", "<b>", "🚆"])
def test_a_text_stays_a_text_whatever_it_begins_with(sheet, text):
    style = Styles(sheet.parent)["text"]
    cell = put(sheet, 1, 1, text, style)
    assert (cell.data_type, cell.value) == ("s", text)
    assert bool(cell.quotePrefix) == (text[0] in "=+-@'")
    assert not put(sheet, 2, 1, "plain", style).quotePrefix, "the style that all cells share is as before"


def test_what_xml_forbids_is_replaced():
    forbidden = [*range(9), 11, 12, *range(14, 32), 0xD800, 0xDFFF, 0xFFFE, 0xFFFF]
    assert clean("".join(map(chr, forbidden))) == "\ufffd" * len(forbidden)
    assert clean("a\tb\nc\r\nd") == "a\tb\nc\nd"


@pytest.mark.parametrize("sign", [*range(0x202A, 0x202F), *range(0x2066, 0x206A)])
def test_what_turns_texts_round_is_replaced(sign):
    assert clean(f"IC {chr(sign)}1234") == "IC \ufffd1234"
    assert clean("\u0627\u200f-\u0628") == "\u0627\u200f-\u0628", "letters that are read from right to left may stay"


def test_a_text_is_cut_at_what_a_cell_takes():
    assert len(clean("🚆" * 40_000)) == LONGEST
    assert clean("x" * LONGEST) == "x" * LONGEST
    assert shorten("a\n  b", 9) == "a b"


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (None, None),
        (math.nan, None),
        (np.float32(0.5), 0.5),
        (np.int64(3), 3),
        (np.True_, "yes"),
        (False, "no"),
        (math.inf, "infinite"),
    ],
)
def test_numbers_come_as_they_are_and_missing_ones_as_nothing(value, shown):
    assert plain(value) == shown
    assert type(plain(value)) is type(shown)


def test_styles_carry_the_format(sheet):
    styles = Styles(sheet.parent)
    assert put(sheet, 1, 1, 0.25, styles["time"]).number_format == "[hh]:mm:ss"
    assert put(sheet, 1, 2, 0.25, styles["0.0"]).number_format == "0.0"
    assert put(sheet, 1, 3, 0.25, styles["sum 0.00"]).font.b


def test_times_before_midnight_are_texts():
    assert days(-600.0) == "-00:10:00"
    assert days(43_200.0) == 0.5
    assert days(None) is None
    assert np.isnan(days(np.nan))

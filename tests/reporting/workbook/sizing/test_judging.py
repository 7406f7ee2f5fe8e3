"""What judges: sentences as formulas, and words that agree with what was recorded."""

from hypothesis import given
from hypothesis import strategies as st

from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.sizing.judging import judged, rounded, sentence


def test_a_sentence_is_a_formula_with_its_value():
    found = sentence('{bad} of {all} "so-called" limits', bad=("SUM({x})", 2), all=("5", 5))
    assert found == Formula('SUM({x})&" of "&5&" ""so-called"" limits"', '2 of 5 "so-called" limits')


def test_a_word_that_the_numbers_do_not_give_stays_as_recorded():
    assert judged("1", "yes", "yes") == Formula("1", "yes")
    assert judged("1", "yes", "no") == "no"  # single precision has rounded what was beyond the limit


@given(st.integers(-10_000, 10_000))
def test_halves_are_rounded_away_from_zero(tenths):
    expected = (abs(tenths) + 5) // 10 * (1 if tenths >= 0 else -1)
    assert rounded(tenths / 10.0) == expected

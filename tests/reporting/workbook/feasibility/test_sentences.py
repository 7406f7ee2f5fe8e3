"""Sentences that are formulas: texts of any length and with any signs."""

import re

import pytest

from tractionpower.reporting.workbook.feasibility.sentences import LONGEST, live, sentence


def spoken(formula):
    """Return what a formula of joined texts comes to."""
    pieces = re.findall(r'"((?:[^"]|"")*)"', formula)
    assert "&".join(f'"{piece}"' for piece in pieces) == formula
    assert all(len(piece) <= LONGEST * 2 for piece in pieces)
    return "".join(pieces).replace('""', '"')


@pytest.mark.parametrize("text", ['=cmd() "x"', "{late} of {x}", "a" * 700, '"' * 300, "\U0001f686 <b>"])
def test_a_text_is_told_as_it_is(text):
    formula = sentence(text, {})
    assert spoken(formula) == text
    assert not re.search(r"\{\w+\}", formula)  # nothing that would be taken for a place


def test_cells_stand_in_the_places_of_a_sentence():
    formula = live("Infeasible: {late} of {all} trains late or not there", {"late": "{count}"}, all=3)
    assert formula == '"Infeasible: "&{count}&" of 3 trains late or not there"'
    assert sentence("", {}) == '""'

"""Errors as formulas on the values of the book, and values side by side."""

import numpy as np
import pandas as pd
import pytest
from fake_results import make_case

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.measured_values import MOST_ROWS, add_values, formulas_of
from tractionpower.studies.measured.errors import Compared, errors_of


def values_of(times, series=("a", "b")):
    rng = np.random.default_rng(3)
    parts = []
    for name in series:
        measured, computed = 3000.0 + rng.normal(size=(2, len(times)))
        measured[3] = np.nan
        own = {"series": name, "time_s": times, "position_km": np.nan, "measured": measured, "computed": computed}
        parts.append(pd.DataFrame(own | {"error": computed - measured}))
    errors = pd.DataFrame({"series": series, "subject": "train 1", "quantity": "voltage_v", "unit": "V"})
    return pd.concat(parts), errors


@pytest.fixture
def book():
    return Book(Facts(*make_case()), Report())


def test_formulas_come_to_what_the_study_computes(book):
    rows, errors = values_of(np.arange(50.0))
    place = add_values(book, rows, errors)["b"]
    own = rows[rows["series"] == "b"]
    told = errors_of(Compared(*(own[name].to_numpy() for name in ("time_s", "measured", "computed")), 1.0), is_power=False)
    found = formulas_of(place)
    assert place.whole
    for name, formula in found.items():
        if name != "largest_error":
            assert formula.value == pytest.approx(told[name], rel=1e-9), name
    assert found["largest_error"].value == own["error"].abs().max()
    assert found["rows"].value == 49
    assert found["mean_error"].text == "AVERAGE({error_2})"


def test_long_series_are_extracts_and_have_no_formulas_on_all_values(book):
    rows, errors = values_of(np.arange(MOST_ROWS + 1.0))
    place = add_values(book, rows, errors)["a"]
    assert not place.whole
    assert len(place.at) == MOST_ROWS // 2 + 1


def test_a_place_that_is_passed_twice_keeps_both_values(book):
    rows, errors = values_of(np.array([1.0, 2.0, 3.0, 4.0, 2.0, 1.0]), series=("a",))
    rows = rows.assign(position_km=rows["time_s"], time_s=np.nan)
    place = add_values(book, rows, errors)["a"]
    assert place.at.tolist() == [1.0, 2.0, 3.0, 4.0, 1.0, 2.0]
    assert sorted(place.computed) == sorted(rows["computed"])

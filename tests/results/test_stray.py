"""Stray currents against what needs no further study."""

import numpy as np
import pytest

from tractionpower.io.limits_files import shipped_limits
from tractionpower.results.stray import Leakage, stray_rows, stray_verdicts

PLACES = ["a", "b", "c"]


def leakage(s_per_km, mean_v, positive_v=None, tracks=(1, 1, 1), seconds=86400.0):
    mean = np.array(mean_v, float)
    positive = np.maximum(mean, 0.0) if positive_v is None else np.array(positive_v, float)
    return Leakage(np.array(tracks), np.array(s_per_km) / 1000.0, mean, positive, seconds)


def rows_of(found):
    return {row["limit"]: row for row in stray_rows(found, PLACES, shipped_limits(), "dc3000")}


def test_the_product_of_conductance_and_shift_is_the_stray_current():
    # 5 V at 0.5 S/km are 2.5 mA/m: both criteria are met just so
    rows = rows_of(leakage([0.5, 0.2, 0.5], [5.0, 1.0, -40.0]))
    assert rows["stray_current"]["value"] == pytest.approx(2.5)
    assert (rows["stray_current"]["place"], rows["stray_current"]["met"]) == ("a", True)
    assert (rows["stray_shift_open"]["value"], rows["stray_shift_open"]["met"]) == (5.0, True)
    assert set(rows) == {"stray_current", "stray_shift_open"}


def test_the_conductance_chooses_the_criterion():
    rows = rows_of(leakage([0.4, 2.0, 3.0], [6.0, 0.9, 0.1]))
    assert (rows["stray_shift_open"]["place"], rows["stray_shift_open"]["met"]) == ("a", False)
    assert (rows["stray_shift_closed"]["place"], rows["stray_shift_closed"]["met"]) == ("b", True)
    assert (rows["stray_leakage_closed"]["value"], rows["stray_leakage_closed"]["met"]) == (pytest.approx(3.0), False)


def test_what_leaks_from_two_tracks_is_shared_out():
    one, two = (rows_of(leakage([1.0, 0.0, 0.0], [4.0, 9.0, 9.0], tracks=(n, 1, 1))) for n in (1, 2))
    assert one["stray_current"]["value"] == pytest.approx(4.0)
    assert two["stray_current"]["value"] == pytest.approx(2.0)
    assert "stray_shift_closed" in one
    assert two["stray_shift_open"]["place"] == "a"


def test_a_part_of_a_day_is_not_judged():
    found = stray_rows(leakage([0.5, 0.5, 0.5], [9.0, 0.0, 0.0], seconds=3600.0), PLACES, shipped_limits(), "dc3000")
    assert {row["met"] for row in found} == {None}
    assert stray_verdicts(found) == []
    whole = stray_rows(leakage([0.5, 0.5, 0.5], [9.0, 0.0, 0.0]), PLACES, shipped_limits(), "dc3000")
    assert [row["met"] for row in stray_verdicts(whole)] == [False, False]


def test_places_without_leakage_do_not_count():
    assert rows_of(leakage([0.0, 0.0, 0.0], [50.0, 0.0, 0.0])) == {}

"""Use of ratings against profiles worked by hand."""

import math

import numpy as np
import pytest

from tractionpower.results.device_loads import DeviceLoads
from tractionpower.results.windows import WINDOWS_S
from tractionpower.studies.ratings.rated import rating_rows
from tractionpower.studies.ratings.use import MOST_PERCENT, ruling, uses
from tractionpower.supply.devices import Device
from tractionpower.supply.ratings import Rating

VI = ((0.0, 1.0), (7200.0, 1.5), (60.0, 3.0))
IX = ((0.0, 1.0), (7200.0, 1.5), (300.0, 3.0))
UNIT = Device("unit", "A unit", "A", "", 0.0, 0.0)
NONE = Rating("x", math.nan, "", (), math.nan, "", "no rating given")


def rating(windows, rated_a=1000.0):
    return Rating("A unit", rated_a, "class", windows, math.nan, "recalled", "table")


def loads_of(*parts, windows_s=WINDOWS_S):
    """Return loads of a profile of (current [A], time [s])."""
    amps = np.repeat([float(part[0]) for part in parts], [part[1] for part in parts])[:, np.newaxis]
    found = DeviceLoads(1, 1.0, windows_s)
    found.add(np.arange(float(len(amps))), amps)
    return found


def used(windows, *parts, rated_a=1000.0, allowed=100.0):
    return {use.window_s: use for use in uses([UNIT], [rating(windows, rated_a)], loads_of(*parts), 0.0, allowed)}


def test_class_vi_by_hand():
    """4 h at 800 A, in them 2 h at 1200 A with 60 s of 2700 A at their start."""
    found = used(VI, (800, 3600), (2700, 60), (1200, 7140), (800, 3600))
    run = math.sqrt((7200 * 800**2 + 60 * 2700**2 + 7140 * 1200**2) / 14400)
    hours = math.sqrt((60 * 2700**2 + 7140 * 1200**2) / 7200)
    assert found[0.0].load_a == pytest.approx(run)
    assert found[0.0].utilisation_percent == pytest.approx(run / 10.0)
    assert (found[7200.0].load_a, found[7200.0].permitted_a) == (pytest.approx(hours), 1500.0)
    assert (found[7200.0].from_s, found[60.0].from_s) == (3600.0, 3600.0)
    assert found[60.0].utilisation_percent == pytest.approx(90.0)
    assert {window: use.met for window, use in found.items()} == {0.0: "no", 7200.0: "yes", 60.0: "yes"}
    assert [window for window, use in found.items() if use.ruling] == [0.0]
    assert found[60.0].left_a == pytest.approx(300.0)
    assert found[0.0].left_a == pytest.approx(1000.0 - run)


def test_class_ix_by_hand():
    """Five minutes at 2.9 times the rated current rule where all else is light."""
    found = used(IX, (500, 7200), (2900, 300), (500, 6900))
    assert found[300.0].utilisation_percent == pytest.approx(2900.0 / 30.0)
    assert found[300.0].ruling
    assert found[7200.0].load_a == pytest.approx(math.sqrt((300 * 2900**2 + 6900 * 500**2) / 7200))
    assert found[0.0].load_a == pytest.approx(math.sqrt((300 * 2900**2 + 14100 * 500**2) / 14400))
    assert {use.met for use in found.values()} == {"yes"}
    assert used(IX, (500, 7200), (3100, 300), (500, 6900))[300.0].met == "no"


def test_the_limit_itself_is_met_and_a_margin_can_be_asked_for():
    assert used(((0.0, 1.0),), (1000, 100))[0.0].met == "yes"
    assert used(((0.0, 1.0),), (1000, 100), allowed=99.0)[0.0].met == "no"


def test_a_run_shorter_than_the_window_is_held_against_all_of_it():
    found = used(VI, (1200, 1000), (600, 1000))
    whole = math.sqrt((1200**2 + 600**2) / 2)
    assert found[7200.0].load_a == pytest.approx(whole)
    assert found[0.0].load_a == pytest.approx(whole)
    assert found[60.0].load_a == pytest.approx(1200.0)


def test_without_a_rating_the_load_is_told_and_nothing_is_judged():
    (use,) = uses([UNIT], [NONE], loads_of((700, 100)), 5.0)
    assert (use.window_s, use.met, use.ruling, use.from_s) == (0.0, "", True, 5.0)
    assert use.load_a == pytest.approx(700.0)
    assert math.isnan(use.permitted_a)
    assert math.isnan(use.utilisation_percent)


def test_of_a_section_each_window_takes_the_greater_end():
    section = Device("contact_line", "track 1 km 0-10", "", "1", 0.0, 10.0)
    loads = DeviceLoads(3, 1.0)
    amps = np.full((1000, 3), 100.0)
    amps[:60, 1], amps[500:, 2] = 900.0, 400.0
    loads.add(np.arange(1000.0), amps)
    found = uses([UNIT, section], [NONE, rating(((0.0, 1.0), (60.0, 1.0)))], loads, 0.0)
    by_window = {use.window_s: use for use in found if use.device is section}
    assert (by_window[60.0].load_a, by_window[60.0].from_s) == (pytest.approx(900.0), 0.0)
    assert by_window[0.0].load_a == pytest.approx(math.sqrt((100**2 + 400**2) / 2))
    assert [use.window_s for use in ruling(found)] == [0.0, 60.0]


def test_a_device_that_may_carry_nothing():
    """The utilisation of any current is beyond all limits, yet a number; without current nothing is violated."""
    found = used(((0.0, 1.0), (60.0, 1.0)), (10, 100), rated_a=0.0)
    assert {(use.permitted_a, use.utilisation_percent, use.met) for use in found.values()} == {(0.0, MOST_PERCENT, "no")}
    assert found[0.0].left_a == pytest.approx(-10.0)
    assert [(use.utilisation_percent, use.met) for use in used(((0.0, 1.0),), (0, 100), rated_a=0.0).values()] == [(0.0, "yes")]


def test_a_window_that_nobody_looked_at_is_an_error_of_the_program():
    with pytest.raises(LookupError, match="77"):
        used(((77.0, 1.0),), (1, 100))


def test_rows_tell_all_windows_that_the_run_fills():
    loads = loads_of((1000, 300), (3000, 60), (500, 540))
    found = uses([UNIT], [rating(VI)], loads, 0.0)
    rows = {row["window_s"]: row for row in rating_rows(found, loads, 0.0)}
    assert sorted(rows) == [0.0, 10.0, 15.0, 60.0, 300.0, 900.0, 7200.0]
    assert rows[900.0]["load_a"] == pytest.approx(1040.833, abs=1e-3)
    assert rows[900.0]["mean_a"] == pytest.approx(833.333, abs=1e-3)
    assert (rows[900.0]["met"], rows[900.0]["ruling"]) == ("", False)
    assert (rows[7200.0]["permitted_a"], rows[7200.0]["met"]) == (1500.0, "yes")
    assert math.isnan(rows[7200.0]["mean_a"])  # the run does not fill it
    assert [row["ruling"] for row in rows.values()].count(True) == 1
    assert {row["rated_current_a"] for row in rows.values()} == {1000.0}

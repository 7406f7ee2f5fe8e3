"""Cases against limits: what is violated, by how much it may be missed, and which case is the worst."""

import math

import pytest
from small_studies import make_scenario

from tractionpower.results.columns import TABLES
from tractionpower.studies.cases.judgement import checks_of, failures, verdicts
from tractionpower.supply.ratings import Rating

GOOD = dict.fromkeys((column.name for column in TABLES["cases"]), None) | {
    "case": "good", "lowest_voltage_v": 2900.0, "lowest_voltage_track": "1", "lowest_voltage_km": 3.0, "lowest_voltage_s": 60.0,
    "highest_voltage_v": 3600.0, "useful_zone_v": 2950.0, "useful_zone": "A–B", "useful_train_v": 2900.0, "useful_train": "x",
    "utilisation_percent": 99.0, "utilisation_device": "A unit", "worst_late_s": 0.0, "worst_late_train": "", "stuck_trains": 0,
}  # fmt: skip
CHECKS = checks_of(make_scenario())


@pytest.mark.parametrize(
    ("figure", "kept", "missed", "word"),
    [
        ("lowest_voltage_v", 1999.91, 1999.89, "low voltage"),
        ("highest_voltage_v", 3900.09, 3900.11, "high voltage"),
        ("useful_zone_v", 2699.91, 2699.89, "useful voltage"),
        ("useful_train_v", 2699.91, 2699.89, "useful voltage"),
        ("utilisation_percent", 100.0, 100.01, "overload"),
        ("worst_late_s", 1.0, 1.01, "late trains"),
        ("useful_zone_time_mean_v", 2699.91, 2699.89, "useful voltage"),
        ("useful_train_time_mean_v", 2699.91, 2699.89, "useful voltage"),
        ("above_u_max1_s", 300.0, 300.01, "high voltage"),
        ("contract_share_percent", 100.0, 100.01, "contract"),
        ("breaker_share_percent", 100.0, 100.01, "breaker"),
        ("trips", 0, 1, "tripped breakers"),
        ("stuck_trains", 0, 1, "stuck trains"),
        ("dark_trains", 0, 1, "trains without voltage"),
        ("unfinished_trains", 0, 1, "unfinished trains"),
        ("unserved_loads", 0, 1, "loads without voltage"),
        ("blackout_s", 0.0, 0.5, "nothing fed"),
    ],
)
def test_each_limit(figure, kept, missed, word):
    assert failures(CHECKS, GOOD | {figure: kept}) == ()
    assert failures(CHECKS, GOOD | {figure: missed}) == (word,)
    assert failures(CHECKS, GOOD | {figure: None}) == failures(CHECKS, GOOD | {figure: math.nan}) == ()


def test_the_verdict_is_on_the_worst_case():
    rows = [GOOD, GOOD | {"case": "low", "lowest_voltage_v": 1800.0}, GOOD | {"case": "late", "worst_late_s": 90.0}]
    found = {verdict["name"]: verdict for verdict in verdicts(CHECKS, rows)}
    low = found["lowest voltage"]
    assert (low["value"], low["met"], low["place"], low["time"]) == (1800.0, False, "low: track 1, km 3.00", "00:01:00")
    assert (low["limit"], low["limit_value"], low["status"]) == ("u_min2", 2000.0, "secondary")
    assert (found["lateness at calls"]["place"], found["lateness at calls"]["met"]) == ("late", False)
    assert found["utilisation of devices"]["met"]


def test_the_status_of_a_rating_is_told():
    rating = Rating("A unit", 1000.0, "VI", ((0.0, 1.0),), float("nan"), "recalled", "a book")
    told = next(each for each in verdicts(CHECKS, [GOOD], {"A unit": rating}) if each["unit"] == "%")
    assert (told["status"], told["source"], told["place"]) == ("recalled", "a book", "good: A unit")


def test_a_figure_that_no_case_has_gets_no_verdict():
    bare = GOOD | {"useful_zone_v": None, "utilisation_percent": None}
    names = {verdict["name"] for verdict in verdicts(CHECKS, [bare])}
    assert "utilisation of devices" not in names
    assert "mean useful voltage of zones, current-weighted" not in names
    assert "mean useful voltage of trains, current-weighted" in names

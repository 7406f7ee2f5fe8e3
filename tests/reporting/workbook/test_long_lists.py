"""A list within a row is told in a cell, a long one by its ends."""

from tractionpower.model.loads import Load
from tractionpower.reporting.workbook.common.declared import MOST_IN_CELL, in_words


def profile(count):
    rows = [{"time": 60.0 * k, "power_kw": 10.0 * k} for k in range(count)]
    return Load.model_validate({"id": "x", "track": "1", "km": 1.0, "profile": rows}).profile


def test_a_short_profile_is_told_row_by_row():
    assert in_words(profile(2)) == "time 00:00:00, power 0 kW; time 00:01:00, power 10 kW"


def test_a_long_profile_is_told_by_its_ends():
    count = MOST_IN_CELL + 1
    last = f"time 00:{count - 1:02d}:00, power {10 * (count - 1)} kW"
    assert in_words(profile(count)) == f"{count} rows, from time 00:00:00, power 0 kW to {last}"

"""Which trips run on a day: calendars with and without exceptions, in either file, the day that is chosen."""

import pytest
from small_feeds import codes, read, tables, trains

from tractionpower.errors import UsageError

ONLY_DATES = [
    {"service_id": "S", "date": "20230610", "exception_type": "1"},
    {"service_id": "D", "date": "20230609", "exception_type": "1"},
]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"date": "20230607"}, {"T1", "T2"}),
        ({"date": "2023-06-10"}, {"S1"}),
        ({"day": "sat"}, {"S1"}),
        ({"day": "Monday"}, {"T1", "T2"}),
        ({}, {"T1", "T2"}),
    ],
)
def test_days(tmp_path, options, expected):
    assert set(trains(read(tmp_path, options))) == expected


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"date": "20230608"}, "no_trips"),  # a Thursday taken out by calendar_dates.txt
        ({"date": "20230611"}, "no_trips"),  # a Sunday
        ({"date": "20240607"}, "no_trips"),  # outside
        ({"day": "sun"}, "no_trips"),
    ],
)
def test_days_without_trips_and_bad_ones(tmp_path, options, code):
    found = read(tmp_path, options)
    assert codes(found) == [code]
    assert found.texts == {}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"date": "7 June"}, "--date 7 June: give YYYYMMDD or YYYY-MM-DD"),
        ({"date": "2023-06-31"}, "--date 2023-06-31: there is no such day"),
        ({"date": "20230229"}, "there is no such day"),
        ({"date": "20230607", "day": "thu"}, "2023-06-07 is a wednesday"),
        ({"day": "noday"}, "--day noday"),
        ({"date": "20230607", "day": "noday"}, "--day noday"),
    ],
)
def test_days_that_are_none_are_wrong_usage(tmp_path, options, words):
    with pytest.raises(UsageError, match=words):
        read(tmp_path, options)


def test_an_exception_adds_a_service(tmp_path):
    dates = [
        {"service_id": "S", "date": "20230607", "exception_type": "1"},
        {"service_id": "D", "date": "20230607", "exception_type": "2"},
    ]
    assert set(trains(read(tmp_path, {"date": "20230607"}, calendar_dates=dates))) == {"S1"}


def test_without_calendar_dates(tmp_path):
    found = read(tmp_path, {"date": "20230608"}, calendar_dates=None)
    assert set(trains(found)) == {"T1", "T2"}
    assert any("no calendar_dates.txt" in row for row in found.notes.read)


def test_without_calendar(tmp_path):
    found = read(tmp_path, calendar=None, calendar_dates=ONLY_DATES)
    assert set(trains(found)) == {"T1", "T2"}  # no Wednesday: the day with most trips
    assert any("2023-06-09, a Friday" in row for row in found.notes.assumed)
    assert set(trains(read(tmp_path, {"date": "20230610"}, calendar=None, calendar_dates=ONLY_DATES))) == {"S1"}


def test_with_neither(tmp_path):
    assert codes(read(tmp_path, calendar=None, calendar_dates=None)) == ["no_calendar"]
    mended = read(tmp_path, {"repair": True}, calendar=None, calendar_dates=None)
    assert set(trains(mended)) == {"T1", "T2", "S1"}
    assert mended.notes.repaired


def test_bad_rows_of_calendars(tmp_path):
    bad = [row | {"start_date": "June"} for row in tables()["calendar"]]
    found = read(tmp_path, {"date": "20230607"}, calendar=bad)
    assert codes(found)[0] == "bad_calendar"
    assert "2 rows" in found.notes.problems[0].found

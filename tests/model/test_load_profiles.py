"""What a profile of a load may be."""

import pytest
from pydantic import ValidationError

from tractionpower.model.loads import Load


def load(*rows, **more):
    return Load.model_validate({"id": "x", "track": "1", "km": 4.0, "profile": list(rows)} | more)


def row(time, **value):
    return {"time": time} | value


def test_rows_of_power_or_of_current():
    taken = load(row("05:30", power_kw=400.0), row("25:00:00.5", power_kw=0.0)).profile
    assert [(point.time, point.value) for point in taken] == [(19800.0, 400.0), (90000.5, 0.0)]
    assert load(row("00:00", current_a=-50.0)).profile[0].value == -50.0


@pytest.mark.parametrize(
    ("rows", "more", "words"),
    [
        (
            [row("06:00", power_kw=1.0), row("06:00", power_kw=2.0)],
            {},
            "profile rise: 06:00:00 stands behind 06:00:00",
        ),
        ([row("07:00", power_kw=1.0), row("06:30", power_kw=2.0)], {}, "06:30:00 stands behind 07:00:00"),
        ([row("06:00", power_kw=1.0), row("07:00", current_a=2.0)], {}, "either power_kw or current_a in all of its rows"),
        ([row("06:00", power_kw=1.0), row("07:00", power_kw=-2.0)], {}, "describe what takes and what feeds back as two loads"),
        ([row("06:00", power_kw=1.0, current_a=1.0)], {}, "either power_kw or current_a"),
        ([row("06:00")], {}, "either power_kw or current_a"),
        ([row("06:00", power_kw=1.0)], {"power_kw": 2.0}, "one of power_kw, current_a, profile"),
        ([], {}, "at least 1 item"),
    ],
)
def test_rows_that_are_refused(rows, more, words):
    with pytest.raises(ValidationError, match=words):
        load(*rows, **more)

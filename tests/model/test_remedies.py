import pytest
from pydantic import ValidationError

from tractionpower.model.remedies import KINDS, RemedySearch


def test_all_kinds_are_allowed_by_default():
    assert RemedySearch().kinds == KINDS


@pytest.mark.parametrize(
    "change",
    [
        {"shift_step_s": 200.0},
        {"reserve_step_s": 301.0},
        {"driving_step_percent": 21.0},
        {"greatest_headway_factor": 0.9},
        {"kinds": []},
        {"kinds": ["faith"]},
        {"lowest_cap_percent": 0.0},
        {"most_runs": 0},
        {"costs": {"reserve": -1.0}},
    ],
)
def test_bounds_that_make_no_search_are_refused(change):
    with pytest.raises(ValidationError):
        RemedySearch.model_validate(change)

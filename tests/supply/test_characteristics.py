"""A profile is the characteristic of its greatest value times a factor."""

import numpy as np
import pytest
from small_supplies import LIMITS

from tractionpower.model.limits import system_voltages
from tractionpower.model.loads import Load
from tractionpower.supply.characteristics import load_segments, load_steps

VOLTAGES = system_voltages(LIMITS, "dc3000")
AT = np.linspace(10.0, 4200.0, 977)


def current(segments, u):
    """Return I(U) by the definition, segment by segment."""
    starts = np.array([segment[0] for segment in segments])
    a, b, c = np.array(segments).T[1:, np.searchsorted(starts, u, side="right") - 1]
    return a + b * u + c / u


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("kind", ["power_kw", "current_a"])
@pytest.mark.parametrize("more", [{}, {"limits": "none"}, {"fold_back_from_v": 3900.0}])
def test_each_row_is_the_load_of_its_value(sign, kind, more):
    values = [150.0, 0.0, 900.0, 312.5]
    profile = [{"time": 60.0 * k, kind: sign * value} for k, value in enumerate(values)]
    place = {"id": "x", "track": "1", "km": 4.0}
    segments = load_segments(Load.model_validate(place | {"profile": profile} | more), VOLTAGES)
    steps = load_steps(Load.model_validate(place | {"profile": profile} | more))
    assert [time for time, _ in steps] == [0.0, 60.0, 120.0, 180.0]
    for (_, factor), value in zip(steps, values, strict=True):
        alone = load_segments(Load.model_validate(place | {kind: sign * value} | more), VOLTAGES)
        np.testing.assert_allclose(factor * current(segments, AT), current(alone, AT), rtol=1e-12, atol=1e-9)


def test_a_load_without_profile_is_always_itself():
    assert load_steps(Load(id="x", track="1", km=4.0, power_kw=-3.0)) == [(float("-inf"), 1.0)]


def test_a_profile_of_zeros_takes_nothing():
    load = Load.model_validate({"id": "x", "track": "1", "km": 4.0, "profile": [{"time": "06:00", "power_kw": 0.0}]})
    assert not current(load_segments(load, VOLTAGES), AT).any()

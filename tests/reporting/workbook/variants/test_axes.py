"""Axes that fit their values in round steps."""

import pytest
from openpyxl.chart import ScatterChart

from tractionpower.reporting.workbook.variants.axes import fit_axis


@pytest.mark.parametrize(
    ("values", "ends"),
    [([2362.0, 2788.0], (2300.0, 2800.0)), ([3.0, 9.0], (0.0, 10.0)), ([5.0], (4.75, 5.25)), ([-2.0, 8.0], (-2.0, 8.0))],
)
def test_an_axis_spans_its_values(values, ends):
    axis = ScatterChart().y_axis
    fit_axis(axis, [*values, float("nan")])
    low, high = axis.scaling.min, axis.scaling.max
    assert low <= min(values) <= max(values) <= high
    assert (high - low) / axis.majorUnit == pytest.approx(round((high - low) / axis.majorUnit))
    assert 2 <= (high - low) / axis.majorUnit <= 9
    assert low == 0.0 if ends[0] == 0.0 else low > 0.0 or min(values) < 0.0


def test_an_axis_without_values_stays_as_it_is():
    axis = ScatterChart().y_axis
    fit_axis(axis, [float("nan")])
    assert axis.scaling.min is None


def test_bars_begin_at_zero():
    axis = ScatterChart().y_axis
    fit_axis(axis, [4000.0, 5200.0], from_zero=True)
    assert axis.scaling.min == 0.0
    assert axis.scaling.max >= 5200.0

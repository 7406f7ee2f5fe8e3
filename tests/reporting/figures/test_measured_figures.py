"""Figures of a comparison with a measurement: both lines, the error, gaps that stay open, places instead of times."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from tractionpower.reporting.figures.measured_figures import MOST_POINTS, overlay, shift_figure


def rows(count, *, places=False, gap=slice(0, 0)):
    at = np.arange(float(count))
    computed = 3300.0 + 100.0 * np.sin(at / 50.0)
    measured = computed + 10.0
    measured[gap] = np.nan
    nowhere = np.full(count, np.nan)
    axes = {"time_s": nowhere if places else at, "position_km": at if places else nowhere}
    return pd.DataFrame({**axes, "measured": measured, "computed": computed, "error": computed - measured})


FIGURES = SimpleNamespace(
    series="train $2$ voltage_v", subject="train $2$",
    quantity="voltage_v", unit="V", mean_error=-10.0, rms_error=10.0, relative_percent=0.3,
    correlation=1.0, lowest_measured=3210.0, lowest_computed=3200.0, highest_measured=3410.0, highest_computed=3400.0,
    energy_measured_kwh=np.nan, energy_error_percent=np.nan, rows=100, share_percent=90.0,
)  # fmt: skip


def test_both_lines_the_error_and_the_scatter():
    figure = overlay(rows(600), FIGURES, "Recorder")
    above, below, scatter, words = figure.axes
    assert [line.get_label() for line in above.lines] == ["measured", "computed"]
    np.testing.assert_allclose(above.lines[0].get_ydata() - above.lines[1].get_ydata(), 10.0)
    np.testing.assert_allclose(below.lines[-1].get_ydata(), -10.0)
    assert below.get_xlabel().startswith("time of day")
    assert above.get_ylabel() == "voltage [V]"
    assert len(scatter.lines[1].get_xdata()) == 600
    assert "mean error -10 V" in words.texts[0].get_text()
    assert "kWh" not in words.texts[0].get_text()


@pytest.mark.parametrize("count", [600, 40_000])
def test_no_line_is_drawn_across_a_gap(count):
    gap = slice(count // 3, count // 3 + 5)
    line = overlay(rows(count, gap=gap), FIGURES, "x").axes[0].lines[0]
    x, y = line.get_xdata(), line.get_ydata()
    inside = (x >= gap.start) & (x < gap.stop)
    assert inside.any()
    assert np.isnan(y[inside]).all()
    assert np.isfinite(y[~inside]).all()
    assert len(x) <= MOST_POINTS + 10


def test_places_have_kilometres():
    assert overlay(rows(100, places=True), FIGURES, "x").axes[1].get_xlabel() == "place [km]"


def test_the_search_of_the_shift():
    shifts = np.arange(-60.0, 61.0)
    search = pd.DataFrame({"shift_s": shifts, "correlation": 1.0 - (shifts / 100.0) ** 2})
    axes = shift_figure(search, {"shift_s": 3.25, "correlation": 0.98}, "x").axes[0]
    assert axes.texts[0].get_text() == "+3.25 s, correlation 0.980"
    assert not shift_figure(search, {"shift_s": 0.0, "correlation": None}, "x").axes[0].texts

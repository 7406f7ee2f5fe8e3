"""One train with full coupling against the same at a constant voltage."""

import pytest
from fake_runs import constant_run, small_run

from tractionpower.errors import UsageError
from tractionpower.reporting.figures.trains.coupling_figure import compare_coupling


def test_both_runs_stand_in_every_panel():
    full, constant = small_run(), constant_run()
    figure = compare_coupling(full.results, constant, full.scenario, "2")
    assert [axes.get_ylabel().replace("\n", " ") for axes in figure.axes] == [
        "speed [km/h]", "voltage at the pantograph [V]", "current at the pantograph [A]"
    ]  # fmt: skip
    rows = full.results.table("trains").query("train == '2'").iloc[:-1]  # it leaves in the last
    for axes, column in zip(figure.axes, ("speed_kmh", "voltage_v", "current_a"), strict=True):
        fixed, coupled = axes.lines[:2]
        assert coupled.get_ydata() == pytest.approx(rows[column].to_numpy())
        assert fixed.get_xdata()[0] == coupled.get_xdata()[0] + 20.0
        assert fixed.get_linestyle() != coupled.get_linestyle()
    assert fixed.get_label() == "currents computed at 3000 V"
    volts = rows["voltage_v"].min()
    assert f"lowest voltage {volts:.0f} V instead of {volts - 100.0:.0f} V" in figure._suptitle.get_text()
    assert "full coupling against a constant voltage" in figure._suptitle.get_text()


def test_an_unknown_train_is_told():
    full, constant = small_run(), constant_run()
    with pytest.raises(UsageError, match="no rows of train 'x'"):
        compare_coupling(full.results, constant, full.scenario, "x")

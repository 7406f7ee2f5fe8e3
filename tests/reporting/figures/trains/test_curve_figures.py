"""Curves of a train as figure and table."""

import numpy as np
import pandas as pd
import pytest
from fake_journeys import make_curves
from fake_runs import small_run

from tractionpower.model.report import ReportFigures
from tractionpower.movement.curves import drive_curves
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.drawing import drawing
from tractionpower.reporting.figures.trains.curve_figures import (
    balancing_speed,
    curves_figure,
    curves_table,
    has_drive,
    resistance_figure,
    run_curves,
    starting_gradient,
    write_curves_csv,
)


def test_the_figure_has_all_curves_with_units(no_overlap):
    figure = curves_figure(make_curves(), "Loco")
    upper, lower = figure.axes
    assert upper.get_ylabel() == "effort at the wheel [kN]"
    assert "[A]" in lower.get_ylabel()
    assert lower.get_xlabel() == "speed [km/h]"
    labels = [text.get_text().replace("\n", " ") for text in upper.get_legend().get_texts()]
    assert labels[:6] == [f"effort at {volts} V" for volts in (2000, 2400, 2700, 3000, 3300, 3600)]
    assert {"adhesion limit", "electric brake", "resistance on level and gradients"} <= set(labels)
    assert [text.get_text() for text in upper.texts] == ["level", "5 ‰", "10 ‰", "20 ‰"]
    no_overlap(figure, upper.texts)
    effort = upper.lines[3]
    assert effort.get_ydata().max() == pytest.approx(200.0)
    assert effort.get_xdata()[-1] == pytest.approx(160.0)
    assert len({(tuple(each.get_color()), str(each._dash_pattern)) for each in upper.lines[:6]}) == 6


def test_names_of_gradients_stand_apart_where_their_lines_do_not(no_overlap):
    curves = make_curves()
    curves.resistance_n.update({permille: 5e3 + 100.0 * permille + 0.0 * curves.speed_mps for permille in curves.resistance_n})
    figure = curves_figure(curves, "Light engine")
    no_overlap(figure, figure.axes[0].texts)


def test_adhesion_without_a_limit_and_no_electric_brake():
    curves = make_curves()
    curves.adhesion_n[:], curves.electric_brake_n[:] = np.inf, 0.0
    labels = [text.get_text() for text in curves_figure(curves, "").axes[0].get_legend().get_texts()]
    assert not {"adhesion limit", "electric brake"} & set(labels)
    assert curves_table(curves)["adhesion_kn"].isna().all()


def test_a_train_without_effort_is_drawn():
    figure = curves_figure(make_curves([2000.0]), "no effort at all")
    figure.canvas.draw()
    assert all(np.isfinite(limit) for axes in figure.axes for limit in (*axes.get_xlim(), *axes.get_ylim()))


def test_the_table_on_disk(tmp_path):
    curves = make_curves([2700.0, 3000.0])
    table = pd.read_csv(write_curves_csv(curves, tmp_path / "new" / "loco.csv"))
    assert list(table)[:4] == ["speed_kmh", "voltage_v", "effort_kn", "current_a"]
    assert list(table)[-4:] == ["resistance_kn", *(f"resistance_at_{p}_permille_kn" for p in (5, 10, 20))]
    assert len(table) == 2 * len(curves.speed_mps)
    row = table[(table["voltage_v"] == 3000.0) & np.isclose(table["speed_kmh"], 80.0)].iloc[0]
    assert row["effort_kn"] == pytest.approx(4000.0 / (80.0 / 3.6), rel=1e-5)
    assert row["current_a"] == pytest.approx((4e6 / 0.85 + 1e5) / 3000.0, rel=1e-5)
    assert row["resistance_at_10_permille_kn"] - row["resistance_kn"] == pytest.approx(484 * 9.81 / 100, rel=1e-4)
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["loco.csv"]


def test_the_balancing_speed_is_where_effort_meets_resistance():
    curves = make_curves([2100.0])  # 400 kW against 7 kN + 9 N/(m/s)2 v2
    v = balancing_speed(curves)
    assert v == pytest.approx(np.roots([9.0, 0.0, 7e3, -400e3])[-1].real, rel=1e-3)
    assert balancing_speed(make_curves([3000.0])) is None
    assert balancing_speed(make_curves([2000.0])) == 0.0


def test_without_a_drive_there_is_the_resistance_only(no_overlap):
    curves = make_curves([3000.0])
    assert has_drive(curves)
    curves.curves[0].effort_n[:] = 0.0
    assert not has_drive(curves)
    figure = resistance_figure(curves, "Coach")
    (axes,) = figure.axes
    assert figure._suptitle.get_text() == "Coach, no drive"
    assert [text.get_text().replace("\n", " ") for text in axes.get_legend().get_texts()] == ["resistance on level and gradients"]
    top = max(curves.resistance_n[20.0]) / 1000.0
    assert top < axes.get_ylim()[1] < 1.2 * top
    no_overlap(figure, axes.texts)


def test_the_steepest_gradient_of_a_start():
    assert starting_gradient(make_curves([3000.0])) == pytest.approx(1000.0 * (200e3 - 7e3) / (484e3 * 9.80665))
    assert starting_gradient(make_curves([2000.0])) < 0.0


def test_each_kind_of_train_of_a_run_with_a_drive_has_curves():
    run = small_run()
    data = RunData(run.results, run.scenario)
    drawn = dict(run_curves(data))
    assert set(drawn) == {"curves_ed250", "curves_ep09-10-coaches"}
    upper = drawn["curves_ed250"].axes[0]
    train = next(train for train in run.scenario.trains if train.id == "ed250")
    curves = drive_curves(train, run.scenario.vehicles, run.scenario.limits)
    for curve in curves.curves:
        line = next(line for line in upper.lines if line.get_label() == f"effort at {curve.voltage_v:g} V")
        np.testing.assert_allclose(line.get_ydata(), curve.effort_n / 1000.0)
    with drawing(ReportFigures(names=("curves_ed250",))):
        assert [name for name, _ in run_curves(data)] == ["curves_ed250"]

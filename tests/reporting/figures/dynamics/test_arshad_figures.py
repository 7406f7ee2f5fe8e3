"""The six plots of Arshad et al., section 7.3: each shows the columns that it stands for, in the units of the paper."""

import numpy as np
import pytest
from fake_dynamics import fake_results, fake_scenario
from matplotlib.text import Text

from tractionpower.io.arshad.reading import PAPER
from tractionpower.model.report import ReportFigures
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.figures.base.drawing import drawing
from tractionpower.reporting.figures.base.style import new_figure
from tractionpower.reporting.figures.dynamics import arshad_figures
from tractionpower.reporting.figures.dynamics.of_chain import SINGLE, write_chain_figures

MPH, LBF, PSI, INCH, MPHPS = 1.609344, 0.0044482216152605, 0.06894757293168, 25.4, 0.44704
CASE = {"source": f"{PAPER}. Nothing is assumed.", "units": "imperial"}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("chain"), **CASE)


@pytest.fixture(scope="module")
def data(results):
    return ChainData(results, fake_scenario(**CASE))


def lines_of(figure, axes=0):
    """Return the points of the labelled lines of axes: those of vehicles, not those of nothing."""
    return {line.get_label(): np.column_stack(line.get_data()) for line in figure.axes[axes].lines if len(line.get_xdata()) > 2}


def at_times(points, data, values):
    """Return what a line shows, and what it has to show, at the times of its points."""
    rows = np.searchsorted(data.times, points[:, 0])
    assert data.times[rows] == pytest.approx(points[:, 0])
    assert (rows[0], rows[-1]) == (0, len(data.times) - 1)
    return points[:, 1], values[rows]


def test_figure_5_speeds_of_the_first_the_middle_and_the_last_car(data):
    found = lines_of(arshad_figures.speed(data))
    assert list(found) == [f"vehicle {data.vehicles[k]}" for k in (0, 3, 5)]
    for points, k in zip(found.values(), (0, 3, 5), strict=True):
        shown, wished = at_times(points, data, data.of_vehicles("speed_kmh")[:, k] / MPH)
        assert shown == pytest.approx(wished)
    assert arshad_figures.speed(data).axes[0].get_ylabel() == "speed [mph]"


def test_figure_6_tractive_effort_of_all_locomotives(data):
    (points,) = lines_of(arshad_figures.tractive_effort(data)).values()
    shown, wished = at_times(points, data, data.of_vehicles("tractive_force_kn").sum(axis=1) / LBF)
    assert shown == pytest.approx(wished)
    assert shown.max() > 1e4


def test_figure_7_acceleration_of_the_locomotive(data):
    (points,) = lines_of(arshad_figures.acceleration(data)).values()
    shown, wished = at_times(points, data, data.of_vehicles("acceleration_mps2")[:, 0] / MPHPS)
    assert shown == pytest.approx(wished)
    assert shown.min() < 0.0 < shown.max()


def test_figure_8_cylinders_of_two_cars_fill_later_at_the_rear(data):
    found = lines_of(arshad_figures.cylinder_pressure(data))
    assert list(found) == [f"vehicle {data.vehicles[k]}" for k in (1, 5)]
    for points, k in zip(found.values(), (1, 5), strict=True):
        shown, wished = at_times(points, data, data.of_vehicles("cylinder_pressure_bar")[:, k] / PSI)
        assert shown == pytest.approx(wished)
    front, rear = (points[np.argmax(points[:, 1] > 1.0), 0] for points in found.values())
    assert rear > front


def test_figure_9_force_over_displacement_of_coupler_3_4_signs_of_compression_changed(data):
    figure = arshad_figures.coupler(data)
    force, stretch = data.of_couplings("force_kn")[:, 2] / LBF, data.of_couplings("deflection_mm")[:, 2] / INCH
    tension, compression = figure.axes[0].lines[:2]
    for line, sign in ((tension, 1.0), (compression, -1.0)):
        x, y = line.get_data()
        k = int((sign * force).argmax())
        assert np.nanmax(y) == pytest.approx(sign * force[k])
        assert x[np.nanargmax(y)] == pytest.approx(sign * stretch[k])
    told = figure.get_suptitle()
    assert "3-4" in told
    assert "the locomotive counted as the first" in told


def test_figure_10_places_of_the_cars_against_the_locomotive(data):
    found = lines_of(arshad_figures.relative_position(data))
    assert list(found) == [f"vehicle {name}" for name in data.vehicles[1:]]
    for points, k in zip(found.values(), range(1, 6), strict=True):
        shown, wished = at_times(points, data, data.of_vehicles("relative_position_m")[:, k] * 1000.0 / INCH)
        assert shown == pytest.approx(wished)


def test_titles_name_the_figures_of_the_paper(data):
    for number, draw in zip(range(5, 11), arshad_figures.FIGURES.values(), strict=True):
        title = draw(data).get_suptitle()
        assert f"(Arshad et al., figure {number})" in title
        assert data.scenario.name not in title


def test_what_the_six_show_is_not_drawn_twice_unless_asked_for(results, tmp_path, monkeypatch):
    empty = dict.fromkeys(SINGLE, lambda data: new_figure(1.0, 1.0))
    monkeypatch.setattr("tractionpower.reporting.figures.dynamics.of_chain.SINGLE", empty)
    six = dict.fromkeys(arshad_figures.FIGURES, lambda data: new_figure(1.0, 1.0))
    monkeypatch.setattr("tractionpower.reporting.figures.dynamics.of_chain.arshad_figures.FIGURES", six)
    write_chain_figures(results, fake_scenario(**CASE), tmp_path)
    written = {path.stem for path in tmp_path.glob("*.png")}
    assert written == {*SINGLE, *arshad_figures.FIGURES} - {"dynamics_speeds", "brake_cylinders", "relative_positions"}
    with drawing(ReportFigures(names=("dynamics_speeds",))):
        write_chain_figures(results, fake_scenario(**CASE), tmp_path)
    assert {path.stem for path in tmp_path.glob("*.png")} == {"dynamics_speeds"}


def test_texts_of_axes_have_imperial_units(data):
    for draw in arshad_figures.FIGURES.values():
        words = " ".join(text.get_text() for text in draw(data).findobj(Text))
        assert any(unit in words for unit in ("[mph]", "[lbf]", "[mph/s]", "[psi]", "[in]"))

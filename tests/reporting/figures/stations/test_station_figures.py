"""Figures of trains on a line with stations: colours, places, names; which files are written."""

import matplotlib.colors as colours
import numpy as np
import pytest
from matplotlib.figure import Figure
from small_stations import compute, make_case

from tractionpower.dynamics.traindyn.stations_run import StationsRun
from tractionpower.model.report import ReportFigures
from tractionpower.reporting.figures.base.drawing import drawing
from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, ORANGE
from tractionpower.reporting.figures.stations.marks import draw_by_state
from tractionpower.reporting.figures.stations.of_stations import NAMES, write_station_figures
from tractionpower.reporting.figures.stations.path_figures import distance_over_time, speed_over_distance
from tractionpower.reporting.figures.stations.topology import instants_of, topology
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter


@pytest.fixture(scope="module")
def case():
    slopes = [{"from_m": 3000.0, "to_m": 4000.0, "permille": 6.0}]
    return make_case(seed=2, traffic={"trains": 4, "headway_s": 120.0}, shown_at_s=[100.0, 245.5], gradients=slopes)


@pytest.fixture(scope="module")
def rows(case):
    return compute(case)[0]


def drawn(axes):
    """Return the points of the lines of axes by their colour."""
    points = {}
    for line in axes.lines:
        points.setdefault(line.get_color(), []).append(np.column_stack(line.get_data()))
    return {colour: np.concatenate(parts) for colour, parts in points.items()}


def test_pieces_of_a_line_have_the_colour_of_the_state_at_their_beginning():
    axes = Figure().add_subplot()
    states = ["accelerating", "cruising", "braking_to_stop", "standing", "accelerating", "standing"]
    draw_by_state(axes, np.arange(6.0), np.arange(6.0) ** 2, states)
    pieces = {}
    for line in axes.lines:
        x, y = line.get_data()
        for k in range(len(x) - 1):
            if np.isfinite([x[k], y[k], x[k + 1], y[k + 1]]).all():
                pieces[x[k], x[k + 1]] = line.get_color()
    assert pieces == {(0.0, 1.0): GREEN, (1.0, 2.0): GREEN, (2.0, 3.0): BLUE, (3.0, 4.0): GREY, (4.0, 5.0): GREEN}


def test_distance_over_time_shows_each_place_once(case, rows):
    (axes,) = distance_over_time(case, rows).axes
    points = drawn(axes)
    assert set(points) == {GREEN, BLUE, ORANGE, GREY}
    braking = rows[rows["state"] == "braking_to_stop"]
    shown = points[BLUE][~np.isnan(points[BLUE]).any(axis=1)]
    for time_s, place in zip(braking["time_s"], braking["position_m"], strict=True):
        assert np.isclose(shown, (time_s / 60.0, place / 1e3)).all(axis=1).any()
    assert axes.get_xlabel() == "time [min]"
    assert axes.get_ylim() == (0.0, 8.0)


def test_speed_over_distance_shows_limit_and_gradient(case, rows):
    speed, gradient = speed_over_distance(case, rows).axes
    assert 90.0 in [line.get_ydata()[0] for line in speed.lines]
    x, y = gradient.lines[0].get_data()
    assert y[np.searchsorted(x, [2.9, 3.1, 4.1], side="right") - 1].tolist() == [0.0, 6.0, 0.0]


def test_topology_shows_each_train_in_the_colour_of_its_state_with_its_speed(case, rows):
    figure = topology(case, rows)
    for axes, time_s in zip(figure.axes, (100.0, 245.0), strict=True):
        now = rows[rows["time_s"] == time_s]
        markers = [line for line in axes.lines if line.get_marker() == ">"]
        assert len(markers) == len(now) > 0
        wished = sorted(
            {"accelerating": GREEN, "cruising": GREEN, "braking_to_stop": BLUE, "standing": GREY, "decelerating": ORANGE}[s]
            for s in now["state"]
        )
        assert sorted(marker.get_color() for marker in markers) == wished
        told = " ".join(text.get_text() for text in axes.texts)
        assert f"{now['speed_kmh'].iloc[0]:.0f} km/h" in told
        assert f"at {time_s:.0f} s: {len(now)} trains" == axes.get_title(loc="left")
    box = figure.axes[0].texts[0].get_bbox_patch()
    assert colours.to_hex(box.get_edgecolor()).upper() in {GREEN, BLUE, GREY, ORANGE}


def test_without_instants_that_with_most_trains_is_shown(case, rows):
    (time_s,) = instants_of(case.model_copy(update={"shown_at_s": ()}), rows)
    counts = rows.groupby("time_s").size()
    assert counts[time_s] == counts.max()
    assert instants_of(case, rows) == [100.0, 245.0]


def test_files_are_written_as_the_template_says(case, tmp_path):
    writer = MemoryWriter()
    outcome = StationsRun(case, writer).execute()
    results = Results(run=outcome.run, key_figures=outcome.key_figures, _source=writer.tables())
    assert {path.stem for path in write_station_figures(results, case, tmp_path)} == {*NAMES}
    (tmp_path / "own.txt").touch()
    with drawing(ReportFigures(formats=("svg",), names=("station_topology",))):
        (only,) = write_station_figures(results, case, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {only.name, "own.txt"} == {"station_topology.svg", "own.txt"}
    nothing = Results(run=outcome.run, key_figures=[], _source={})
    assert write_station_figures(nothing, case, tmp_path) == []

"""Figures of train dynamics: they show what the tables hold, in the units of the case."""

import matplotlib as mpl
import numpy as np
import pyarrow as pa
import pytest
from fake_dynamics import fake_results, fake_scenario
from matplotlib.text import Text

from tractionpower.io.arshad.reading import PAPER
from tractionpower.model.report import ReportFigures
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.figures.base.drawing import drawing
from tractionpower.reporting.figures.base.style import STYLE, finish, new_figure
from tractionpower.reporting.figures.dynamics import arshad_figures, coupling_figures, over_time, spread_figures
from tractionpower.reporting.figures.dynamics.of_chain import NAMES, SINGLE, write_chain_figures
from tractionpower.reporting.figures.dynamics.stopping_figure import stopping
from tractionpower.reporting.reports import source_of
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("chain"))


@pytest.fixture(scope="module")
def data(results):
    return ChainData(results, fake_scenario())


@pytest.fixture(scope="module")
def imperial(results):
    return ChainData(results, fake_scenario(units="imperial"))


@pytest.fixture
def quick(monkeypatch):
    """Let figures be empty: what they show is tested elsewhere, here it is their files that matter."""
    empty = dict.fromkeys(SINGLE, lambda data: new_figure(1.0, 1.0))
    monkeypatch.setattr("tractionpower.reporting.figures.dynamics.of_chain.SINGLE", empty)
    six = dict.fromkeys(arshad_figures.FIGURES, lambda data: new_figure(1.0, 1.0))
    monkeypatch.setattr("tractionpower.reporting.figures.dynamics.of_chain.arshad_figures.FIGURES", six)


def texts(figure):
    return [text.get_text() for text in figure.findobj(Text) if text.get_text()]


def test_a_case_of_the_paper_has_its_six_plots_and_others_have_not(results, tmp_path, quick):
    write_chain_figures(results, fake_scenario(), tmp_path)
    assert {path.stem for path in tmp_path.glob("*.png")} == set(SINGLE)
    write_chain_figures(results, fake_scenario(source=f"{PAPER}. Nothing is assumed."), tmp_path)
    assert {path.stem for path in tmp_path.glob("*.png")} == set(NAMES) - set(arshad_figures.TWICE)
    with drawing(ReportFigures(names=("stopping",), formats=("svg",))):
        write_chain_figures(results, fake_scenario(), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["stopping.svg"]


@pytest.mark.parametrize("draw", [*SINGLE.values(), *arshad_figures.FIGURES.values()], ids=NAMES)
def test_no_text_is_cut(imperial, draw):
    figure = draw(imperial)
    finish(figure)
    with mpl.rc_context(STYLE):
        figure.canvas.draw()
    ticks = {text for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for text in axis.get_ticklabels(which="both")}
    for text in figure.findobj(Text):
        if text not in ticks and text.get_visible() and text.get_text().strip():
            box = text.get_window_extent()
            if box.width > 0.0:
                assert figure.bbox.x0 - 1.0 <= box.x0, text.get_text()
                assert box.x1 <= figure.bbox.x1 + 1.0, text.get_text()


@pytest.fixture(scope="module")
def standing(results):
    """Return a run in which nothing moves: all columns but times are zero."""
    tables = {}
    for name in results.tables:
        rows = results.table(name)
        for column in rows.select_dtypes("number").columns:
            if column not in ("time_s", "lowest", "highest", "frequency"):
                rows[column] = 0.0
        tables[name] = pa.Table.from_pandas(rows, preserve_index=False)
    tables.pop("rainflow")
    return ChainData(Results({**results.run, "stops": []}, [], tables), fake_scenario())


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("draw", [*SINGLE.values(), *arshad_figures.FIGURES.values()], ids=NAMES)
def test_a_train_that_stands_is_drawn_without_warnings(standing, draw):
    figure = draw(standing)
    if figure is not None:
        finish(figure)
        for axes in figure.axes:
            low, high = axes.get_ylim()
            assert low != high


def test_names_of_cases_stand_at_the_foot_and_titles_in_a_line(data, tmp_path):
    assert source_of(data.results).startswith(f"{data.scenario.name}, inputs ")
    for draw in SINGLE.values():
        first, *more = draw(data).get_suptitle().split("\n")
        assert data.scenario.name not in first
        assert first[0].isupper()
        assert len(more) <= 1


def test_emergency_is_a_word_on_the_axes_of_levels(data):
    low = ChainData(data.results, fake_scenario(air_brake={"levels": 5}))
    (ticks,) = ([text.get_text() for text in draw(low).axes[0].get_yticklabels()] for draw in (spread_figures.brake_and_speed,))
    assert ticks[-1] == "emergency"
    ticks = {tick.get_text(): tick.get_position()[1] for tick in over_time.controls(low).axes[0].get_yticklabels()}
    assert ticks["emergency"] == -6.0
    assert not any(text.startswith(("-", "\N{MINUS SIGN}")) for text in ticks)
    assert "emergency" not in [text.get_text() for text in spread_figures.brake_and_speed(data).axes[0].get_yticklabels()]


def test_few_levels_make_a_low_figure(data):
    low, high = spread_figures.brake_and_speed(data), spread_figures.drive_and_speed(data)
    rows = [len(figure.axes[0].get_yticks()) for figure in (low, high)]
    heights = [figure.get_size_inches()[1] for figure in (low, high)]
    for count, height in zip(rows, heights, strict=True):
        assert height <= 1.4 + 0.24 * max(count, 2)


def test_the_map_of_forces_keeps_the_greatest_of_each_spell():
    times = np.arange(5000.0)
    force = np.zeros((5000, 2))
    force[2501, 0], force[2502, 1] = 90.0, -120.0
    shown, values = coupling_figures._peaks_in_time(times, force)
    assert len(shown) == len(values) == coupling_figures.MOST_COLUMNS
    assert values[:, 0].max() == 90.0
    assert values[:, 1].min() == -120.0


def test_the_map_names_both_extremes(data):
    title = coupling_figures.forces_along_train(data).get_suptitle()
    for side in ("tension", "compression"):
        k = int(data.greatest(side).argmax())
        assert f"{data.greatest(side)[k]:.1f} kN, coupling {data.couplings[k]}" in title


def test_bars_stand_for_the_extremes_and_lines_for_what_is_endured(data):
    axes = coupling_figures.extremes(data).axes[0]
    heights = [bar.get_height() for bar in axes.patches]
    assert heights[:5] == pytest.approx(data.greatest("tension"))
    assert heights[5:] == pytest.approx(-data.greatest("compression"))
    dashed = [line.get_ydata()[0] for line in axes.lines if line.get_linestyle() == "--" and len(line.get_ydata()) > 2]
    assert dashed == [850.0, -60.0]


def test_a_loop_is_force_over_deflection_and_folded_all_of_it_is_positive(data, imperial):
    axes = coupling_figures.loops(data).axes[0]
    tension = axes.lines[0]
    x, y = tension.get_xdata(), tension.get_ydata()
    assert np.nanmax(y) == pytest.approx(data.of_couplings("force_kn")[:, 0].max())
    assert x[np.nanargmax(y)] == data.of_couplings("deflection_mm")[np.argmax(data.of_couplings("force_kn")[:, 0]), 0]
    folded = arshad_figures.coupler(imperial).axes[0]
    compression = folded.lines[1].get_ydata()
    least = data.of_couplings("force_kn")[:, 2].min()
    assert least < -1.0
    assert np.nanmax(compression) == pytest.approx(-least * 224.80894, rel=1e-6)


def test_brake_levels_go_down_and_emergency_is_named(data):
    axes = over_time.controls(data).axes[0]
    drive, brake = axes.lines[:2]
    assert drive.get_ydata().max() == 15
    assert brake.get_ydata().min() == -data.control("brake").max()
    assert "emergency" not in texts(over_time.controls(data))
    low = ChainData(data.results, fake_scenario(air_brake={"levels": 5}))
    assert "emergency" in texts(over_time.controls(low))


def test_cylinders_and_pipe_go_against_each_other(data):
    axes = over_time.cylinders(data).axes[0]
    assert [line.get_label() for line in axes.lines][-1] == "brake pipe at the driver's valve"
    first, pipe = axes.lines[0].get_ydata(), axes.lines[-1].get_ydata()
    assert first.max() == pytest.approx(data.of_vehicles("cylinder_pressure_bar")[:, 0].max())
    assert (pipe[0], pipe.min()) == pytest.approx((5.0, 5.0 - data.control("reduction_bar").max()))


def test_the_stop_begins_at_the_command_and_ends_where_the_train_stands(data, imperial):
    figure = stopping(data)
    line = figure.axes[0].lines[0]
    distance = data.results.key_figure("stopping_distance_m")
    assert line.get_xdata()[0] == 0.0
    assert line.get_xdata()[-1] == pytest.approx(distance, abs=1e-6)
    assert line.get_ydata()[0] == pytest.approx(data.results.key_figure("braked_from_kmh"))
    assert line.get_ydata()[-1] == pytest.approx(0.0, abs=0.01)
    assert f"stopping distance {distance:.1f} m" in figure.get_suptitle()
    assert f"{distance / 0.3048:.0f} ft" in texts(stopping(imperial))


def test_histograms_hold_the_whole_time(data):
    for draw in (spread_figures.coupling_histogram, spread_figures.acceleration_histogram):
        bars = draw(data).axes[0].patches
        assert sum(bar.get_height() for bar in bars) == pytest.approx(100.0)


def test_cycles_are_counted_from_the_greatest_range_on(data):
    right = spread_figures.rainflow(data).axes[1]
    rows = data.table("rainflow")
    own = rows[rows["coupling"] == data.couplings[0]]
    assert right.lines[0].get_xdata()[-1] == pytest.approx(own["cycles"].sum())
    assert right.lines[0].get_ydata()[0] == own["range_kn"].max()


def test_the_work_of_the_traction_is_drawn_to_its_end(data):
    line = over_time.energies(data).axes[0].lines[0]
    assert line.get_ydata()[-1] == pytest.approx(data.results.key_figure("traction_energy_kwh"))


def test_what_a_run_lacks_is_not_drawn(data):
    bare = ChainData(Results({}, [], {}), data.scenario)
    assert [draw(bare) for draw in SINGLE.values()] == [None] * len(SINGLE)

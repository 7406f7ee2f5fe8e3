"""The figure of a train of a run: over the route on the left, over time on the right."""

import numpy as np
import pytest
from fake_runs import big_run, small_run

from tractionpower.kernels.train_tables import PHASES
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.trains.train_figures import (
    MOST,
    PHASE_COLOURS,
    chosen_trains,
    ride_of,
    spells,
    train_figure,
    train_figures,
)


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def draw(data, name):
    ((_, figure),) = train_figures(data, [name])
    figure.canvas.draw()
    own = figure.axes
    return figure, np.array([*own[:2], *own[3:9]]).reshape(4, 2)  # the third shows the height


def line_named(axes, label):
    return next(line for line in axes.lines if line.get_label() == label)


@pytest.mark.parametrize(("name", "ends"), [("2", (0.0, 20.0)), ("3/IC", (10.0, 0.0))])
def test_speed_voltage_and_current_stand_over_kilometres_and_over_time(data, name, ends):
    rows = dict(data.rows_of("trains", "train"))[name]
    _, grid = draw(data, name)
    for row, column, label in (
        (0, "speed_kmh", "speed"),
        (2, "voltage_v", "voltage at the pantograph"),
        (3, "current_a", "current at the pantograph"),
    ):
        way, time = (line_named(axes, label) for axes in grid[row])
        assert way.get_xdata()[[0, -1]] == pytest.approx(ends, abs=0.1)  # up to the step in which it leaves
        assert time.get_xdata()[0] == rows["time_s"].iloc[0]
        for line in (way, time):
            whole = rows[column].iloc[:-1]  # without the step in which it leaves
            assert (line.get_ydata().min(), line.get_ydata().max()) == pytest.approx((whole.min(), whole.max()))
    assert [axes.get_ylabel().replace("\n", " ") for axes in grid[:, 0]] == [
        "speed [km/h]", "gradient [‰]", "voltage at the pantograph [V]", "current at the pantograph [A]"
    ]  # fmt: skip
    assert "[km], track" in grid[3, 0].get_xlabel()
    assert grid[3, 1].get_xlabel() == "time of day [h:min]"
    left, right = grid[3, 0].get_xlim()
    assert (left > right) == (ends[0] > ends[1])


def test_limits_of_speed_and_current_are_those_of_the_line(data):
    figure, grid = draw(data, "2")
    limit = line_named(grid[0, 0], "permitted speed of the line")
    assert limit.get_xdata().tolist() == [0.0, 12.0, 20.0]
    assert limit.get_ydata() == pytest.approx([160.0, 120.0, 120.0])
    current = line_named(grid[3, 0], "train current limit of the line")
    assert current.get_ydata()[0] == 1600.0
    assert np.isnan(current.get_ydata()[-1])
    assert figure.axes[2].lines[0].get_ydata().max() == pytest.approx(32.0)  # 8 km at 4 permille
    gradient = grid[1, 0].lines[0]
    assert gradient.get_xdata() == pytest.approx([0.0, 8.0, 20.0])
    assert gradient.get_ydata() == pytest.approx([4.0, -3.0, -3.0])


def test_the_title_tells_the_worst_voltage_and_current(data):
    figure, _ = draw(data, "2")
    rows = dict(data.rows_of("trains", "train"))["2"]
    title = figure._suptitle.get_text()
    assert title.startswith("Four trains: train 2, Alfa – Beta\n")
    assert f"lowest voltage {rows['voltage_v'].min():.0f} V" in title
    assert f"highest current {rows['current_a'].max():.0f} A" in title


def test_stations_and_substations_are_named_and_nothing_overlaps(data, no_overlap):
    figure, grid = draw(data, "2")
    stations = grid[0, 0].child_axes[0].get_xticklabels()
    devices = grid[2, 0].texts
    assert [text.get_text() for text in stations] == ["Alfa", "Ćma", "Beta"]
    assert {text.get_text() for text in devices} == {"▲", "■", "A", "B", "C"}
    no_overlap(
        figure, [*stations, *devices, *grid[2, 1].texts, figure.axes[2].yaxis.label, *(axes.yaxis.label for axes in grid[:, 0])]
    )


def test_a_line_of_many_devices_has_no_name_over_another(no_overlap):
    run = big_run()
    data = RunData(run.results, run.scenario)
    figure, grid = draw(data, "10030")
    no_overlap(figure, [*grid[0, 0].child_axes[0].get_xticklabels(), *grid[2, 0].texts])
    assert len(grid[2, 0].lines) > 27


def test_where_the_voltage_limits_the_effort_is_shaded(data):
    rows = dict(data.rows_of("trains", "train"))["2"]
    limited = rows[rows["limited_by"] == "voltage"]
    assert len(limited) > 10
    _, grid = draw(data, "2")
    (shade,) = grid[2, 1].patches
    assert shade.get_x() == limited["time_s"].iloc[0]
    assert shade.get_width() == len(limited)
    _, other = draw(data, "3/IC")
    assert not len(other[2, 1].patches)


def test_every_phase_has_a_colour_of_its_own_and_the_band_covers_the_run(data):
    assert len({PHASE_COLOURS[phase] for phase in PHASES}) == len(PHASES)
    figure, grid = draw(data, "2")
    bands = [path.get_extents() for band in grid[1, 1].collections for path in band.get_paths()]
    rows = dict(data.rows_of("trains", "train"))["2"]
    assert sum(box.width for box in bands) == pytest.approx(len(rows), abs=1.0)
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert set(rows["phase"]) <= set(words)


def test_a_train_without_any_voltage_is_drawn(data):
    name, rows = next(data.rows_of("trains", "train"))
    rows = rows.assign(voltage_v=np.nan, current_a=np.nan)
    figure = train_figure(ride_of(data, name, rows), data)
    figure.canvas.draw()
    assert any(len(line.get_xdata()) == len(rows) for axes in figure.axes for line in axes.lines)  # its speed is there


def test_of_many_trains_those_with_the_lowest_voltages_and_the_highest_currents_are_shown():
    run = big_run()
    data = RunData(run.results, run.scenario)
    chosen = chosen_trains(data)
    by_train = run.results.table("trains").groupby("train", observed=True)
    assert len(chosen) == MOST
    assert set(by_train["voltage_v"].min().nsmallest(MOST // 2).index) <= set(chosen)
    others = by_train["current_a"].max().drop(by_train["voltage_v"].min().nsmallest(MOST // 2).index)
    assert others.nlargest(MOST // 2).min() == pytest.approx(min(others[name] for name in chosen if name in others.index))


def test_all_of_few_trains_are_shown_and_none_without_their_table(data):
    assert chosen_trains(data) == ["1", "2", "3/IC", "4"]
    assert chosen_trains(RunData(small_run().without("trains"), data.scenario)) == []


def test_spells():
    assert spells(np.array([], bool)) == []
    assert spells(np.array([True, True, False, True])) == [(0, 2), (3, 4)]

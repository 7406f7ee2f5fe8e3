from itertools import pairwise

import pytest
from fake_branch import branch_run
from fake_results import make_case
from openpyxl.utils import range_boundaries


def column_of(book, reference):
    sheet, cells = reference.split("!")
    left, top, _, bottom = range_boundaries(cells.replace("$", ""))
    sheet = book[sheet.strip("'")]
    return [sheet.cell(row, left).value for row in range(top, bottom + 1)], (sheet, top, bottom)


def title_of(part):
    return "".join(run.t for run in part.title.tx.rich.p[0].r)


def charts_of(book):
    return {title_of(chart): chart for chart in book["Charts"]._charts}


@pytest.fixture(scope="module")
def charts(small):
    return charts_of(small)


def test_every_chart_is_there_in_order(charts):
    assert list(charts) == [
        "Train graph", "Voltage along the line", "Voltages at the pantographs", "Train 1000: voltage and speed",
        "Load curves of the substations", "Substation Substation 1: load with sliding means", "Load duration of the substations",
    ]  # fmt: skip


def test_a_line_of_the_train_graph_is_one_train(small, charts):
    shown, stations = set(), {}
    for series in charts["Train graph"].series:
        _, (sheet, top, bottom) = column_of(small, series.yVal.numRef.f)
        names = {sheet.cell(row, 1).value for row in range(top, bottom + 1)}
        assert names == {series.tx.v}
        assert sheet.cell(top - 1, 1).value not in names
        assert sheet.cell(bottom + 1, 1).value not in names
        if series.dLbls is None:
            shown |= names
        else:  # a station: its name stands at the end of a level line
            kms, _ = column_of(small, series.yVal.numRef.f)
            (label,) = series.dLbls.dLbl
            assert (label.idx, label.showSerName, label.showVal) == (1, True, False)
            stations[series.tx.v] = kms
    assert shown == {"1000", "1001", "1002", "1003"}
    assert stations == {"Alfa": [0, 0], "Łódź Bravo": [40, 40]}
    assert (charts["Train graph"].y_axis.scaling.min, charts["Train graph"].y_axis.scaling.max) == (0, 40)


def test_the_chart_of_voltages_shows_pantographs_limits_and_substations(small, charts):
    chart = charts["Voltage along the line"]
    by_name = {series.tx.v: column_of(small, series.yVal.numRef.f) for series in chart.series}
    curves = {f"track {track}, {which}" for track in "12" for which in ("lowest", "mean", "highest")}
    places = {"Substation 1", "Substation 2", "Substation 3", "C"}
    assert set(by_name) == curves | {"U_min2", "U_n", "U_max1", "U_max2"} | places
    _, (sheet, top, bottom) = by_name["track 2, lowest"]
    assert {(sheet.cell(row, 1).value, sheet.cell(row, 2).value) for row in range(top, bottom + 1)} == {("pantograph", "2")}
    for name in curves:
        values, _ = by_name[name]
        assert chart.y_axis.scaling.min < min(values) <= max(values) < chart.y_axis.scaling.max
    assert {value for name in places for value in by_name[name][0]} == {chart.y_axis.scaling.max}
    hidden = {entry.idx for entry in chart.legend.legendEntry if entry.delete}
    assert {chart.series[number].tx.v for number in hidden} == places


def test_limits_in_charts_follow_the_cells_that_can_be_edited(small, charts):
    by_name = {series.tx.v: column_of(small, series.yVal.numRef.f)[0] for series in charts["Voltage along the line"].series}
    for name in ("u_min2", "u_n", "u_max1", "u_max2"):
        shown = by_name[f"U_{name[2:]}"]
        assert len(shown) == 2
        if f"limit_{name}" in small.defined_names:
            assert set(shown) == {f'=IF(ISNUMBER(limit_{name}),limit_{name},"")'}
        else:
            assert set(shown) == {{"u_min2": 2000, "u_n": 3000, "u_max1": 3600, "u_max2": 3900}[name]}


def test_axes_are_seen_and_tell_their_units(charts):
    for chart in charts.values():
        assert chart.x_axis.delete is False
        assert chart.y_axis.delete is False
    titles = [title_of(chart.y_axis) for chart in charts.values()]
    assert titles == [
        "place [km]", "voltage [V]", "share of the time [%]", "voltage [V]", "power [kW]", "power [kW]", "power [kW]",
    ]  # fmt: skip


def test_power_is_shown_from_nothing_on(charts):
    powers = [chart for chart in charts.values() if title_of(chart.y_axis) == "power [kW]"]
    assert len(powers) == 3
    assert all(chart.y_axis.scaling.min == 0.0 for chart in powers)


def test_the_clock_of_an_axis_holds_all_points(charts):
    for name in ("Train graph", "Load curves of the substations", "Substation Substation 1: load with sliding means"):
        axis = charts[name].x_axis
        assert axis.number_format.formatCode == "[hh]:mm"
        assert axis.scaling.min <= 0.25
        assert (axis.scaling.max - axis.scaling.min) / axis.majorUnit <= 13


def test_many_substations_are_drawn_in_groups_and_the_most_loaded_only(write):
    book = write(*make_case(trains=2, substations=20, hours=1.0))
    groups = [chart for title, chart in charts_of(book).items() if title.startswith("Load curves")]
    assert [len(chart.series) for chart in groups] == [7, 7]
    drawn = [int(series.tx.v.split()[1]) for chart in groups for series in chart.series]
    assert drawn == sorted(drawn)
    sheet = book["Extract loads"]
    highest = {}
    for column in sheet.iter_cols(2, values_only=True):
        top = next(k for k, value in enumerate(column) if isinstance(value, str) and value.startswith("Substation "))
        highest[int(column[top].split()[1])] = max(value for value in column[top + 1 :] if value is not None)
    assert set(drawn) == set(sorted(highest, key=lambda number: -highest[number])[:14])


def test_main_line_and_branch_have_charts_of_their_own(write):
    run = branch_run()
    book = write(run.results, run.scenario)
    charts = charts_of(book)
    both = [f"{what}, {tracks}" for what in ("Train graph", "Voltage along the line") for tracks in ("tracks 1, 2", "track 3")]
    assert list(charts)[:4] == both
    trains = [series for series in charts["Train graph, track 3"].series if series.dLbls is None]
    assert sorted(series.tx.v for series in trains) == ["R 101", "R 102", "T 23"]
    rising = {series.tx.v: series.graphicalProperties.line.dashStyle for series in trains}
    assert rising == {"R 101": "dash", "R 102": "solid", "T 23": "dash"}
    for name in ("Train graph, tracks 1, 2", "Train graph, track 3"):
        for series in charts[name].series:
            places, _ = column_of(book, series.yVal.numRef.f)
            steps = [abs(b - a) for a, b in pairwise(places)]
            assert max(steps) < 1.0  # no line across the junction
    profile = charts["Voltage along the line, track 3"]
    assert {series.tx.v for series in profile.series} >= {"track 3, lowest", "track 3, mean"}
    assert not any(series.tx.v.startswith(("track 1", "track 2")) for series in profile.series)
    assert (profile.x_axis.scaling.min, profile.x_axis.scaling.max) == (0.0, 15.0)

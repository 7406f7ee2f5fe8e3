from itertools import pairwise

from fake_branch import branch_run
from openpyxl.utils import range_boundaries


def column_of(book, reference):
    sheet, cells = reference.split("!")
    left, top, _, bottom = range_boundaries(cells.replace("$", ""))
    sheet = book[sheet.strip("'")]
    return [sheet.cell(row, left).value for row in range(top, bottom + 1)], (sheet, top, bottom)


def chart_of(book, number):
    return book["Charts"]._charts[number]


def test_a_line_of_the_train_graph_is_one_train(small):
    shown = set()
    for series in chart_of(small, 0).series:
        _, (sheet, top, bottom) = column_of(small, series.yVal.numRef.f)
        names = {sheet.cell(row, 1).value for row in range(top, bottom + 1)}
        assert names == {series.tx.v}
        assert sheet.cell(top - 1, 1).value not in names
        assert sheet.cell(bottom + 1, 1).value not in names
        shown |= names
    assert shown == {"1000", "1001", "1002", "1003"}


def test_the_chart_of_voltages_shows_pantographs_and_limits(small):
    chart = chart_of(small, 1)
    by_name = {series.tx.v: column_of(small, series.yVal.numRef.f) for series in chart.series}
    assert set(by_name) == {"track 1, lowest", "track 1, mean", "track 2, lowest", "track 2, mean", "U_min2", "U_n", "U_max1"}
    assert set(by_name["U_min2"][0]) == {2000}
    _, (sheet, top, bottom) = by_name["track 2, lowest"]
    assert {(sheet.cell(row, 1).value, sheet.cell(row, 2).value) for row in range(top, bottom + 1)} == {("pantograph", "2")}
    for values, _ in by_name.values():
        assert chart.y_axis.scaling.min < min(values) <= max(values) < chart.y_axis.scaling.max


def test_axes_are_seen_and_tell_their_units(small):
    for chart in small["Charts"]._charts:
        assert chart.x_axis.delete is False
        assert chart.y_axis.delete is False
    titles = ["".join(run.t for run in chart.y_axis.title.tx.rich.p[0].r) for chart in small["Charts"]._charts]
    assert titles == ["place [km]", "voltage [V]", "power [kW]", "power [kW]"]


def test_power_is_shown_from_nothing_on(small):
    for number in (2, 3):
        assert chart_of(small, number).y_axis.scaling.min == 0.0


def test_the_clock_of_an_axis_holds_all_points(small):
    for number in (0, 2):
        axis = chart_of(small, number).x_axis
        assert axis.number_format.formatCode == "[hh]:mm"
        assert axis.scaling.min <= 0.25
        assert (axis.scaling.max - axis.scaling.min) / axis.majorUnit <= 13


def title_of(chart):
    return "".join(run.t for run in chart.title.tx.rich.p[0].r)


def test_main_line_and_branch_have_charts_of_their_own(write):
    run = branch_run()
    book = write(run.results, run.scenario)
    charts = {title_of(chart): chart for chart in book["Charts"]._charts}
    both = [f"{what}, {tracks}" for what in ("Train graph", "Voltage along the line") for tracks in ("tracks 1, 2", "track 3")]
    assert list(charts)[:4] == both
    assert sorted(series.tx.v for series in charts["Train graph, track 3"].series) == ["R 101", "R 102", "T 23"]
    rising = {series.tx.v: series.graphicalProperties.line.dashStyle for series in charts["Train graph, track 3"].series}
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

from fake_results import WINDOWS
from read_workbook import exactly, read_table

from tractionpower.results.results import Results


def test_figures_are_those_of_the_run(small, case):
    rows = read_table(small["Substations"], 1)
    assert [row["substation"] for row in rows] == ["Substation 1", "Substation 2", "Substation 3"]
    for row in rows:
        place = f"substation {row['substation']}"
        assert row["energy [kWh]"] == exactly(case[0].key_figure("energy_kwh", place))
        assert row["highest 15 min demand by the clock [kW]"] == exactly(
            case[0].key_figure("highest_clock_15_min_power_kw", place)
        )
        assert row["time of highest power"] == 6 * 3600 + 20 * 60


def test_windows_go_from_short_to_long(small, case):
    for number, pattern in ((2, "highest_mean_power_{}_kw"), (3, "highest_rms_current_{}_a")):
        for row in read_table(small["Substations"], number):
            assert list(row)[1:] == [window.replace("_", " ") for window in WINDOWS]
            for window in WINDOWS:
                value = case[0].key_figure(pattern.format(window), f"substation {row['substation']}")
                assert row[window.replace("_", " ")] == exactly(value)


def test_zones_have_both_mean_useful_voltages(small):
    (row,) = read_table(small["Substations"], 4)
    assert row == {"zone": "Substation 1–Substation 2", "current weighted [V]": 2900.5, "time mean [V]": 2900.5}


def test_loads_have_their_energy(small):
    assert read_table(small["Substations"], 5) == [{"load": "depot", "place [km]": 4, "track": "1", "energy [kWh]": 100}]


def test_windows_that_the_run_does_not_have_are_left_out(case, write):
    results, scenario = case
    short = [figure for figure in results.key_figures if "_min_" not in figure["name"]]
    book = write(Results(results.run, short, results._source), scenario)
    assert list(read_table(book["Substations"], 2)[0]) == ["substation", "10 s", "15 s"]
    (chart,) = book["Substations"]._charts
    assert len(chart.series) == 1


def test_bars_stand_on_the_cells_of_their_window(small):
    sheet = small["Substations"]
    (chart,) = sheet._charts
    for series, window in zip(chart.series, ("10 s", "1 min", "15 min", "60 min"), strict=True):
        cells = series.val.numRef.f.split("!")[1].replace("$", "")
        shown = [cell.value for (cell,) in sheet[cells]]
        assert shown == [row[window] for row in read_table(sheet, 2)]

import pytest
from fake_results import WINDOWS
from read_workbook import exactly, read_table

from tractionpower.results.results import Results


def test_figures_are_those_of_the_run(small, case):
    rows = read_table(small["Substations"])
    assert [row["substation"] for row in rows] == ["Substation 1", "Substation 2", "Substation 3"]
    for row in rows:
        place = f"substation {row['substation']}"
        assert row["energy at the busbars [kWh]"] == exactly(case[0].key_figure("energy_kwh", place))
        assert row["highest 15 min demand by the clock [kW]"] == exactly(
            case[0].key_figure("highest_clock_15_min_power_kw", place)
        )
        assert row["time of highest power"] == 6 * 3600 + 20 * 60


def test_windows_go_from_short_to_long(small, case):
    for number, pattern in ((3, "highest_mean_power_{}_kw"), (4, "highest_rms_current_{}_a")):
        for row in read_table(small["Substations"], number):
            assert list(row)[1:] == [window.replace("_", " ") for window in WINDOWS]
            for window in WINDOWS:
                value = case[0].key_figure(pattern.format(window), f"substation {row['substation']}")
                assert row[window.replace("_", " ")] == exactly(value)


def test_zones_have_both_mean_useful_voltages(small):
    (row,) = read_table(small["Substations"], 5)
    assert row["zone"] == "Substation 1–Substation 2"
    assert {row[f"mean useful voltage, {which} [V]"] for which in ("current-weighted", "time mean")} == {2900.5}


@pytest.mark.parametrize("zone", ["A–M", "M–B"])
def test_mean_useful_voltages_of_zones_are_those_of_the_rows(rich, zone):
    (row,) = [row for number in range(3, 9) for row in table_of(rich.values, number) if row.get("zone") == zone]
    low, high = {"A–M": (0.0, 9.0), "M–B": (9.0, 20.0)}[zone]
    rows = rich.results.table("trains")
    inside = rows[(rows["position_km"] > low) & (rows["position_km"] < high)]
    above = below = 0.0
    for _, own in inside.groupby("train", observed=True):
        volts, amps = own["voltage_v"].astype(float), own["current_a"].astype(float).abs()
        above, below = above + (volts * amps).mean(), below + amps.mean()
    assert row["mean useful voltage, current-weighted [V]"] == pytest.approx(above / below, rel=1e-3)
    assert row["mean useful voltage, time mean [V]"] == pytest.approx(inside["voltage_v"].astype(float).mean(), rel=1e-3)


def table_of(book, number):
    names = [name for name in book["Substations"].tables if name.endswith(f"_{number}")]
    return read_table(book["Substations"], number) if names else []


def test_shares_of_energy_are_those_of_the_table(rich):
    power = rich.results.table("substations").groupby("substation", observed=True)["power_kw"].sum()
    for row in read_table(rich.values["Substations"]):
        assert row["share of all [%]"] == pytest.approx(100.0 * power[row["substation"]] / power.sum(), rel=1e-5)
        hours = 900.0 / 3600.0
        mean = row["energy at the busbars [kWh]"] / hours
        assert row["mean of highest power [%]"] == pytest.approx(100.0 * mean / row["highest power [kW]"])
    assert "busbar_energy" in read_table(rich.formulas["Substations"])[0]["share of all [%]"]


def test_supply_points_have_the_energies_of_their_substations(rich):
    (row,) = [
        row for number in range(3, 9) for row in table_of(rich.values, number) if "supply point" in row and "substations" in row
    ]
    assert (row["supply point"], row["substations"], row["contract [kW]"]) == ("North", "A, M", 5000)
    energies = [rich.figure("energy_kwh", f"substation {name}") for name in "AM"]
    assert row["energy at the busbars [kWh]"] == pytest.approx(sum(energies), rel=1e-12)


def test_loads_have_their_energy_and_share(small, rich):
    assert read_table(small["Substations"], 6)[0]["energy [kWh]"] == 100
    rows = [row for number in range(3, 9) for row in table_of(rich.values, number) if "load" in row]
    assert [row["load"] for row in rows] == ["depot", "heating"]
    assert [row["share of all [%]"] for row in rows] == pytest.approx([50.0, 50.0])


def test_windows_that_the_run_does_not_have_are_left_out(case, write):
    results, scenario = case
    short = [figure for figure in results.key_figures if "_min_" not in figure["name"]]
    book = write(Results(results.run, short, results._source), scenario)
    assert list(read_table(book["Substations"], 3)[0]) == ["substation", "10 s", "15 s"]
    (chart,) = book["Substations"]._charts
    assert len(chart.series) == 1


def test_bars_stand_on_the_cells_of_their_window(small):
    sheet = small["Substations"]
    (chart,) = sheet._charts
    for series, window in zip(chart.series, ("10 s", "1 min", "15 min", "60 min"), strict=True):
        cells = series.val.numRef.f.split("!")[1].replace("$", "")
        shown = [cell.value for (cell,) in sheet[cells]]
        assert shown == [row[window] for row in read_table(sheet, 3)]

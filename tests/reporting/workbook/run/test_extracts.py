import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from fake_results import make_case
from openpyxl import load_workbook
from read_workbook import read_table

from tractionpower.reporting.workbook import write_workbook
from tractionpower.reporting.workbook.run.drawn import chosen
from tractionpower.reporting.workbook.run.load_extracts import period_of
from tractionpower.reporting.workbook.run.train_extracts import ALL_POINTS, MOST_POINTS, MOST_TRAINS
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def values(small_file):
    """Return the workbook with the values that stand beside its formulas."""
    return load_workbook(small_file, data_only=True)


@pytest.mark.parametrize(("count", "most"), [(1, 300), (299, 300), (300, 300), (5000, 300), (7, 2)])
def test_chosen_rows_are_spread_and_hold_both_ends(count, most):
    rows = chosen(count, most)
    assert len(rows) == min(count, most)
    assert (rows[0], rows[-1]) == (0, count - 1)
    assert np.diff(rows).max(initial=1) - np.diff(rows).min(initial=count) <= 1


@pytest.mark.parametrize(
    ("seconds", "period"), [(900.0, 10), (3600.0, 60), (6 * 3600.0, 300), (24 * 3600.0, 900), (7 * 86400.0, 3600)]
)
def test_means_get_longer_with_the_run(seconds, period):
    assert period_of(seconds) == period


def test_points_of_trains_are_rows_of_the_table(small, case):
    frame = case[0].table("trains").set_index(["train", "time_s"])
    rows = read_table(small["Extract trains"])
    assert len(rows) == 4 * MOST_POINTS
    for row in rows[::97]:
        of_table = frame.loc[(row["train"], round(row["time of day"]))]
        assert row["place [km]"] == pytest.approx(of_table["position_km"], abs=1e-12)
        assert row["voltage [V]"] == pytest.approx(of_table["voltage_v"], abs=1e-9)
    assert MOST_TRAINS * MOST_POINTS > ALL_POINTS, "many trains have fewer points each"


def test_the_worst_train_is_the_one_with_the_lowest_voltage(values, case):
    frame = case[0].table("trains")
    worst = frame.loc[frame["voltage_v"].idxmin()]
    rows = pd.DataFrame(read_table(values["Extract worst train"]))
    assert rows["voltage [V]"].min() == worst["voltage_v"]
    own = frame[frame["train"] == worst["train"]]
    assert set(rows["voltage [V]"]) <= set(own["voltage_v"])
    assert rows["time of day"].is_monotonic_increasing
    assert len(rows) <= len(own)


def test_the_histogram_counts_the_time_in_each_class(values, case):
    frame, rows = case[0].table("trains"), read_table(values["Voltage histogram"])
    volts = frame["voltage_v"].to_numpy(float)
    assert sum(row["time of all trains [h]"] for row in rows) == pytest.approx(len(volts) / 3600.0)
    for row in rows:
        inside = np.mean((volts >= row["from [V]"]) & (volts < row["below [V]"]))
        assert row["share of the time [%]"] == pytest.approx(100.0 * inside)
        bands = [row[f"share {words} [%]"] for words in ("below U_min2", "from U_min2 to U_max1", "above U_max1")]
        assert sum(bands) == pytest.approx(row["share of the time [%]"])
        assert (bands[0] > 0.0) == (row["below [V]"] <= 2000.0 and inside > 0.0)
        assert (bands[2] > 0.0) == (row["from [V]"] >= 3600.0 and inside > 0.0)


def test_load_curves_are_the_means_of_the_table(small, case):
    frame = case[0].table("substations")
    slot = (frame["time_s"] // 60 * 60).rename("slot")
    means = frame.groupby([slot, "substation"], observed=True)["power_kw"].mean().unstack()
    rows = pd.DataFrame(read_table(small["Extract loads"]))
    assert np.abs(rows["time of day"] - means.index.to_numpy()).max() < 1e-3
    for name in means:
        assert np.allclose(rows[f"{name} [kW]"], means[name], rtol=1e-6)


def test_sliding_means_are_those_of_the_stored_steps(values, small, case):
    frame = case[0].table("substations")
    rows = pd.DataFrame(read_table(values["Extract substation"]))
    power = frame.loc[frame["substation"] == "Substation 1", ["time_s", "power_kw"]].set_index("time_s")["power_kw"]
    step = round(rows["time of day"].iloc[1] - rows["time of day"].iloc[0])
    for _, row in rows.dropna().iterrows():
        end = round(row["time of day"]) + step
        assert row["mean of 15 min [kW]"] == pytest.approx(power[(power.index >= end - 900) & (power.index < end)].mean())
    assert rows["mean of 15 min [kW]"].isna().sum() == 900 // step - 1
    assert "mean of 60 min [kW]" not in rows, "the run is shorter"
    formulas = [row["mean of 15 min [kW]"] for row in read_table(small["Extract substation"])]
    assert sum(str(formula).startswith("=AVERAGE(B") for formula in formulas) == rows["mean of 15 min [kW]"].notna().sum()


def test_no_load_is_zero_and_its_sliding_mean_too(tmp_path):
    """Half an hour of load, then what a solver leaves of nothing: a running sum would drift, and the noise would show."""
    times = np.arange(7200.0)
    power = np.where(times < 1800.0, 3456.789 + 1e3 * np.sin(times), -1.8e-7)
    results, scenario = make_case(substations=2, hours=2.0)
    frame = pd.DataFrame({"time_s": times + 21_600.0, "substation": "Substation 1", "voltage_v": 3500.0, "power_kw": power})
    results._source["substations"] = pa.Table.from_pandas(frame.assign(current_a=power / 3.5), preserve_index=False)
    book = load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"), data_only=True)
    rows = read_table(book["Extract substation"])
    assert [row["power [kW]"] for row in rows[-100:]] == [0.0] * 100
    assert [row["mean of 15 min [kW]"] for row in rows[-100:]] == [0.0] * 100
    assert rows[len(rows) // 4]["mean of 15 min [kW]"] > 3000.0


def test_load_duration_falls_from_the_highest_to_the_lowest(small, case):
    frame = case[0].table("substations")
    rows = pd.DataFrame(read_table(small["Load duration"]))
    power = frame.loc[frame["substation"] == "Substation 2", "power_kw"]
    column = rows["Substation 2 [kW]"]
    assert (column.iloc[0], column.iloc[-1]) == pytest.approx((power.max(), power.min()))
    assert (column.diff().dropna() <= 0.0).all()
    assert (power >= column.iloc[25]).mean() == pytest.approx(0.25, abs=0.002)


def test_the_profile_is_the_table(small, values, case):
    frame = case[0].table("profile")
    rows = pd.DataFrame(read_table(small["Voltage profile"]))
    assert len(rows) == len(frame)
    assert rows["lowest voltage [V]"].sum() == pytest.approx(frame["lowest_voltage_v"].sum())
    limits = read_table(values["Voltage profile"], 2)
    assert [(row["U_min2 [V]"], row["U_n [V]"], row["U_max1 [V]"]) for row in limits] == [(2000, 3000, 3600)] * 2


def test_extracts_print_their_beginning_and_say_so(small):
    for name in ("Extract trains", "Voltage profile", "Load duration"):
        sheet = small[name]
        rows = int(sheet.print_area.rpartition("$")[2])
        assert rows < 80 < sheet.max_row
        assert sheet.oddFooter.center.text.startswith("printed: the first ")
    assert not small["Substations"].print_area


def test_a_run_without_voltage_has_neither_histogram_nor_worst_train(case, write):
    results, scenario = case
    rows = results._source["trains"]
    number = rows.schema.get_field_index("voltage_v")
    dead = rows.set_column(number, rows.schema.field(number), pa.array(np.zeros(rows.num_rows), rows.schema.field(number).type))
    book = write(Results(results.run, results.key_figures, dict(results._source) | {"trains": dead}), scenario)
    assert {"Voltage histogram", "Extract worst train"}.isdisjoint(book.sheetnames)
    assert "Extract trains" in book.sheetnames

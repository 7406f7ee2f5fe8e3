import numpy as np
import pandas as pd
import pytest
from read_workbook import read_table

from tractionpower.reporting.workbook.run.extracts import ALL_POINTS, MOST_POINTS, MOST_TRAINS, chosen, period_of


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


def test_load_curves_are_the_means_of_the_table(small, case):
    frame = case[0].table("substations")
    slot = (frame["time_s"] // 60 * 60).rename("slot")
    means = frame.groupby([slot, "substation"], observed=True)["power_kw"].mean().unstack()
    rows = pd.DataFrame(read_table(small["Extract loads"]))
    assert np.abs(rows["time of day"] - means.index.to_numpy()).max() < 1e-3
    for name in means:
        assert np.allclose(rows[f"{name} [kW]"], means[name], rtol=1e-6)


def test_load_duration_falls_from_the_highest_to_the_lowest(small, case):
    frame = case[0].table("substations")
    rows = pd.DataFrame(read_table(small["Load duration"]))
    power = frame.loc[frame["substation"] == "Substation 2", "power_kw"]
    column = rows["Substation 2 [kW]"]
    assert (column.iloc[0], column.iloc[-1]) == pytest.approx((power.max(), power.min()))
    assert (column.diff().dropna() <= 0.0).all()
    assert (power >= column.iloc[25]).mean() == pytest.approx(0.25, abs=0.002)


def test_the_profile_is_the_table(small, case):
    frame = case[0].table("profile")
    rows = pd.DataFrame(read_table(small["Voltage profile"]))
    assert len(rows) == len(frame)
    assert rows["lowest voltage [V]"].sum() == pytest.approx(frame["lowest_voltage_v"].sum())
    assert rows["U_min2 [V]"].unique().tolist() == [2000]

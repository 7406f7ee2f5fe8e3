import pytest
from read_workbook import read_table


def rows_of(rich, name):
    rows = rich.results.table("trains")
    return rows[rows["train"] == name]


@pytest.mark.parametrize("name", ["E1", "E2", "=M1"])
def test_voltages_are_those_of_the_rows(rich, name):
    (row,) = [row for row in read_table(rich.values["Voltages"]) if row["train"] == name]
    own = rows_of(rich, name)
    volts, amps = own["voltage_v"].astype(float), own["current_a"].astype(float).abs()
    worst = own.loc[own["voltage_v"].idxmin()]
    assert row["lowest voltage [V]"] == pytest.approx(volts.min(), rel=1e-6)
    assert row["above U_min2 by [V]"] == pytest.approx(volts.min() - 2000.0, rel=1e-5)
    assert (row["time of the lowest"], row["track"]) == (worst["time_s"], worst["track"])
    assert row["place [km]"] == pytest.approx(worst["position_km"], abs=1e-6)
    assert row["highest voltage [V]"] == pytest.approx(volts.max(), rel=1e-6)
    assert row["mean voltage [V]"] == pytest.approx(volts.mean(), rel=1e-6)
    assert row["mean useful voltage, current-weighted [V]"] == pytest.approx((volts * amps).sum() / amps.sum(), rel=1e-6)
    pulling = volts[own["tractive_force_kn"] > 0.0]
    assert row["mean useful voltage, time mean [V]"] == pytest.approx(pulling.mean(), rel=1e-6)


def test_mean_useful_voltages_are_formulas_that_equal_the_key_figures(rich):
    sums = ("sum U |I| dt [kWh]", "sum |I| dt [Ah]")
    for row, formulas in zip(read_table(rich.values["Voltages"]), read_table(rich.formulas["Voltages"]), strict=True):
        place = f"train {row['train']}"
        energy, charge = (row[heading] for heading in sums)
        weighted = rich.figure("mean_useful_voltage_current_weighted_v", place)
        assert 1000.0 * energy / charge == pytest.approx(weighted, rel=1e-9)
        assert formulas["mean useful voltage, current-weighted [V]"].startswith("=1000*K")
        assert formulas["mean useful voltage, time mean [V]"].startswith("=N")


def test_acceptance_finds_its_values_on_this_sheet(rich):
    found = {row["what is judged"]: row["found"] for row in read_table(rich.formulas["Acceptance"])}
    assert found["mean useful voltage of trains, current-weighted"] == "=MIN(train_voltages_weighted)"
    assert found["mean useful voltage of zones, time mean"] == "=MIN(zone_voltages_plain)"
    assert found["lowest voltage"] in ("=MIN(train_voltages_lowest)", "=kf_lowest_voltage_v")
    assert found["longest spell above U_max1"] == "=kf_longest_spell_above_u_max1_s"


def test_voltages_are_coloured_by_the_limits_that_can_be_edited(rich):
    rules = [rule.formula[0] for area in rich.formulas["Voltages"].conditional_formatting for rule in area.rules]
    for name in ("u_min2", "u_useful"):
        assert any(f"ISNUMBER(limit_{name})" in rule and f"<limit_{name}-N(tolerance_{name})" in rule for rule in rules)
    assert not any("3000" in rule for rule in rules), "a voltage below the nominal one is nothing to warn of"


def test_the_place_of_another_time_is_left_out(rich, write):
    trains = [train | {"lowest_voltage_s": -1.0} for train in rich.results.run["trains"]]
    book = write(type(rich.results)(rich.results.run | {"trains": trains}, rich.results.key_figures, {}), rich.scenario)
    assert {row["place [km]"] for row in read_table(book["Voltages"])} == {None}

import pytest
from fake_results import LEDGERS
from openpyxl import load_workbook
from read_workbook import read_table


def sums(sheet):
    return [row[1] for row in sheet.iter_rows(values_only=True) if row[0] in ("sum given", "sum spent", "gap")]


def test_sums_and_gaps_are_live(small, small_values):
    electric, pantograph, mechanical = LEDGERS["electric"], LEDGERS["pantograph_to_wheel"], LEDGERS["mechanical"]
    expected = [
        electric["source_kwh"], 100.0 + 1600.0 + 200.0 + 100.125, 0.0,
        pantograph["line_kwh"] + pantograph["recovered_kwh"], 1300.0 + 250.0 + 30.0 + 120.0, 0.0,
        mechanical["wheel_kwh"], 100.0 + 50.0 + 850.0 + 300.0, 0.0,
    ]  # fmt: skip
    assert {formula[:7] for formula in sums(small["Energy"])} == {"=SUMIF(", "=ROUND("}
    assert sums(small_values["Energy"]) == pytest.approx(expected, abs=1e-9)


def test_a_ledger_without_trains_needs_no_trains(case, write, tmp_path):
    results, scenario = case
    ledger = {key: value for key, value in LEDGERS["electric"].items() if key != "train_kwh"} | {"load_kwh": 1800.0}
    run = results.run | {"ledgers": {"electric": ledger}}
    write(type(results)(run, results.key_figures, results._source), scenario)
    sheet = load_workbook(tmp_path / "report.xlsx", data_only=True)["Energy"]
    assert sums(sheet) == pytest.approx([2000.125, 2000.125, 0.0], abs=1e-9)


def balance(rich):
    return {row["what"]: row["energy [kWh]"] for row in read_table(rich.values["Energy"])}


def test_the_balance_is_that_of_the_tables(rich):
    told, tables = balance(rich), {name: rich.results.table(name) for name in ("substations", "trains", "feeders")}
    busbars = tables["substations"]["power_kw"].astype(float).sum() / 3600.0
    power = tables["trains"]["power_kw"].astype(float) / 3600.0
    heat = 0.02 * (tables["feeders"]["current_a"].astype(float) ** 2).sum() / 3.6e6
    assert told["substations, at the busbars"] == pytest.approx(busbars, rel=1e-5)
    assert told["heat in feeders that have a resistance"] == pytest.approx(heat, rel=1e-5)
    assert told["trains, taken from the line"] == pytest.approx(power.clip(lower=0.0).sum(), rel=1e-5)
    assert told["fixed loads"] == pytest.approx(150.0, rel=1e-5)
    lines = busbars - heat - power.sum() - 150.0
    assert told["heat in contact lines and return circuit"] == pytest.approx(lines, rel=1e-3)
    assert told["does not add up"] == pytest.approx(0.0, abs=1e-3)


def test_the_regulation_of_substations_is_that_of_the_table(rich):
    rows, regulation = read_table(rich.values["Energy"], 2), rich.results.table("substations")
    for row in rows:
        own = regulation[regulation["substation"] == row["substation"]]
        assert row["regulation [kWh]"] == pytest.approx(own["regulation_kw"].astype(float).sum() / 3600.0, rel=1e-5)
        assert row["of it heat in copper and diodes [kWh]"] == pytest.approx(
            own["loss_kw"].astype(float).sum() / 3600.0, rel=1e-5
        )


def test_categories_are_told_apart_by_their_letters(rich):
    rows = {row["category of trains"]: row for row in read_table(rich.values["Energy"], 3)}
    assert set(rows) == {"express", "Express", "–"}
    for category, train in (("express", "E1"), ("Express", "E2"), ("–", "=M1")):
        assert rows[category]["taken [kWh]"] == pytest.approx(rich.figure("energy_taken_kwh", f"train {train}"), rel=1e-12)
        assert rows[category]["trains"] == 1
    assert sum(row["net of all [%]"] for row in rows.values()) == pytest.approx(100.0)

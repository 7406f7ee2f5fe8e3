"""The workbook of a study of outages, read back."""

import pytest
from fake_results import make_case
from fake_sizing import outages, table
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.workbook import write_workbook
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def study():
    scenario = make_case(substations=9)[1]
    return outages(scenario), scenario


@pytest.fixture(scope="module")
def book(study, tmp_path_factory):
    return load_workbook(write_workbook(*study, tmp_path_factory.mktemp("outages") / "report.xlsx"))


def test_the_sheets(book):
    assert book.sheetnames[:7] == [
        "Cover", "Acceptance", "Outages", "All cases", "Device envelope", "Envelope", "Delays in outages",
    ]  # fmt: skip
    assert "Inputs limits" in book.sheetnames


def test_the_cover_says_how_many_fail_and_by_which_outage(book, study):
    seen = Outages(*study)
    groups = [cases for first, cases in seen.groups() if first["kind"] != "base"]
    failing = sum(any(seen.failures(case) for case in cases.values()) for cases in groups)
    said = texts(book["Cover"])
    assert f"{failing} of {len(groups)} outages fail" in said
    assert any(text.startswith("With nothing out, normal grid voltage: holds.") for text in said)
    worst = min((c for c in seen.by_id.values() if c["useful_zone_v"]), key=lambda case: case["useful_zone_v"])
    assert any(text.startswith(f"{seen.told(worst['case'])}: {worst['useful_zone_v']:.0f} V (zone A - B)") for text in said)
    assert any("failed: RuntimeError: the worker process died twice" in text for text in said)
    assert any("refused: supply.substations[X]: a contradiction another one" in text for text in said)
    assert any("an editable value, not verified" in text for text in said)


def test_a_row_for_each_outage_with_the_grid_voltages_beside_each_other(book, study):
    seen = Outages(*study)
    rows = {row["what is out"]: row for row in read_table(book["Outages"])}
    groups = {first["words"]: cases for first, cases in seen.groups()}
    assert set(rows) == set(groups)
    for words, cases in groups.items():
        for grid, case in cases.items():
            expected = case["lowest_voltage_v"]
            found = rows[words][f"lowest voltage [V], {grid} grid"]
            assert found == (None if expected is None else pytest.approx(expected))
        assert rows[words]["holds"] == ("no" if any(seen.failures(case) for case in cases.values()) else "yes")
    assert "low voltage (low)" in rows["Substation 9, bypassed"]["why, and at which grid voltage"]


def test_all_cases_are_told_with_their_reasons(book, study):
    rows = read_table(book["All cases"])
    known = study[0].table("cases").set_index("case")
    assert len(rows) == len(known)
    for row in rows:
        assert row["status"] == known.loc[row["case"], "status"]
        if row["status"] in ("failed", "refused"):
            assert (row["late trains"], row["lowest voltage [V]"]) == (None, None)
            assert row["reason"]


def test_the_device_envelope_names_the_outage(book, study):
    seen = Outages(*study)
    rows = {row["device"]: row for row in read_table(book["Device envelope"])}
    for row in seen.table("device_envelope").to_dict("records"):
        shown = rows[row["device"]]
        if row["kind"] == "rails":
            assert (shown["holds"], shown["worst case"]) == ("not rated", None)
            continue
        assert shown["worst case"] == seen.told(row["case"])
        assert shown["utilisation in the worst case [%]"] == pytest.approx(row["utilisation_percent"])


def test_envelopes_have_a_chart_for_each_track_and_the_rails(book, study):
    assert len(book["Envelope"]._charts) == 3
    envelope = study[0].table("envelope")
    own = envelope[(envelope["track"] == "1") & (envelope["quantity"] == "voltage")].sort_values("km")
    rows = read_table(book["Envelope"])
    assert [row["worst of all cases [V]"] for row in rows] == pytest.approx(list(own["worst_v"]))


def test_delays_tell_each_train_that_loses(book, study):
    seen = Outages(*study)
    trains = seen.table("case_trains")
    late = trains[trains["added_late_s"] > seen.tolerance_s]
    assert len(read_table(book["Delays in outages"], 2)) == len(late)
    sums = read_table(book["Delays in outages"], 1)
    assert [row["added, at most [s]"] for row in sums] == sorted((row["added, at most [s]"] for row in sums), reverse=True)


def of_cases(full, rows):
    """Return results with other cases."""
    return Results(full.run, [], dict(full._source) | {"cases": table("cases", rows)}, full.scenario)


def test_a_study_without_ratings_has_no_empty_columns(write):
    scenario = make_case()[1]
    full = outages(scenario, grids=("normal",))
    assert "highest utilisation [%]" in read_table(write(full, scenario)["Outages"])[0]
    rows = [
        row | {"utilisation_percent": float("nan"), "utilisation_device": ""} for row in full.table("cases").to_dict("records")
    ]
    assert "highest utilisation [%]" not in read_table(write(of_cases(full, rows), scenario)["Outages"])[0]


def test_where_every_outage_holds_it_says_so(write):
    scenario = make_case()[1]
    full = outages(scenario, grids=("normal",))
    rows = [row for row in full.table("cases").to_dict("records") if row["kind"] in ("base", "section_cabin")]
    assert "The one outage holds" in texts(write(of_cases(full, rows), scenario)["Cover"])
    assert "No outage was looked at" in texts(write(of_cases(full, rows[:1]), scenario)["Cover"])

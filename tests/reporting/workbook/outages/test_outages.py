"""The workbook of a study of outages, read back."""

import pytest
from fake_results import make_case
from fake_sizing import outages, table
from office import needs_office, recalculated
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
def file(study, tmp_path_factory):
    return write_workbook(*study, tmp_path_factory.mktemp("outages") / "report.xlsx")


@pytest.fixture(scope="module")
def formulas(file):
    return load_workbook(file)


@pytest.fixture(scope="module")
def book(file):
    """Return the workbook with the values that its formulas come to."""
    return load_workbook(file, data_only=True)


def test_the_sheets(book):
    assert book.sheetnames[:11] == [
        "Cover", "Acceptance", "Outages", "Outage heat map", "Outage voltages", "Outage loads", "Outage trains", "What fails",
        "Device envelope", "Envelope", "Delays in outages",
    ]  # fmt: skip
    assert "Inputs limits" in book.sheetnames


def test_the_cover_says_how_many_fail_and_by_which_outage(book, study):
    seen = Outages(*study)
    groups = [cases for first, cases in seen.groups() if first["kind"] != "base"]
    failing = sum(any(seen.failures(case) for case in cases.values()) for cases in groups)
    said = texts(book["Cover"])
    worse = sum(any(map(seen.is_worse, cases.values())) for cases in groups)
    headline = f"{failing} of {len(groups)} outages fail, {worse} of them at something that holds with nothing out"
    assert headline in texts(book["Outages"])
    assert headline in said
    assert any(text.startswith("With nothing out, normal grid voltage: holds.") for text in said)
    worst = min((c for c in seen.by_id.values() if c["useful_zone_v"]), key=lambda case: case["useful_zone_v"])
    told = f"worst: {worst['words']}, {worst['grid']} grid voltage: {worst['useful_zone_v']:.0f} V (zone A - B), below 2700 V"
    assert any(text.endswith(told) for text in said)
    assert any("failed: RuntimeError: the worker process died twice" in text for text in said)
    assert any("refused: supply.substations[X]: a contradiction another one" in text for text in said)


def test_a_row_for_each_outage_with_the_grid_voltages_beside_each_other(book, study):
    seen = Outages(*study)
    rows = {row["what is out"]: row for row in read_table(book["Outages"])}
    groups = {first["words"]: cases for first, cases in seen.groups()}
    assert set(rows) == set(groups)
    for words, cases in groups.items():
        for grid, case in cases.items():
            expected = case["lowest_voltage_v"]
            found = rows[words][f"lowest voltage, {grid} grid [V]"]
            assert found == (None if expected is None else pytest.approx(expected))
        known = [case["utilisation_percent"] for case in cases.values() if case["utilisation_percent"] is not None]
        assert rows[words]["highest utilisation [%]"] == pytest.approx(max(known))
        assert rows[words]["holds"] == ("no" if any(seen.failures(case) for case in cases.values()) else "yes")
        told = rows[words]["at more than with nothing out"]
        assert told == (None if cases["normal"]["kind"] == "base" else "yes" if any(map(seen.is_worse, cases.values())) else "no")
    assert "; low: low voltage, " in rows["Substation 9, bypassed"]["why, and at which grid voltage"]


def test_every_case_is_judged_on_the_sheet_of_its_figures(book, study):
    seen = Outages(*study)
    judged = {"Outage voltages": "_v", "Outage loads": "_percent"}
    for sheet, end in judged.items():
        rows = read_table(book[sheet])
        assert len(rows) == len(seen.by_id)
        for shown, case in zip(rows, seen.by_id.values(), strict=True):
            if case["status"] not in ("complete", "flagged"):
                assert shown["holds"] == "not computed"
                continue
            checks = [
                check for check in seen.checks if check.figure.endswith(end) or (end == "_percent" and check.figure == "trips")
            ]
            assert shown["holds"] == ("yes" if all(check.is_met(case) for check in checks) else "no")


def test_changes_are_those_from_nothing_out_at_the_same_grid_voltage(book, formulas, study):
    seen = Outages(*study)
    base = {case["grid"]: case for case in seen.by_id.values() if case["kind"] == "base"}
    shown = read_table(book["Outage voltages"])
    for row, formula, case in zip(shown, read_table(formulas["Outage voltages"]), seen.by_id.values(), strict=True):
        if case["kind"] == "base" or case["lowest_voltage_v"] is None:
            assert row["lowest: change [V]"] is None
            continue
        expected = case["lowest_voltage_v"] - base[case["grid"]]["lowest_voltage_v"]
        assert row["lowest: change [V]"] == pytest.approx(expected)
        assert "INDEX(cases_lowest_voltage_v," in formula["lowest: change [V]"]


def test_all_cases_are_told_with_their_reasons(book, study):
    rows = read_table(book["What fails"])
    known = study[0].table("cases").set_index("case")
    assert len(rows) == len(known)
    figures = read_table(book["Outage voltages"])
    for row, figure in zip(rows, figures, strict=True):
        assert row["status"] == known.loc[row["case"], "status"]
        if row["status"] in ("failed", "refused"):
            assert figure["lowest voltage [V]"] is None
            assert row["reason"]


def test_the_heat_map_has_the_worst_of_all_grid_voltages(book, study):
    seen = Outages(*study)
    table = study[0].table("case_devices")
    words = {case: row["words"] for case, row in seen.by_id.items()}
    worst = table.assign(what=table["case"].map(words)).groupby(["device", "what"], observed=True)["utilisation_percent"].max()
    rows = read_table(book["Outage heat map"])
    assert rows
    for row in rows:
        found = {what: value for what, value in row.items() if what not in ("device", "kind", "highest [%]")}
        assert row["highest [%]"] == pytest.approx(max(value for value in found.values() if value is not None))
        for what, value in found.items():
            assert value == pytest.approx(worst[row["device"], what])


def test_acceptance_has_the_worst_case_of_each_limit(book, study):
    rows = {row["what is judged"]: row for row in read_table(book["Acceptance"])}
    lowest = study[0].table("cases")["lowest_voltage_v"].min()
    assert rows["lowest voltage"]["found"] == pytest.approx(lowest)
    assert rows["lowest voltage"]["verdict"] == ("met" if lowest >= 1999.9 else "violated")


@needs_office
def test_verdicts_follow_an_edited_limit(file, study, tmp_path):
    seen = Outages(*study)
    limit = 2600.0
    edited = load_workbook(file)
    sheet, cell = next(edited.defined_names["limit_u_min2"].destinations)
    edited[sheet][cell] = limit
    edited.save(tmp_path / "edited.xlsx")
    (copy,) = recalculated([tmp_path / "edited.xlsx"])
    book = load_workbook(copy, data_only=True)
    values = {row[0].value: row[2].value for row in book["Outages"].iter_rows() if row[2].value in ("yes", "no")}
    groups = {first["words"]: cases for first, cases in seen.groups()}
    assert set(values) == set(groups)
    turned = 0
    for words, cases in groups.items():
        low = any(case["lowest_voltage_v"] is not None and case["lowest_voltage_v"] < limit - 0.1 for case in cases.values())
        fails = low or any(seen.failures(case) for case in cases.values())
        turned += fails and not any(seen.failures(case) for case in cases.values())
        assert values[words] == ("no" if fails else "yes")
    assert turned > 0


@needs_office
def test_nothing_fails_any_more_when_every_limit_is_wide_open(file, study, tmp_path):
    seen = Outages(*study)
    edited = load_workbook(file)
    floors = {check.limit for check in seen.checks if check.is_floor}
    for name in edited.defined_names:
        limit = name.removeprefix("case_").removeprefix("limit_")
        if name.endswith(f"limit_{limit}"):  # on sheet Acceptance, or on that of the cases where the run told no verdict
            ((sheet, cell),) = edited.defined_names[name].destinations
            place = edited[sheet][cell.replace("$", "")]
            if not isinstance(place.value, str):
                place.value = 0.0 if limit in floors else 1e6
    edited.save(tmp_path / "open.xlsx")
    book = load_workbook(recalculated([tmp_path / "open.xlsx"])[0], data_only=True)
    computed = [case for case in seen.by_id.values() if case["status"] in ("complete", "flagged")]
    judged = [figure for figure in ("lowest_voltage_v", "useful_zone_v", "utilisation_percent", "worst_late_s", "trips")]
    assert len({check.figure for check in seen.checks} & set(judged)) == len(judged)
    rows = [row for row in read_table(book["What fails"]) if row["status"] in ("complete", "flagged")]
    assert len(rows) == len(computed)
    assert {(row["fails at"] or "", row["how it stands"] or "") for row in rows} == {("", "")}
    for name in ("Outage voltages", "Outage loads", "Outage trains"):
        assert {row["holds"] for row in read_table(book[name])} <= {"yes", "not computed"}
    groups = [cases for first, cases in seen.groups() if first["kind"] != "base"]
    left = sum(any(case["status"] not in ("complete", "flagged") for case in cases.values()) for cases in groups)
    said = texts(book["Cover"])
    assert any(text.startswith(f"{left} of {len(groups)} outages fail") for text in said)
    assert any(text.startswith("With nothing out, normal grid voltage: holds.") for text in said)
    assert not any("worst:" in text for text in said)


def test_without_ratings_the_heat_map_shows_currents_of_those_with_nothing_out(study, write_values):
    full, scenario = study
    rows = full.table("case_devices").assign(utilisation_percent=float("nan"))
    sources = dict(full._source) | {"case_devices": table("case_devices", rows.to_dict("records"))}
    book = write_values(Results(full.run, [], sources, scenario), scenario)
    seen = Outages(*study)
    peaks = rows.set_index(["device", "case"])["peak_a"]
    for row in read_table(book["Outage heat map"]):
        for first, cases in seen.groups():
            if first["kind"] != "base" and first["words"] in row:
                own = [
                    100.0 * peaks[row["device"], case["case"]] / peaks[row["device"], base["case"]]
                    for case in cases.values()
                    for base in seen.by_id.values()
                    if base["kind"] == "base" and base["grid"] == case["grid"] and (row["device"], case["case"]) in peaks
                ]
                assert row[first["words"]] == pytest.approx(max(own))


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
        assert shown["change"] == pytest.approx(row["utilisation_percent"] - row["base_percent"], abs=1e-3)


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


def test_where_every_outage_holds_it_says_so(write_values):
    scenario = make_case()[1]
    full = outages(scenario, grids=("normal",))
    rows = [row for row in full.table("cases").to_dict("records") if row["kind"] in ("base", "section_cabin")]
    assert "0 of 1 outages fail" in texts(write_values(of_cases(full, rows), scenario)["Cover"])
    assert "No outage was looked at" in texts(write_values(of_cases(full, rows[:1]), scenario)["Cover"])


@pytest.fixture
def write_values(tmp_path):
    """Return a function that writes results and reads the values of the workbook back."""
    return lambda results, scenario: load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"), data_only=True)

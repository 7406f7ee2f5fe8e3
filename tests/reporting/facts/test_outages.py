"""Outages as reports see them, on tables made by hand."""

import numpy as np
import pytest
from fake_results import make_case
from fake_sizing import outages
from openpyxl import load_workbook

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.reports import write_reports
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def scenario():
    return make_case()[1]


@pytest.fixture(scope="module")
def seen(scenario):
    return Outages(outages(scenario), scenario)


def test_cases_stand_by_kind_along_the_line_by_grid(seen):
    cases = seen.cases
    assert list(dict.fromkeys(cases["kind"])) == ["base", "unit", "substation", "feeder", "section_cabin"]
    for _, own in cases.groupby("kind"):
        assert own["at_km"].dropna().is_monotonic_increasing
    assert list(cases["grid"][:6]) == ["normal", "low", "high"] * 2
    assert seen.grids == ["normal", "low", "high"]


@pytest.mark.parametrize(
    ("kind", "subject", "mode", "words"),
    [
        ("base", "", "", "nothing is out"),
        ("unit", "A unit", "1 of 2", "A, 1 of 2 units"),
        ("unit", "A unit", "rectifiers_out", "A, only unit out"),
        ("unit", "A unit", "1 of 2, reserve after 60 s", "A, 1 of 2 units, reserve after 60 s"),
        ("substation", "A", "rectifiers_out", "substation A, rectifiers out"),
        ("section_cabin", "cabin 10.8", "bypassed", "cabin 10.8, bypassed"),
        ("contact_line", "track 1 km 0-10.8", "dead", "contact line track 1 km 0-10.8"),
        ("pair", "A unit + B", "1 of 2 + bypassed", "A, 1 of 2 units and B, bypassed"),
    ],
)
def test_what_is_out_in_words(seen, kind, subject, mode, words):
    assert seen.words({"kind": kind, "subject": subject, "mode": mode, "case": "x"}) == words


def test_places_of_what_is_out(seen):
    assert seen.place("Substation 2") == 20.0
    assert seen.place("Substation 2 1 low_km") == 20.0
    assert seen.place("Substation 2 unit + C") == 20.0
    assert seen.place("track 1 km 5-10.5") == 7.75
    assert np.isnan(seen.place("something"))


def test_a_case_fails_where_a_figure_passes_its_limit(seen):
    case = dict(seen.by_id["base"])
    assert seen.failures(case) == []
    case |= {"lowest_voltage_v": 1990.0, "highest_voltage_v": 3950.0, "useful_train_v": 2690.0, "worst_late_s": 61.0}
    case |= {"utilisation_percent": 100.4, "utilisation_device": "A unit", "useful_zone_v": None}
    assert [(each.short, each.words) for each in seen.failures(case)] == [
        ("low voltage", "1990 V, below 2000 V"),
        ("high voltage", "3950 V, above 3900 V"),
        ("useful voltage", "2690 V (train 1), below 2700 V"),
        ("overload", "100.4 % (A unit), above 100 %"),
        ("late trains", "61 s (train 1), above 1 s"),
    ]
    assert seen.failures(case | {"status": "failed", "reason": "it\nbroke"})[0].words == "failed: it broke"


def test_an_outage_is_worse_where_the_base_holds(seen):
    assert seen.is_worse(seen.by_id["Substation 3 bypassed, grid low"])
    assert not seen.is_worse(seen.by_id["base, grid low"])
    failing = seen.failing()
    volts = [seen.by_id[case]["lowest_voltage_v"] for case, _ in failing["lowest voltage"]] if "lowest voltage" in failing else []
    assert volts == sorted(volts)
    useful = [seen.by_id[case]["useful_train_v"] for case, _ in failing["mean useful voltage of trains, current-weighted"]]
    assert useful == sorted(useful)
    assert max(useful) < 2700.0


def test_added_delay_is_the_greatest_of_all_trains(seen):
    rows = seen.table("case_trains")
    for case, (seconds, train) in seen.added_s.items():
        own = rows[rows["case"] == case]
        assert seconds == pytest.approx(own["added_late_s"].max())
        assert own.loc[own["train"] == train, "added_late_s"].iloc[0] == pytest.approx(seconds)


def test_without_cases_nothing_is_told(scenario: Scenario):
    empty = Outages(Results({}, [], {}, scenario), scenario)
    assert (list(empty.groups()), empty.grids, empty.added_s, empty.failing()) == ([], [], {}, {})
    assert empty.told("some case") == "some case"


def test_reports_of_a_folder_of_outages_are_chosen_by_its_kind(scenario, tmp_path):
    full = outages(scenario, grids=("normal",), feeders=False)
    paths = write_reports(full, scenario, tmp_path)
    assert {"envelope_voltage.png", "report.xlsx"} <= {path.name for path in paths}
    assert "Outages" in load_workbook(tmp_path / "report.xlsx", read_only=True).sheetnames
    assert not (tmp_path / "figures" / "voltage_along_line.png").exists()

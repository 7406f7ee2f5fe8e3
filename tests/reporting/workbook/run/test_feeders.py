"""The sheet of feeders and switches, and what events do to substations."""

import pytest
from openpyxl import load_workbook
from read_workbook import exactly, read_table
from small_studies import load, make_scenario, run_in_memory

from tractionpower.reporting.workbook import write_workbook

TRIPS = "A 1 high_km"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    scenario = make_scenario(
        load("heavy", 3.0, power_kw=8000.0),
        clock={"end": 20.0},
        feeders=[{"at": "A", "track": "1", "side": "high_km", "trip_current_a": 1500.0}],
        switch_events=[
            {"time": "00:00:12", "device": "B", "state": "rectifiers_out"},
            {"time": "00:00:15", "device": "B", "state": "in_service"},
        ],
    )
    results, *_ = run_in_memory(scenario)
    return results, load_workbook(write_workbook(results, scenario, tmp_path_factory.mktemp("feeders") / "report.xlsx"))


def test_every_feeder_has_its_figures_and_settings(made):
    results, book = made
    rows = {row["feeder or switch"]: row for row in read_table(book["Feeders"])}
    assert [f"feeder {name}" for name in rows] == [each["place"] for each in results.run["links"]]
    for name, row in rows.items():
        assert row["highest current [A]"] == exactly(results.key_figure("highest_current_a", f"feeder {name}"))
        assert row["RMS current of the run [A]"] == exactly(results.key_figure("rms_current_a", f"feeder {name}"))
        assert row["closed [% of the time]"] == exactly(results.key_figure("time_closed_percent", f"feeder {name}"))
    assert (rows[TRIPS]["trips above [A]"], rows[TRIPS]["trips"], rows[TRIPS]["normal state"]) == (1500, 1, "closed")
    assert rows["C 1 low_km"]["kind"] == "feeder of a section cabin"
    assert rows["C 1 low_km"]["trips above [A]"] is None


def test_the_share_of_the_setting_and_the_heat(rich):
    rows = read_table(rich.values["Feeders"])
    (row,) = [row for row in rows if row["feeder or switch"] == "A 1 high_km"]
    currents = rich.results.table("feeders").query("substation == 'A' and track == '1' and side == 'high_km'")["current_a"]
    currents = currents.astype(float)
    assert row["highest of the setting [%]"] == pytest.approx(100.0 * currents.abs().max() / 2500.0, rel=1e-6)
    assert row["heat [kWh]"] == pytest.approx(0.02 * (currents**2).sum() / 3.6e6, rel=1e-5)


def test_substations_tell_their_normal_state_and_what_events_do(made):
    rows = {row["substation"]: row for row in read_table(made[1]["Substations"], 1)}
    plants = {row["substation"]: row for row in read_table(made[1]["Substations"], 2)}
    assert {row["normal state"] for row in rows.values()} == {"in service"}
    assert plants["B"]["out by events"] == "00:00:12 rectifiers out; 00:00:15 in service"
    assert not plants["A"]["out by events"]


def test_without_links_there_is_no_sheet(small):
    assert "Feeders" not in small.sheetnames
    assert "out by events" not in read_table(small["Substations"], 2)[0]

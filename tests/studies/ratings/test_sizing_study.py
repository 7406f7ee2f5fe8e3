"""A study of ratings as a whole: verdicts on hand-worked loads, tables, key figures, what nobody has rated."""

import json

import numpy as np
import pytest
from coupled import couple, run
from small_studies import load, make_scenario, station

import tractionpower as tp
from tractionpower.model.ratings import DutyRow
from tractionpower.model.sizing import Sizing
from tractionpower.results.columns import TABLES
from tractionpower.results.sizing_columns import SIZING_TABLES
from tractionpower.studies.ratings.study import size

FULL_RUN = {"clock": {"start": 0.0, "end": 1800.0, "step_s": 1.0, "warm_up": 900.0}}
OF_SIZE = ("ratings", "peaks", "breakers", "load_duration", "demand", "useful_voltage", "voltage_durations")
DUTY = tuple(
    DutyRow(duty_class="T", window_s=window_s, multiple=multiple)
    for window_s, multiple in ((0.0, 1.0), (60.0, 2.0), (7200.0, 1.5))
)


def one_substation(rated_a, **more):
    """Return one substation that feeds 1200 A into a load of constant current."""
    plant = station("A", 0.0, units=2, rated_current_a=rated_a, duty_class="T", **more)
    scenario = make_scenario(load("L", 5.0, current_a=1200.0), substations=[plant], section_cabins=[], tracks=("1",), **FULL_RUN)
    return scenario.model_copy(update={"duty_classes": DUTY})


def test_a_constant_load_uses_the_rating_that_it_must():
    """Each of two units carries 600 A. Rated 800 A: 75 % over the whole run, 37.5 % in a minute."""
    results = size(one_substation(800.0))
    told = results.run["size"]
    assert (results.run["kind"], told["verdict"], told["failing"]) == ("size", "pass", [])
    unit = next(row for row in told["worst"] if row["kind"] == "unit")
    assert (unit["device"], unit["window_s"]) == ("A unit", 0.0)
    assert unit["utilisation_percent"] == pytest.approx(75.0)
    assert unit["left_a"] == pytest.approx(200.0)
    rows = results.table("ratings")
    minute = rows[(rows["device"] == "A unit") & (rows["window_s"] == 60.0)].iloc[0]
    assert minute["utilisation_percent"] == pytest.approx(37.5)
    assert not minute["ruling"]
    assert results.key_figure("utilisation_percent", "A unit") == pytest.approx(75.0)
    (verdict,) = (verdict for verdict in results.run["verdicts"] if verdict["name"] == "utilisation of rectifier units")
    assert (verdict["met"], verdict["limit_value"], verdict["status"]) == (True, 100.0, "user")
    assert any("7200" not in note and "2 h" in note for note in told["notes"])  # longer than the run
    assert {kind: len(ids) for kind, ids in told["unrated"].items()} == {
        "feeder": 1,
        "return_feeder": 1,
        "contact_line": 1,
        "rails": 1,
    }


def test_what_is_beyond_its_rating_fails_and_a_wider_bound_lets_it_pass():
    scenario = one_substation(500.0)
    assert size(scenario).run["size"]["verdict"] == "fail"
    assert set(size(scenario).run["size"]["failing"]) == {"A", "A unit"}
    wider = scenario.model_copy(update={"sizing": Sizing(utilisation_percent=121.0)})
    assert size(wider).run["size"]["verdict"] == "pass"


def test_a_unit_out_loads_the_other_one():
    told = size(one_substation(800.0, units_in_service=1)).run["size"]
    unit = next(row for row in told["worst"] if row["kind"] == "unit")
    assert unit["utilisation_percent"] == pytest.approx(150.0)
    assert told["verdict"] == "fail"


def test_breakers_and_contracts_have_their_verdicts():
    """1200 A of a setting of 1500 A; 1200 A at 3456 V are 4147.2 kW in the second quarter of an hour."""
    results = size(one_substation(800.0, trip_current_a=1500.0, contract_power_kw=4100.0))
    told = results.run["size"]
    assert told["breakers"]["worst"]["share_percent"] == pytest.approx(80.0, rel=1e-3)
    (demand,) = told["demand"]
    assert demand["power_kw"] == pytest.approx(1200.0 * (3600.0 - 1200.0 * 0.12) / 1000.0)
    assert demand["from_s"] == 900.0
    assert (told["verdict"], told["failing_contracts"], told["failing"]) == ("fail", ["A"], [])
    assert results.key_figure("highest_demand_kw", "supply point A") == pytest.approx(demand["power_kw"])
    stricter = one_substation(800.0, trip_current_a=1500.0).model_copy(update={"sizing": Sizing(breaker_percent=75.0)})
    assert size(stricter).run["size"]["failing_breakers"] == ["A 1 high_km"]


def test_without_ratings_nothing_is_judged():
    told = size(make_scenario(load("L"), clock={"end": 30.0})).run["size"]
    assert (told["verdict"], told["rated"], told["worst"]) == ("not rated", 0, [])
    assert told["useful_voltage"]["lowest"] == []  # no trains


@pytest.fixture(scope="module")
def of_trains(tmp_path_factory):
    plants = [station(name, km, rated_current_a=2000.0) for name, km in (("A", 0.0), ("B", 20.0))]
    scenario = couple(run("E"), run("F", "series_motors", track="2", low=20.0, high=0.0), substations=plants, end_s=900.0)
    folder = tmp_path_factory.mktemp("size") / "out"
    return scenario, size(scenario, folder), size(scenario)


def test_all_tables_are_there_in_memory_and_on_disk_alike(of_trains):
    scenario, disk, memory = of_trains
    assert set(disk.tables) == set(memory.tables)
    assert {*OF_SIZE, "sharing", "trains", "substations", "profile"} <= set(disk.tables)
    assert set(SIZING_TABLES) <= set(TABLES)
    for table in OF_SIZE:
        assert disk.table(table).equals(memory.table(table)), table
    # What the run itself records does not change.
    plain = tp.simulate(scenario)
    assert plain.table("trains").equals(memory.table("trains"))
    names = {figure["name"] for figure in plain.key_figures}
    assert [figure for figure in memory.key_figures if figure["name"] in names] == plain.key_figures


def test_run_json_is_json_and_verdicts_on_zones_are_those_of_the_study(of_trains):
    _, disk, memory = of_trains
    assert json.loads(json.dumps(memory.run["size"], allow_nan=False)) == disk.run["size"]
    zones = [verdict for verdict in disk.run["verdicts"] if verdict["name"].startswith("mean useful voltage of zones")]
    assert [verdict["name"] for verdict in zones] == [
        "mean useful voltage of zones, current-weighted (of trains there for 60 s or more)",
        "mean useful voltage of zones, time mean (of trains there for 60 s or more)",
    ]
    row = disk.table("useful_voltage").iloc[0]
    np.testing.assert_allclose(
        [verdict["value"] for verdict in zones], [row["current_weighted_v"], row["time_mean_v"]], rtol=1e-6
    )
    assert all(verdict["status"] == "recalled" for verdict in zones)


def test_a_scenario_with_errors_leaves_nothing(tmp_path):
    wrong = tp.change(tp.load("two-substations"), ["supply.substations[A].km=-1"])
    for folder in (None, tmp_path / "out"):
        with pytest.raises(tp.InputError):
            size(wrong, folder)
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_keeps_what_was_computed(tmp_path, of_trains):
    def interrupt(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        size(of_trains[0], tmp_path / "out", progress=interrupt)
    partial = tp.Results.open(tmp_path / "out", partial=True)
    assert partial.run["status"] == "interrupted"
    assert len(partial.table("substations"))

"""Breakers, demand, load duration and sharing against the rows of the run."""

import math

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling

from tractionpower.results.columns import TABLES
from tractionpower.studies.ratings.breakers import LEVELS_PERCENT
from tractionpower.studies.ratings.duration import SHARES_PERCENT
from tractionpower.studies.runner.outcomes import rows_table

UNITS = {"no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12}
RUNS = (run("x"), run("y", "series_motors", "2", 20.0, 3.0, time=20.0))


def rows_of(found, name):
    return np.concatenate([getattr(rows, name) for _, rows, _ in found.seen])


def link(found, name):
    tables = found.seen[0][2]
    return rows_of(found, "link_a")[:, [each.id for each in tables.links].index(name)]


def test_every_row_fits_its_table(rated):
    found = rated(RandomCoupling(1, 60).scenario)
    for name, rows in found.tables.items():
        known = {column.name for column in TABLES[name]}
        assert all(set(row) <= known for row in rows), name
        assert rows_table(name, rows).num_rows == len(rows)


# -- breakers ------------------------------------------------------------------------------------------------------


def longest(beyond):
    best = now = 0
    for each in beyond:
        now = now + 1 if each else 0
        best = max(best, now)
    return best


def test_breakers_against_brute_force(rated):
    stations = [{"id": "A", "km": 0.0, "trip_current_a": 4000.0, **UNITS}, {"id": "B", "km": 20.0, **UNITS}]
    cabin = {"id": "C", "km": 10.0, "trip_current_a": 100.0, "trip_delay_s": 1e4}
    found = rated(couple(*RUNS, end_s=200.0, step_s=0.5, substations=stations, section_cabins=[cabin]), {"A 1 high_km": 2})
    rows = {(row["device"], row.get("level_percent")): row for row in found.tables["breakers"]}
    for name, setting in (("A 1 high_km", 4000.0), ("C 1 low_km", 100.0), ("C 2 high_km", 100.0)):
        amps = np.abs(link(found, name))
        for level in LEVELS_PERCENT:
            row, beyond = rows[name, level], amps > setting * level / 100.0
            assert (row["longest_s"], row["total_s"]) == (0.5 * longest(beyond), 0.5 * beyond.sum())
            assert (row["peak_a"], row["setting_a"]) == (amps.max(), setting)
            assert row["share_percent"] == pytest.approx(100.0 * amps.max() / setting)
            assert row["met"] == ("yes" if amps.max() <= setting else "no")
    assert rows["C 1 low_km", 50.0]["total_s"] > 0.0
    assert (rows["A 1 high_km", 50.0]["trips"], rows["C 1 low_km", 50.0]["trips"]) == (2, 0)
    unset = rows["B 1 low_km", None]
    assert math.isnan(unset["setting_a"])
    assert (unset["met"], unset["peak_a"]) == ("", np.abs(link(found, "B 1 low_km")).max())


# -- demand --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("step_s", [1.0, 4.0])
def test_demand_against_brute_force(step_s, rated):
    """Two substations at one supply point; the clock starts and ends within a quarter, a step may lie across its end."""
    stations = [
        {"id": "A", "km": 0.0, "supply_point": "grid", "contract_power_kw": 300.0, "dissipative_resistance_ohm": 0.02, **UNITS},
        {"id": "B", "km": 20.0, "supply_point": "grid", **UNITS},
        {"id": "M", "km": 8.0, "dissipative_resistance_ohm": 0.03, **UNITS, "units": 2},
    ]
    scenario = couple(
        run("x", time=900.0), substations=stations, switch_events=[{"device": "M", "time": 1000.0, "units_in_service": 1}]
    )
    clock = scenario.clock.model_copy(update={"start": 602.0, "end": 602.0 + 1600.0, "step_s": step_s})
    found = rated(scenario.model_copy(update={"clock": clock}))
    time_s = np.concatenate([each[0] for each in found.seen])
    volts, amps = rows_of(found, "source_v"), rows_of(found, "source_a")
    m_ohm = np.where(time_s >= 1000.0, 0.06, 0.03)  # one unit of two: twice the resistance
    heat = np.stack([np.full(len(time_s), 0.02), np.zeros(len(time_s)), m_ohm], axis=1)
    watts = volts * amps + heat * amps**2
    fine = np.arange(602.0, 2202.0, 0.5) + 0.25
    step = np.floor((fine - 602.0) / step_s).astype(int)
    here = (fine >= 900.0) & (fine < 1800.0)
    rows = {row["supply_point"]: row for row in found.tables["demand"]}
    assert len(rows) == len(found.tables["demand"]) == 2  # the quarter at 15:00 min alone is whole
    assert {row["from_s"] for row in rows.values()} == {900.0}
    assert rows["grid"]["power_kw"] == pytest.approx(watts[step[here]][:, :2].sum(axis=1).mean() / 1000.0)
    assert rows["M"]["power_kw"] == pytest.approx(watts[step[here]][:, 2].mean() / 1000.0)
    assert (rows["grid"]["contract_power_kw"], rows["M"]["met"]) == (300.0, "")
    assert rows["grid"]["met"] == ("yes" if rows["grid"]["power_kw"] <= 300.0 else "no")


def test_a_run_without_a_whole_quarter_has_no_demand(rated):
    assert rated(couple(run("x"), end_s=60.0)).tables["demand"] == []


# -- load duration -------------------------------------------------------------------------------------------------


def test_load_duration_of_devices(rated):
    found = rated(couple(*RUNS, end_s=200.0))
    rows = [row for row in found.tables["load_duration"] if row["device"] == "A 1 high_km"]
    amps = -np.sort(-np.abs(link(found, "A 1 high_km")))
    assert [row["share_percent"] for row in rows] == list(SHARES_PERCENT)
    for row in rows:
        rank = max(1, math.ceil(row["share_percent"] / 100.0 * 200 - 1e-6))
        assert row["current_a"] == pytest.approx(amps[rank - 1], abs=amps[0] / 500.0)


# -- sharing -------------------------------------------------------------------------------------------------------


def test_sharing_of_neighbours(rated):
    stations = [{"id": name, "km": km, **UNITS} for name, km in (("A", 0.0), ("M", 8.0), ("B", 20.0))]
    found = rated(couple(*RUNS, end_s=200.0, substations=stations))
    rows = {(row["zone"], row["substation"]): row for row in found.tables["sharing"]}
    assert set(rows) == {("A–M", "A"), ("A–M", "M"), ("M–B", "M"), ("M–B", "B")}
    fed = {
        "A": link(found, "A 1 high_km") + link(found, "A 2 high_km"),
        "M": link(found, "M 1 low_km") + link(found, "M 2 low_km"),
    }
    both = sum(amps.mean() for amps in fed.values())
    for station, amps in fed.items():
        row = rows["A–M", station]
        assert row["mean_current_a"] == pytest.approx(amps.mean())
        assert row["share_percent"] == pytest.approx(100.0 * amps.mean() / both)
        assert row["highest_current_a"] == pytest.approx(amps.max())


def test_a_bypassed_substation_ends_no_zone(rated):
    stations = [{"id": name, "km": km, **UNITS} for name, km in (("A", 0.0), ("M", 8.0), ("B", 20.0))]
    stations[1]["state"] = "bypassed"
    found = rated(couple(*RUNS, end_s=60.0, substations=stations))
    assert {row["zone"] for row in found.tables["sharing"]} == {"A–B"}


def test_a_branch_makes_a_zone_with_three_ends(rated):
    """Track b leaves track 1 between A and B and is fed at its end."""
    branch = {"id": "b", "from_km": 5.0, "to_km": 12.0}
    whole = {"from_km": 0.0, "to_km": 20.0}
    more = {
        "tracks": [{"id": "1", **whole}, branch],
        "connections": [{"from": {"track": "1", "km": 5.0}, "to": {"track": "b", "km": 5.0}}],
        "speed_limits": [{"from_km": 0.0, "to_km": 20.0, "kmh": 100.0}],
        "section_cabins": [],
        "substations": [
            {"id": "A", "km": 0.0, "tracks": ["1"], **UNITS},
            {"id": "B", "km": 20.0, "tracks": ["1"], **UNITS},
            {"id": "X", "km": 12.0, "tracks": ["b"], **UNITS},
        ],
        "contact_lines": [
            whole | {"resistance_ohm_per_km": 0.05, "tracks": ["1"]},
            {"from_km": 5.0, "to_km": 12.0, "resistance_ohm_per_km": 0.05, "tracks": ["b"]},
        ],
        "return_circuit": [
            whole | {"resistance_ohm_per_km": 0.01, "tracks": ["1"]},
            {"from_km": 5.0, "to_km": 12.0, "resistance_ohm_per_km": 0.01, "tracks": ["b"]},
        ],
    }
    found = rated(couple(run("x"), end_s=100.0, **more))
    rows = {row["substation"]: row for row in found.tables["sharing"]}
    assert {row["zone"] for row in rows.values()} == {"A–X–B"}
    assert sum(row["share_percent"] for row in rows.values()) == pytest.approx(100.0)
    train_a = np.concatenate([each.trains["current_a"] for _, each, _ in found.seen])
    assert sum(row["mean_current_a"] for row in rows.values()) == pytest.approx(train_a.mean(), abs=1e-4)

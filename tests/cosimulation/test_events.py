"""Steps that cannot be served or do not converge: one event for each spell, flagged, told in words."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.cosimulation.events import EventLog
from tractionpower.kernels.block_tables import STEP_RESULT
from tractionpower.kernels.network import CONVERGED, FLAG_A, NOT_CONVERGED, NOT_SERVABLE
from tractionpower.supply.compile import compile_network

BYPASSED = [{"id": "C", "km": 10.0, "state": "bypassed"}]
SCENARIO = make_scenario(load("x"), load("y", 10.0, "2"))
SUPPLY = compile_network(SCENARIO.supply, SCENARIO.line, SCENARIO.limits)
X, Y = (int(port) for port in SUPPLY.load_port)
STEP_S = 0.5


def steps_of(*rows):
    """Return records of steps from (status, port, factor or imbalance)."""
    steps = np.zeros(len(rows), STEP_RESULT)
    for step, (status, port, value) in zip(steps, rows, strict=True):
        step["status"], step["port"] = status, port
        step["factor"] = value if status == NOT_SERVABLE else 1.0
        step["worst_a"] = value if status == NOT_CONVERGED else 0.0
    return steps


def log_of(*rows, cuts=()):
    log = EventLog(SUPPLY, STEP_S, 100.0)
    bounds = [0, *cuts, len(rows)]
    for first, end in itertools.pairwise(bounds):
        log.add(100.0 + STEP_S * np.arange(first, end), steps_of(*rows[first:end]))
    return log


GOOD = (CONVERGED, -1, 0.0)


def unserved(factor, port=X):
    return (NOT_SERVABLE, port, factor)


def astray(imbalance):
    return (NOT_CONVERGED, -1, imbalance)


def test_steps_that_are_served_leave_nothing():
    log = log_of(GOOD, GOOD)
    assert (log.rows, log.flagged_steps, log.messages()) == ([], 0, [])
    assert log.table().num_rows == 0
    log.add(np.zeros(0), steps_of())
    assert log.rows == []


def test_a_spell_is_one_event_with_its_worst_value():
    log = log_of(GOOD, unserved(0.9), unserved(0.7), unserved(0.8), GOOD)
    (row,) = log.rows
    assert (row["time_s"], row["end_s"], row["value"], row["limit"]) == (100.5, 102.0, 0.7, 1.0)
    assert (row["kind"], row["subject"], row["track"], row["position_km"]) == ("not_servable", "x", "1", 5.0)
    assert log.flagged_steps == 3


def test_another_kind_or_place_is_another_event():
    log = log_of(unserved(0.9), unserved(0.9, Y), astray(2.0), astray(7.0), GOOD, astray(1.0))
    assert [(row["kind"], row["subject"]) for row in log.rows] == [
        ("not_servable", "x"), ("not_servable", "y"), ("not_converged", "network"), ("not_converged", "network"),
    ]  # fmt: skip
    assert [row["value"] for row in log.rows] == [0.9, 0.9, 7.0, 1.0]
    assert log.rows[2]["limit"] == FLAG_A
    assert np.isnan(log.rows[2]["position_km"])


ROWS = st.lists(st.sampled_from([GOOD, unserved(0.9), unserved(0.5), unserved(0.9, Y), astray(2.0)]), min_size=1, max_size=30)


@settings(deadline=None, derandomize=True)
@given(rows=ROWS, data=st.data())
def test_events_do_not_depend_on_where_buffers_end(rows, data):
    cuts = sorted(data.draw(st.lists(st.integers(0, len(rows)), max_size=5)))  # empty buffers too
    log = log_of(*rows, cuts=cuts)
    spells = [k for k, row in enumerate(rows) if row[0] != CONVERGED and (k == 0 or rows[k - 1][:2] != row[:2])]
    assert [row["time_s"] for row in log.rows] == [100.0 + STEP_S * k for k in spells]
    assert log.flagged_steps == sum(row[0] != CONVERGED for row in rows)
    assert log.messages() == log_of(*rows).messages()


def test_the_message_names_share_place_and_time():
    (text,) = log_of(GOOD, unserved(0.984802, Y), GOOD).messages()
    assert text.startswith("00:01:40.5 to 00:01:41: the demand cannot be served, first at y (track 2, km 10)")
    assert "98.4802 % of all demand" in text
    (text,) = log_of(astray(0.02)).messages()
    assert text == "00:01:40 to 00:01:40.5: a node balances within 0.02 A only; the best solution found is given"


def test_the_table_holds_what_the_messages_say():
    log = log_of(unserved(0.9), GOOD, unserved(0.9, Y), astray(2.0))
    rows = log.table().to_pylist()
    assert [row["message"] for row in rows] == log.messages()
    assert [row["subject"] for row in rows] == ["x", "y", "network"]
    assert [row["time_s"] for row in rows] == [100.0, 101.0, 101.5]
    assert rows[2]["position_km"] is None


# --- in a run


@pytest.mark.parametrize(("more", "spells"), [({}, 1), ({"from": 3.0, "to": 6.0}, 1)])
def test_a_demand_that_cannot_be_served_is_cut_and_told(more, spells):
    demand = load("train", 10.0, power_kw=9500.0, limits="none", **more)
    scenario = make_scenario(demand, section_cabins=BYPASSED)
    results, outcome, run = run_in_memory(scenario)
    steps = 3 if more else 10
    assert outcome.flagged
    assert (outcome.run["status"], outcome.run["flagged_steps"]) == ("flagged", steps)
    events = results.table("events").query("kind == 'not_servable'").reset_index()
    assert len(events) == spells
    assert tuple(events.loc[0, ["kind", "subject", "track", "position_km"]]) == ("not_servable", "train", "1", 10.0)
    assert events.loc[0, "time_s"] == (3.0 if more else 0.0)
    assert events.loc[0, "value"] == pytest.approx(0.947368, abs=1e-5)
    served = results.table("loads").query("current_a > 0")
    assert len(served) == steps
    np.testing.assert_allclose(served["power_kw"], 9000.0, rtol=1e-4)  # the greatest that can be
    assert f"{100.0 * events.loc[0, 'value']:.4f} % of all demand" in run.recorder.events.messages()[0]


@pytest.mark.parametrize("power_kw", [9100.0, 9500.0, 12000.0, 13000.0, 20000.0])
def test_the_ledger_closes_where_the_demand_is_cut(power_kw):
    demand = load("train", 10.0, power_kw=power_kw, limits="none")
    _, outcome, _ = run_in_memory(make_scenario(demand, section_cabins=BYPASSED))
    assert outcome.run["ledgers"]["electric"]["closes"]
    assert outcome.run["flagged_steps"] == 10


def test_two_spells_are_two_events():
    demands = [
        load(name, 10.0, power_kw=9500.0, limits="none", **{"from": low, "to": low + 2}) for name, low in (("a", 2), ("b", 6))
    ]
    demands = [demand | {"from": float(demand["from"]), "to": float(demand["to"])} for demand in demands]
    results, _, _ = run_in_memory(make_scenario(*demands, section_cabins=BYPASSED))
    events = results.table("events")
    assert list(events.query("kind == 'not_servable'")["time_s"]) == [2.0, 6.0]
    (violated,) = events.query("kind == 'limit_violated'").to_dict("records")
    assert (violated["subject"], violated["limit"]) == ("lowest voltage", 2000.0)
    assert violated["value"] < 2000.0


def test_a_step_that_is_served_again_is_served_in_full():
    demands = [
        load("steady", 5.0, power_kw=1000.0),
        load("peak", 10.0, power_kw=12000.0, limits="none", **{"from": 4.0, "to": 6.0}),
    ]
    results, _, _ = run_in_memory(make_scenario(*demands, section_cabins=BYPASSED))
    steady = results.table("loads").query("load == 'steady'").set_index("time_s")["power_kw"]
    np.testing.assert_allclose(steady.drop([4.0, 5.0]), 1000.0, rtol=1e-6)
    assert (steady[[4.0, 5.0]] < 990.0).all()


def test_a_plant_that_conducts_both_ways_does_not_block():
    stations = [station("A", 0.0), station("B", 20.0, conducts="both")]
    results, _, _ = run_in_memory(make_scenario(load("x", 10.0, power_kw=-2000.0), substations=stations))
    rows = results.table("substations").set_index("substation")
    assert (rows.loc["B", "current_a"] < -100.0).all()
    assert (rows["voltage_v"] > 3600.0).all()
    assert list(results.table("events").query("kind == 'substation_blocked'")["subject"]) == ["A"]

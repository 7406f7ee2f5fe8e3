"""Trains that become others: rotations, joins, splits, at any lateness and length of block, before the clock as well."""

import numpy as np
import pytest
from coupled import couple, run, vehicle
from small_studies import run_in_memory

from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import copy_state, new_buffers
from tractionpower.kernels.train_tables import GONE, OUTSIDE, STANDING, STAYING
from tractionpower.model.timetable import Timetable
from tractionpower.movement.journey import theoretical_journeys

AUXILIARY_W = 60e3
"""Of the vehicle below: constant power, no heating."""

VEHICLES = [vehicle("inverter", auxiliaries={"power_kw": AUXILIARY_W / 1e3})]
TURN = {"runs": ["out", "back"], "turn_round_s": 120.0}


def out(name="out", **more):
    """Return a run from A to P, 6 km away, in some 250 s."""
    return run(name, high=6.0, **{"calls": [{"station": "A", "departure": 0.0}, {"station": "P"}]} | more)


def back(name="back", departure=500.0, **more):
    """Return a run from P to A."""
    calls = [{"station": "P", "departure": departure}, {"station": "A"}]
    return run(name, **{"low": 6.0, "high": 0.0, "time": departure, "calls": calls} | more)


def study(*runs, end_s=1200.0, rotations=(), joins=(), splits=(), **more):
    """Return the runs with what becomes of them."""
    scenario = couple(*runs, end_s=end_s, vehicles=VEHICLES, **more)
    plain = {"trains": list(runs), "rotations": list(rotations), "joins": list(joins), "splits": list(splits)}
    return scenario.model_copy(update={"timetable": Timetable.model_validate(plain)})


def at_clock(scenario, **more):
    return scenario.model_copy(update={"clock": scenario.clock.model_copy(update=more)})


def tables_of(scenario):
    results, outcome, _ = run_in_memory(scenario)
    assert outcome.run["status"] == "complete"
    assert all(ledger["closes"] for ledger in outcome.run["ledgers"].values())
    rows = results.table("trains").astype({"train": str, "phase": str})
    return results, rows


def calls_of(results):
    table = results.table("calls").astype({"train": str, "station": str, "kind": str})
    return {(row.train, row.station, row.kind): row for row in table.itertuples()}


def arrival_of(scenario, name):
    """Return when a train alone at the voltage of the substations arrives at the end of its run."""
    (journey,) = theoretical_journeys(scenario, runs=[name], voltage_v=3500.0)
    return journey.calls[-1].arrival_s


def test_a_train_that_comes_in_time_leaves_as_planned():
    results, rows = tables_of(study(out(), back(), rotations=[TURN]))
    calls = calls_of(results)
    assert calls["back", "P", "departure"].actual_s == 500.0
    assert calls["back", "P", "departure"].late_s == 0.0
    mine = rows[rows["train"] == "back"]
    assert mine["time_s"].iloc[0] == pytest.approx(np.floor(calls["out", "P", "arrival"].actual_s) + 1.0)
    assert mine["phase"].iloc[0] == "dwelling"
    assert set(rows.groupby("time_s").size()) == {1}  # one train at a time, at all times
    assert rows["time_s"].diff().max() == 1.0


def test_a_train_that_comes_late_leaves_after_the_turn_round():
    results, rows = tables_of(study(out(), back(departure=260.0), rotations=[TURN]))
    calls = calls_of(results)
    arrival = calls["out", "P", "arrival"].actual_s
    assert calls["back", "P", "departure"].actual_s == pytest.approx(arrival + 120.0, abs=1e-6)
    assert calls["back", "P", "departure"].late_s == pytest.approx(arrival + 120.0 - 260.0, abs=1e-4)
    assert set(rows.groupby("time_s").size()) == {1}


def test_without_the_rotation_they_do_not_know_each_other():
    results, rows = tables_of(study(out(), back(departure=200.0)))
    assert calls_of(results)["back", "P", "departure"].actual_s == 200.0
    assert rows.groupby("time_s").size().max() == 2


def test_the_auxiliaries_of_a_chain_are_drawn_once_and_at_all_times():
    runs = [out("a"), back("b", 400.0), out("c", time=700.0, calls=[{"station": "A", "departure": 700.0}, {"station": "P"}])]
    scenario = study(*runs, rotations=[{"runs": ["a", "b", "c"], "turn_round_s": 60.0}], end_s=1500.0)
    results, rows = tables_of(scenario)
    last = results.run["trains"][2]["finished_s"]
    drawn = rows["auxiliary_power_kw"].sum() * 1e3  # steps of 1 s
    assert drawn == pytest.approx(AUXILIARY_W * last, rel=1e-9, abs=AUXILIARY_W * 1e-6)


def test_the_key_figures_of_a_late_train_count_from_where_it_takes_over():
    results, _ = tables_of(study(out(), back(departure=150.0), rotations=[TURN]))
    arrival = calls_of(results)["out", "P", "arrival"].actual_s
    of_back = next(each for each in results.run["trains"] if each["train"] == "back")
    assert of_back["entered_s"] == pytest.approx(arrival)
    events = results.table("events").query("kind == 'train_entered' and subject == 'back'")
    assert events["time_s"].iloc[0] == pytest.approx(arrival)
    figures = {(row["name"], row["place"]): row["value"] for row in results.key_figures}
    finished, running = of_back["finished_s"], arrival_of(study(back(departure=0.0)), "back")
    assert figures["journey_time_s", "train back"] == pytest.approx(finished - arrival, abs=1e-6)
    assert figures["running_time_s", "train back"] == pytest.approx(running, abs=0.5)


# --- joined and split portions


def test_joined_portions_wait_for_the_last_with_their_auxiliaries():
    both = run("both", low=6.0, high=20.0, time=300.0, calls=[{"station": "P", "departure": 300.0}, {"station": "B"}])
    late = out("late", time=100.0, calls=[{"station": "A", "departure": 100.0}, {"station": "P"}])
    scenario = study(out(), late, both, joins=[{"portions": ["out", "late"], "into": "both", "coupling_s": 90.0}])
    results, rows = tables_of(scenario)
    calls = calls_of(results)
    last = calls["late", "P", "arrival"].actual_s
    assert calls["both", "P", "departure"].actual_s == pytest.approx(last + 90.0, abs=1e-6)
    waiting = rows[(rows["train"] == "out") & (rows["time_s"] > calls["out", "P", "arrival"].actual_s)]
    assert waiting["time_s"].max() == np.floor(last)
    np.testing.assert_allclose(waiting["auxiliary_power_kw"], AUXILIARY_W / 1e3)
    counts = rows.groupby("time_s").size()
    assert counts[np.floor(last)] == 2
    assert counts[np.floor(last) + 1.0] == 1
    assert results.run["overlaps"]["count"] == 0


def test_split_portions_start_when_the_train_has_come():
    one = run("one", low=6.0, high=20.0, time=100.0, calls=[{"station": "P", "departure": 100.0}, {"station": "B"}])
    scenario = study(out(), one, back("two", 600.0), splits=[{"run": "out", "portions": ["one", "two"], "uncoupling_s": 45.0}])
    results, rows = tables_of(scenario)
    calls = calls_of(results)
    arrival = calls["out", "P", "arrival"].actual_s
    assert calls["one", "P", "departure"].actual_s == pytest.approx(arrival + 45.0, abs=1e-6)
    assert calls["two", "P", "departure"].actual_s == 600.0
    counts = rows.groupby("time_s").size()
    assert counts[np.floor(arrival)] == 1
    assert counts[np.floor(arrival) + 1.0] == 2


def test_a_train_that_leaves_the_line_comes_back_without_auxiliaries_in_between():
    away = run("out", high=6.0, end="leave")
    again = run("back", low=6.0, high=0.0, time=100.0, speed_kmh=60.0)
    results, rows = tables_of(study(away, again, rotations=[TURN], end_s=900.0))
    left = results.run["trains"][1]["finished_s"]
    assert results.run["trains"][0]["entered_s"] == pytest.approx(left + 120.0)
    first = rows[rows["train"] == "back"].iloc[0]
    assert first["time_s"] == np.floor(left + 120.0)
    assert not rows["time_s"].between(np.ceil(left), np.floor(left + 119.0)).any()


def test_a_train_whose_forerunner_never_comes_stays_outside():
    results, _ = tables_of(study(out(), back(departure=100.0), rotations=[TURN], end_s=200.0))
    status = {each["train"]: each for each in results.run["trains"]}
    assert status["back"]["status"] == "outside"
    assert status["back"]["overdue_s"] == pytest.approx(100.0)


# --- laws


CHAIN = study(
    out("a"),
    back("b", 260.0),
    run("c", time=100.0, calls=[{"station": "A", "departure": 100.0}, {"station": "P"}], high=6.0),
    run("d", low=6.0, high=20.0, time=420.0, calls=[{"station": "P", "departure": 420.0}, {"station": "B"}]),
    out("e", time=600.0, calls=[{"station": "A", "departure": 600.0}, {"station": "P"}]),
    rotations=[{"runs": ["a", "b", "e"], "turn_round_s": 30.5}, {"runs": ["c", "d"], "turn_round_s": 10.0}],
)


def bytes_of(scenario, ends, copies=False):
    tables = compile_scenario(scenario).block
    state, rows = start_state(compile_scenario(scenario)), []
    for end in ends:
        buffers = new_buffers(tables, 1300)
        advance(tables, state, buffers, end)
        counts = int(buffers.steps["trains"][: end - (0 if not rows else rows[-1][0])].sum())
        rows.append((end, buffers.trains[:counts].tobytes()))
        if copies:
            state = copy_state(state)
    return b"".join(part for _, part in rows)


def test_the_result_depends_neither_on_blocks_nor_on_copies():
    whole = bytes_of(CHAIN, [1200])
    assert bytes_of(CHAIN, [*range(1, 700), 1200], copies=True) == whole
    assert bytes_of(CHAIN, [241, 242, 243, 300, 1200]) == whole


def test_neither_order_nor_names_of_trains_change_the_result():
    """Renamed so that their order turns round, all trains do the same."""

    def renamed(name):
        return f"z{9 - 'abcde'.index(name)}"

    plain = CHAIN.timetable.model_dump(mode="python", by_alias=True)
    plain["trains"] = [item | {"id": renamed(item["id"])} for item in reversed(plain["trains"])]
    plain["rotations"] = [item | {"runs": [renamed(name) for name in item["runs"]]} for item in reversed(plain["rotations"])]
    other = CHAIN.model_copy(update={"timetable": Timetable.model_validate(plain)})
    one, two = (calls_of(tables_of(scenario)[0]) for scenario in (CHAIN, other))
    assert len(one) == len(two)
    for (train, station, kind), row in one.items():
        assert two[renamed(train), station, kind].actual_s == pytest.approx(row.actual_s, abs=1e-6), (train, station, kind)


# --- before the clock


@pytest.mark.parametrize("start", [100.0, 250.0, 300.0, 381.0, 420.0, 600.0, 900.0])
def test_trains_before_the_clock_turn_as_in_a_run(start):
    """With a network that hardly sags, where the trains are does not depend on when the clock starts."""
    scenario = CHAIN.model_copy(update={"coupling": "constant_voltage", "coupling_voltage_v": 3000.0})
    whole = Run(scenario, _Nothing())
    advance(whole.compiled.block, whole.state, new_buffers(whole.compiled.block, 1200), int(start))
    later = start_state(compile_scenario(at_clock(scenario, start=start)))
    compiled = compile_scenario(at_clock(scenario, start=start)).block
    buffers = new_buffers(compiled, 2)
    advance(compiled, later, buffers, 1)
    advance(whole.compiled.block, whole.state, new_buffers(whole.compiled.block, 2), int(start) + 1)
    assert later.trains.movers["status"].tolist() == whole.state.trains.movers["status"].tolist()
    np.testing.assert_allclose(later.trains.movers["s_m"], whole.state.trains.movers["s_m"], atol=1e-6)
    here, there = later.progress[0]["active"], whole.state.progress[0]["active"]
    assert later.active[:here].tolist() == whole.state.active[:there].tolist()


class _Nothing:
    def append(self, table, rows):
        pass


def test_states_before_the_clock():
    scenario = study(out(), back(departure=900.0), rotations=[TURN])
    names = {100.0: (0, OUTSIDE), 400.0: (GONE, STANDING)}
    for start, (first, then) in names.items():
        status = start_state(compile_scenario(at_clock(scenario, start=start))).trains.movers["status"]  # back, out
        assert status[0] == then if start == 400.0 else status[0] == OUTSIDE
        assert (status[1] == GONE) == (first == GONE)


def test_the_forerunner_stays_on_the_tables():
    trains = compile_scenario(study(out(), back(), rotations=[TURN])).block.trains.trains
    assert trains["waits"].tolist() == [1, 0]
    assert trains["takes_over"].tolist() == [True, False]
    assert trains["turns"].tolist() == [0, 1]
    assert STAYING == 3

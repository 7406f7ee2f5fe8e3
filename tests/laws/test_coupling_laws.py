"""Laws of trains and network together."""

from itertools import pairwise

import numpy as np
import pytest
from coupled import MIXED, advanced, couple, run, vehicle
from small_trains import INVERTER, SERIES_MOTORS

from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import BUFFER_FULL, DONE, copy_state, new_buffers
from tractionpower.kernels.network import solve
from tractionpower.movement.journey import theoretical_journeys
from tractionpower.results.store import MemoryWriter

STEPS = 1000
WEAK = {
    "substations": [
        {"id": name, "km": km, "no_load_voltage_v": 3100.0, "internal_resistance_ohm": 0.3}
        for name, km in (("A", 0.0), ("B", 20.0))
    ]
}
KEYS = ("time_s", "s_m", "v_mps", "voltage_v", "current_a", "wheel_w", "power_w")


def make_mixed(*runs, **more):
    """Return the mixed trains, or others, on a weak supply."""
    return couple(*(runs or MIXED), end_s=float(STEPS), **WEAK | more)


@pytest.fixture(scope="module")
def mixed():
    return advanced(make_mixed())


def test_the_run_is_no_trivial_one(mixed):
    rows = mixed.trains
    assert set(rows["phase"].tolist()) >= {0, 1, 3, 4}
    assert rows["current_a"].min() < -100.0  # fed back
    assert rows["voltage_v"].min() < 2700.0
    assert {0, 1, 3, 6} <= set(rows["limited_by"].tolist())
    assert mixed.buffers.steps["trains"].max() == 5
    assert mixed.state.trains.movers["status"].tolist() == [4, 3, 4, 4, 4]


def test_every_step_balances_and_its_ledger_closes(mixed):
    steps = mixed.buffers.steps
    assert (steps["status"] == 0).all()
    assert steps["worst_a"].max() < 1e-6
    gap = steps["source_w"] - steps["regulation_w"] - steps["train_w"] - steps["load_w"] - steps["conductor_w"]
    assert np.abs(gap).max() <= (1e-9 * steps["gross_w"] + 1e-3).max()
    power = np.zeros(len(steps))
    np.add.at(power, np.repeat(np.arange(len(steps)), steps["trains"]), mixed.trains["voltage_v"] * mixed.trains["current_a"])
    np.testing.assert_allclose(power, steps["train_w"], rtol=1e-8, atol=0.01)  # microamperes at 3 kV


def test_the_current_of_each_row_is_what_the_demand_says_at_its_voltage():
    # One inverter train at full power on one feeding end: u = E/2 + sqrt(E2/4 - P R) by the closed form.
    stations = [{"id": "A", "km": 0.0, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.12}]
    plain = vehicle("inverter", auxiliaries={"power_kw": 60.0}, drive=INVERTER | {"power_kw": 2500.0, "max_current_a": 5000.0})
    done = advanced(couple(run("E"), end_s=300.0, substations=stations, section_cabins=[], vehicles=[plain]))
    rows = done.rows("E")
    assert (rows["limited_by"] != 6).all()
    r = 0.12 + rows["s_m"] / 1000.0 * (0.05 + 0.01)
    p = rows["wheel_w"] / 0.85 + 60e3
    closed = 1750.0 + np.sqrt(1750.0**2 - p * r)
    pulls = (rows["brake_w"] == 0.0) & (rows["s_m"] > 1.0)  # nearer it shares the node of the busbar
    assert pulls.sum() > 100
    np.testing.assert_allclose(rows["voltage_v"][pulls], closed[pulls], rtol=1e-8)
    np.testing.assert_allclose(rows["power_w"][pulls], p[pulls], rtol=1e-8)
    assert rows["voltage_v"].min() < 3350.0


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
@pytest.mark.parametrize("step_s", [0.5, 1.0, 5.0])
def test_on_an_infinite_bus_a_train_runs_its_theoretical_journey(kind, step_s):
    calls = [{"station": "P", "min_dwell_s": 20.0}, {"station": "B"}]
    stiff = {
        "substations": [
            {"id": name, "km": km, "no_load_voltage_v": 2800.0, "internal_resistance_ohm": 1e-9, "conducts": "both"}
            for name, km in (("A", 0.0), ("B", 20.0))
        ],
        "contact_lines": [{"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 1e-9}],
        "return_circuit": [{"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.0}],
    }
    scenario = couple(run("E", kind, calls=calls), end_s=900.0, step_s=step_s, **stiff)
    rows = advanced(scenario).rows("E")
    (journey,) = theoretical_journeys(scenario, voltage_v=2800.0)
    assert len(rows) == len(journey.rows)
    for name in KEYS:
        scale = np.abs(journey.rows[name]).max()
        tolerance = 3e-3 if name in ("current_a", "power_w") and kind != "inverter" else 1e-6  # duty cycles are fitted
        np.testing.assert_allclose(rows[name], journey.rows[name], rtol=0.0, atol=tolerance * scale, err_msg=name)


def test_currents_at_constant_voltage_are_those_of_the_theoretical_journeys():
    scenario = couple(*MIXED, coupling="constant_voltage", coupling_voltage_v=2900.0)
    done = advanced(scenario)
    assert (done.buffers.steps["status"] == 0).all()
    for journey in theoretical_journeys(scenario, voltage_v=2900.0):
        rows = done.rows(journey.run.id)
        same = min(len(rows), len(journey.rows))
        assert same > 100
        offset = rows["time_s"][0] - journey.rows["time_s"][0]
        if offset == 0.0:
            current, volts, places = (rows[name][:same] for name in ("current_a", "voltage_v", "s_m"))
            held = (volts > 2000.0) & (volts < 3600.0)  # beyond, what the network gives or takes folds back
            assert held.sum() > 0.9 * same
            np.testing.assert_allclose(current[held], journey.rows["current_a"][:same][held], rtol=1e-9, atol=1e-6)
            np.testing.assert_allclose(places, journey.rows["s_m"][:same], rtol=1e-12, atol=1e-9)
    assert np.abs(done.trains["voltage_v"] - 2900.0).max() > 100.0
    reckoned = 2900.0 * done.trains["current_a"]
    held = (done.trains["voltage_v"] > 2000.0) & (done.trains["voltage_v"] < 3600.0)
    np.testing.assert_allclose(done.trains["coupling_w"][held], (done.trains["power_w"] - reckoned)[held], rtol=1e-9, atol=1e-6)
    returned = np.maximum(-done.trains["power_w"], 0.0)
    np.testing.assert_allclose(done.trains["returned_w"], returned)


def test_the_order_and_the_names_of_trains_change_nothing(mixed):
    names = {"E1": "z", "E2": "a", "M1": "y", "M2": "b", "T1": "m"}
    other = advanced(make_mixed(*[each | {"id": names[each["id"]]} for each in reversed(MIXED)]))
    for old, new in names.items():
        for key in KEYS:
            np.testing.assert_allclose(mixed.rows(old)[key], other.rows(new)[key], rtol=1e-7, atol=1e-5, err_msg=f"{old} {key}")


def test_a_mirrored_line_gives_mirrored_results(mixed):
    mirrored = []
    for each in MIXED:
        (leg,) = each["route"]
        calls = [
            call | {"station": {"P": "P'", "Q": "Q'", "A": "B", "B": "A"}[call["station"]]} for call in each.get("calls", [])
        ]
        route = [leg | {"from_km": 20.0 - leg["from_km"], "to_km": 20.0 - leg["to_km"]}]
        mirrored.append(each | {"route": route} | ({"calls": calls} if calls else {}))
    stations = [{"id": name, "km": km} for name, km in (("A", 0.0), ("P'", 14.0), ("Q'", 7.0), ("B", 20.0))]
    other = advanced(make_mixed(*mirrored, stations=stations))
    for name in ("E1", "E2", "M1", "M2", "T1"):
        for key in KEYS:
            np.testing.assert_allclose(mixed.rows(name)[key], other.rows(name)[key], rtol=1e-6, atol=1e-4, err_msg=key)
    np.testing.assert_allclose(mixed.buffers.source_a, other.buffers.source_a[:, ::-1], rtol=1e-6, atol=1e-3)


def test_no_voltage_is_above_the_no_load_voltage_when_nobody_feeds_back():
    runs = [each | {"train": "series_motors"} for each in MIXED]
    done = advanced(couple(*runs))
    assert done.trains["voltage_v"].max() <= 3500.0 + 1e-6
    assert done.trains["current_a"].min() >= 0.0


def test_a_train_alone_never_arrives_earlier_on_a_weaker_supply():
    times = []
    for volts in (3600.0, 3300.0, 3000.0, 2700.0, 2500.0):
        plants = [
            {"id": name, "km": km, "no_load_voltage_v": volts, "internal_resistance_ohm": 0.12}
            for name, km in (("A", 0.0), ("B", 20.0))
        ]
        for kind in ("inverter", "series_motors"):
            done = advanced(couple(run("E", kind), end_s=1500.0, substations=plants))
            times.append(float(done.state.trains.movers[0]["finished_s"]))
    by_kind = np.array(times).reshape(-1, 2)
    assert (np.diff(by_kind, axis=0) >= -1e-9).all()
    assert (by_kind[-1] > by_kind[0] + 5.0).all()


def test_halving_the_step_shrinks_the_error():
    inverter = [vehicle("inverter", drive=INVERTER | {"max_current_a": 1100.0})]
    plants = [{"id": "A", "km": 0.0, "no_load_voltage_v": 2900.0, "internal_resistance_ohm": 0.25}]
    times, energies = [], []
    for step_s in (4.0, 2.0, 1.0, 0.5, 0.25, 0.02):
        done = advanced(couple(run("E"), end_s=900.0, step_s=step_s, vehicles=inverter, substations=plants, section_cabins=[]))
        times.append(float(done.state.trains.movers[0]["finished_s"]))
        energies.append(float(done.buffers.steps["train_w"].sum()) * step_s)
    errors = np.abs(np.array(times) - times[-1])[:-1]
    assert (errors[1:] < 0.7 * errors[:-1]).all()  # the voltage of a step is that of its start: first order
    assert errors[2] < 1e-3 * times[-1]
    assert abs(energies[2] / energies[-1] - 1.0) < 2e-3


def test_warm_and_cold_solutions_agree(mixed):
    compiled = compile_scenario(make_mixed())
    tables, state = compiled.block, start_state(compiled)
    buffers = new_buffers(tables, 1)
    for step in range(STEPS):
        advance(tables, state, buffers, step + 1)
        again = copy_state(state)
        active = [tables.fleet[k]["port"] for k in buffers.trains["train"][: int(buffers.steps["trains"][0])]]
        if len(active) != again.work.in_service[0] - (len(tables.network.ports) - len(tables.fleet)):
            continue  # a train has just left
        warm = again.work.ports["u"][active].copy()
        solve(tables.network, again.work, False)
        np.testing.assert_allclose(again.work.ports["u"][active], warm, atol=5e-6)


# --- blocks


def bytes_of(buffers, steps):
    trains = int(buffers.steps["trains"][:steps].sum())
    return [array[:steps].tobytes() for array in buffers[:-1]] + [buffers.trains[:trains].tobytes()]


def in_blocks(ends, rows=STEPS + 100, train_rows=None):
    compiled = compile_scenario(make_mixed())
    state, parts, done = start_state(compiled), [], 0
    for end in ends:
        reason = BUFFER_FULL
        while reason == BUFFER_FULL:
            buffers = new_buffers(compiled.block, rows, train_rows)
            steps, reason = advance(compiled.block, state, buffers, end)
            done += steps
            parts.append(bytes_of(buffers, steps))
        assert (done, reason) == (end, DONE)
    return [b"".join(part) for part in zip(*parts, strict=True)]


@pytest.mark.parametrize(
    ("ends", "rows", "train_rows"),
    [(range(1, STEPS + 1), 1, 5), ([7, 120, 121, 122, 200, 333, STEPS], 50, 60), ([STEPS], STEPS, 5), ([STEPS], 13, 3000)],
)
def test_blocks_may_end_anywhere(ends, rows, train_rows):
    assert in_blocks(ends, rows, train_rows) == in_blocks([STEPS])


def test_a_copied_state_resumes_the_run():
    compiled = compile_scenario(make_mixed())
    state = start_state(compiled)
    advance(compiled.block, state, new_buffers(compiled.block, 250), 250)
    kept = copy_state(state)
    first, second = new_buffers(compiled.block, STEPS), new_buffers(compiled.block, STEPS)
    advance(compiled.block, state, first, STEPS)  # changes the tables that the copy goes on with
    advance(compiled.block, kept, second, STEPS)
    assert bytes_of(first, STEPS - 250) == bytes_of(second, STEPS - 250)


def test_tables_figures_and_events_depend_on_no_block_either():
    assert summed_up([37, 38, 121, 400, STEPS - 1]) == summed_up([])


def summed_up(cuts):
    writer = MemoryWriter()
    made = Run(make_mixed(), writer)
    for first, end in pairwise([0, *cuts, STEPS]):
        buffers = new_buffers(made.compiled.block, STEPS)
        advance(made.compiled.block, made.state, buffers, end)
        made.recorder.add(first, end - first, buffers, made.compiled.supply)
    made.recorder.close()
    tables = {name: table.to_pandas().to_csv() for name, table in writer.tables().items()}
    return made.recorder.key_figures(), made.recorder.summary(), tables


# --- before the clock


@pytest.mark.parametrize("train", ["inverter", "series_motors"])
def test_a_train_that_starts_before_the_clock_is_on_the_line_when_it_starts(train):
    scenario = couple(run("E", train, time=100.0), end_s=700.0)
    later = scenario.model_copy(update={"clock": scenario.clock.model_copy(update={"start": 220.0})})
    rows = advanced(later).rows("E")
    (journey,) = theoretical_journeys(scenario, voltage_v=3000.0)
    assert rows["time_s"][0] == 220.0
    assert rows["s_m"][0] == pytest.approx(journey.rows["s_m"][120])
    assert rows["v_mps"][0] == pytest.approx(journey.rows["v_mps"][120])


def test_a_train_that_has_left_before_the_clock_is_not():
    scenario = couple(run("E", time=100.0), run("F", time=2900.0), end_s=3200.0)
    later = scenario.model_copy(update={"clock": scenario.clock.model_copy(update={"start": 3000.0})})
    done = advanced(later)
    assert set(done.trains["train"].tolist()) == {1}
    assert done.buffers.steps["trains"].tolist() == [1] * 200


# --- two motors


def test_series_motors_hold_their_notch_while_the_network_is_solved():
    done = advanced(couple(run("M", "series_motors"), end_s=400.0))
    rows = done.rows("M")
    groupings = rows["grouping"][rows["grouping"] > 0]
    assert set(groupings.tolist()) == {4, 2}
    changes = np.flatnonzero(np.diff(groupings))
    assert len(changes) <= 3  # no to and fro
    assert rows["current_a"].max() <= 2 * SERIES_MOTORS["starting_current_a"] + 60e3 / 2000.0 + 40.0

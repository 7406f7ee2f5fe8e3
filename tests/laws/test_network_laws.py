"""Laws of the solved network that hold whatever the numbers are."""

import numpy as np
import pytest
from dense_network import DenseNetwork
from dense_places import Places
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from random_networks import Draw, tame_dead_loads
from solved import LIMITS, Solved, seed_network, single_line, tap

from tractionpower.kernels.network import CONVERGED, NOT_SERVABLE, TOLERANCE_A
from tractionpower.kernels.spans import place_ports
from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply

SEEDS = st.integers(0, 2**63 - 1)
WIDE = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12}


def law(examples):
    """Run a test on so many seeds, the same ones every time."""
    return settings(
        max_examples=examples, derandomize=True, deadline=None, database=None,
        phases=[Phase.generate], suppress_health_check=list(HealthCheck),
    )  # fmt: skip


def draw(seed, *, taking=False, both=False, served=True):
    """Return a random supply and its line, whose demand can be served."""
    picture = Draw(seed)
    supply = picture.supply(picture.loads())
    loads = supply.loads
    if served:
        loads = tuple(load.model_copy(update={"limits": "range"}) for load in loads)
    if taking:
        loads = tuple(positive(load) for load in loads)
    stations = supply.substations
    if taking or both:
        stations = tuple(s.model_copy(update={"conducts": "both" if both else "forward"}) for s in stations)
    supply = supply.model_copy(update={"loads": loads, "substations": stations})
    return tame_dead_loads(supply, DenseNetwork(supply, picture.line, LIMITS).live), picture.line


def positive(load):
    change = {"power_kw": load.power_kw and abs(load.power_kw), "current_a": load.current_a and abs(load.current_a)}
    return load.model_copy(update=change)


def busy_names(solved):
    """Return the ports whose voltage something holds: they carry current."""
    return [name for name, i in solved.i.items() if abs(i) > 1e-3]


# -- energy


@law(150)
@given(seed=SEEDS)
def test_power_in_is_power_out_plus_losses(seed):
    supply, line = draw(seed)
    solved = Solved(supply, line)
    currents, gross, net = solved.i, 0.0, 0.0
    for name, i in currents.items():
        net -= solved.u[name] * i
        gross += abs(solved.u[name] * i)
    heat, inside, at_nodes, _ = solved.flows()
    worst = max(solved.worst, inside, at_nodes, TOLERANCE_A)  # rounding of a voltage under a hard ceiling is worth more
    assert heat >= 0.0
    assert net == pytest.approx(heat, abs=1e-9 * gross + 1e-3 + 4e3 * len(currents) * worst)


@law(100)
@given(seed=SEEDS)
def test_no_voltage_above_the_highest_no_load_voltage_when_nothing_feeds_back(seed):
    supply, line = draw(seed, taking=True)
    solved = Solved(supply, line)
    highest = max(s.no_load_voltage_v * s.grid_voltage_pu for s in supply.substations if s.state == "in_service")
    assert max(solved.u[name] for name in busy_names(solved) or solved.sources) <= highest + 1e-6


# -- what must not matter


NAMED = ("substations", "section_cabins", "section_points", "loads", "switches", "earthing", "voltage_limiting_devices")


def renamed(supply, seed):
    """Return the supply with other identifiers and every list in another order, and the new name of every old one."""
    rng = np.random.default_rng(seed)
    names = {}
    for kind in NAMED:
        rows = getattr(supply, kind)
        names |= {row.id: f"{kind}-{k}" for row, k in zip(rows, rng.permutation(len(rows)), strict=True)}
    data = supply.model_dump(by_alias=True)
    for kind in NAMED:
        for row in data[kind]:
            row["id"] = names[row["id"]]
    for row in data["feeders"]:
        row["at"] = names[row["at"]]
    for row in data["earthing"]:
        row["substation"] = names.get(row["substation"])
    for switch in data["switches"]:
        for end in ("from", "to"):
            switch[end]["busbar"] = names.get(switch[end]["busbar"])
    for kind in (*NAMED, "feeders", "bonds", "contact_lines", "return_circuit"):
        data[kind] = [data[kind][k] for k in rng.permutation(len(data[kind]))]
    return Supply.model_validate(data), names


@law(100)
@given(seed=SEEDS)
def test_neither_order_nor_names_matter(seed):
    supply, line = draw(seed)
    first = Solved(supply, line)
    other, names = renamed(supply, seed % 2**32)
    second = Solved(other, line)
    busy = busy_names(first)
    assert [second.u[names[name]] for name in busy] == pytest.approx([first.u[name] for name in busy], rel=1e-9)


SIDES = {"low_km": "high_km", "high_km": "low_km"}


def mirrored(supply, line):
    """Return supply and line seen from the other side."""
    data, tracks = supply.model_dump(by_alias=True), line.model_dump(by_alias=True)
    switched = [switch[end] for switch in data["switches"] for end in ("from", "to")]
    joined = [connection[end] for connection in tracks["connections"] for end in ("from", "to")]
    for row in [row for kind in (*NAMED, "feeders") for row in data[kind]] + switched + joined:
        if row.get("km") is not None:
            row["km"] = -row["km"]
    for row in (*data["feeders"], *switched):
        row["side"] = SIDES.get(row["side"], row["side"])
    for row in data["bonds"]:  # counted from the last one, and the end a little behind the first one
        count = int((row["to_km"] - row["from_km"] + 0.001) / row["every_km"])
        row["from_km"], row["to_km"] = -row["from_km"] - count * row["every_km"], 0.5 * row["every_km"] - row["from_km"]
    for row in (*data["contact_lines"], *data["return_circuit"], *tracks["tracks"]):
        row["from_km"], row["to_km"] = -row["to_km"], -row["from_km"]
    for row in tracks["chainage_breaks"]:
        row["at_km"], row["continues_as_km"] = -row["continues_as_km"], -row["at_km"]
    return Supply.model_validate(data), Line.model_validate(tracks)


@law(100)
@given(seed=SEEDS)
def test_the_mirrored_line_gives_the_mirrored_answer(seed):
    supply, line = draw(seed)
    if any(item.continues_as_km < item.at_km for item in line.chainage_breaks):
        return  # of doubled kilometres the first ones are meant, which are the last ones of the mirrored line
    supply = supply.model_copy(update={"loads": tuple(apart(supply, line))})
    first = Solved(supply, line)
    second = Solved(*mirrored(supply, line))
    busy = busy_names(first)
    assert [second.u[name] for name in busy] == pytest.approx([first.u[name] for name in busy], rel=1e-9)


def apart(supply, line):
    """Yield the loads that stand at least 2 m from each other and from all fixed places, where sides or nodes are chosen."""
    taken = {km for cuts in Places(supply, line).cuts.values() for km in cuts}
    for load in supply.loads:
        if all(abs(load.km - km) >= 0.002 for km in taken):
            taken.add(load.km)
            yield load


@law(60)
@given(seed=SEEDS)
def test_halving_the_rows_of_conductors_changes_nothing(seed):
    supply, line = draw(seed)
    supply = supply.model_copy(update={"loads": tuple(apart(supply, line))})
    rng = np.random.default_rng(seed)
    taken = {km for cuts in Places(supply, line).cuts.values() for km in cuts} | {load.km for load in supply.loads}

    def halves(row):
        km = rng.uniform(row.from_km + 0.005, row.to_km - 0.005)
        left_out = any(jump.at_km < km < jump.continues_as_km + 0.002 for jump in line.chainage_breaks)
        if left_out or any(abs(km - other) < 0.002 for other in taken):
            return [row]
        taken.add(km)
        return [row.model_copy(update={"to_km": km}), row.model_copy(update={"from_km": km})]

    halved = {
        kind: tuple(half for row in getattr(supply, kind) for half in halves(row)) for kind in ("contact_lines", "return_circuit")
    }
    first, second = Solved(supply, line), Solved(supply.model_copy(update=halved), line)
    busy = busy_names(first)
    assert [second.u[name] for name in busy] == pytest.approx([first.u[name] for name in busy], rel=1e-9)


# -- how voltages move


@law(100)
@given(seed=SEEDS)
def test_a_cabin_never_lowers_the_voltage_of_a_single_train(seed):
    rng = np.random.default_rng(seed)
    train = tap("T", float(rng.uniform(0.0, 20.0)), track=str(rng.integers(1, 3)), kw=float(rng.uniform(100.0, 9000.0)))
    voltages = []
    for cabin in ("bypassed", "closed"):
        supply, line = seed_network([train], cabin)
        cabins = tuple(c.model_copy(update={"km": float(np.random.default_rng(seed + 1).uniform(1.0, 19.0))})
                       for c in supply.section_cabins)  # fmt: skip
        voltages.append(Solved(supply.model_copy(update={"section_cabins": cabins}), line).u["T"])
    assert voltages[1] >= voltages[0] - 1e-9


@law(60)
@given(seed=SEEDS)
def test_transfer_resistances_are_reciprocal(seed):
    supply, line = draw(seed, both=True)
    live = DenseNetwork(supply, line, LIMITS).live
    loads = [load for load, on in zip(sorted(supply.loads, key=lambda load: load.id), live, strict=True) if on][:6]
    if len(loads) < 2:
        return

    def voltages(on):
        taps = [tap(load.id, load.km, track=load.track, ampere=100.0 if load.id == on else 0.0, limits="none") for load in loads]
        solved = Solved(supply.model_copy(update={"loads": tuple(taps)}), line)
        return np.array([solved.u[load.id] for load in loads])

    idle = voltages(None)
    transfer = np.array([(idle - voltages(load.id)) / 100.0 for load in loads])
    np.testing.assert_allclose(transfer, transfer.T, rtol=0.0, atol=1e-10 * 3600.0)
    assert np.all(np.diag(transfer) >= np.max(transfer, axis=1) - 1e-9)


@law(80)
@given(seed=SEEDS)
def test_voltages_fall_when_a_load_grows(seed):
    supply, line = draw(seed, taking=True)
    if not supply.loads:
        return
    first = Solved(supply, line)
    grown = supply.loads[0]
    more = {"power_kw": grown.power_kw and 1.2 * grown.power_kw, "current_a": grown.current_a and 1.2 * grown.current_a}
    second = Solved(supply.model_copy(update={"loads": (grown.model_copy(update=more), *supply.loads[1:])}), line)
    busy = busy_names(first)
    rise = [second.u[name] - first.u[name] for name in busy]
    tracks_apart = len(supply.return_circuit) > 1  # rails of its own may lift the rail of another train
    if grown.id in busy:
        assert second.u[grown.id] <= first.u[grown.id] + 1e-6
    if not tracks_apart and all(row.resistance_ohm_per_km == 0.0 for row in supply.return_circuit):
        assert max(rise, default=0.0) <= 1e-6


def test_voltages_fall_everywhere_on_a_loop_circuit():
    voltages = []
    for kw in np.linspace(0.0, 6000.0, 25):
        supply, line = single_line([tap("x", 7.0, kw=float(kw)), tap("y", 14.0, kw=2000.0)])
        voltages.append(list(Solved(supply, line).u.values()))
    assert np.all(np.diff(voltages, axis=0) <= 1e-9)
    assert np.all(np.diff(voltages, axis=0)[:, 2] < 0.0)


# -- warm and cold start


@law(60)
@given(seed=SEEDS)
def test_warm_and_cold_start_agree_while_the_loads_move(seed):
    supply, line = draw(seed)
    moving, still = Solved(supply, line), Solved(supply, line)
    network = moving.network
    ports = network.ports
    inside = [p for p in range(len(ports)) if ports["span"][p] >= 0]
    speeds = np.random.default_rng(seed).uniform(-40.0, 40.0, len(ports))
    for _ in range(25):
        for p in inside:
            x = ports["x_m"][p] + speeds[p]
            ports["x_m"][p] = min(max(x, 0.0), network.spans["length_m"][ports["span"][p]])
        still.network.ports["x_m"] = ports["x_m"]
        for solved in (moving, still):
            place_ports(solved.network, solved.work)
        moving.solve(warm=True)
        still.solve()
        busy = busy_names(still)
        assert [moving.u[name] for name in busy] == pytest.approx([still.u[name] for name in busy], rel=0.0, abs=5e-6)


def test_a_warm_start_is_mostly_taken_and_short():
    supply, line = seed_network([tap("x", 4.0, kw=3000.0), tap("y", 13.0, track="2", kw=-2000.0)])
    solved = Solved(supply, line)
    for _ in range(40):
        solved.network.ports["x_m"][2:4] += 33.0
        place_ports(solved.network, solved.work)
        solved.solve(warm=True)
        assert 1 <= solved.iterations <= 4


# -- blocked rectifiers


def test_all_rectifiers_blocked():
    supply, line = single_line([tap("x", 8.0, kw=1000.0), tap("y", 12.0, kw=-3000.0, fold_back_from_v=3900.0)])
    solved = Solved(supply, line)
    assert all(np.isfinite(list(solved.u.values())))
    for name in "AB":
        assert solved.u[name] > 3600.0
        assert solved.i[name] == pytest.approx(BLOCKED_CONDUCTANCE_S * (solved.u[name] - 3600.0), rel=1e-9)
        assert 0.0 < solved.i[name] < 1e-6


def test_a_network_that_floats_without_any_load_stands_at_its_no_load_voltage():
    supply, line = single_line()
    solved = Solved(supply, line)
    assert solved.u == {"A": pytest.approx(3600.0, abs=1e-6), "B": pytest.approx(3600.0, abs=1e-6)}
    assert solved.status == CONVERGED


def test_what_feeds_back_alone_without_limits_has_no_solution():
    supply, line = single_line([tap("x", 8.0, kw=-500.0, limits="none")])
    solved = Solved(supply, line, expect=NOT_SERVABLE)
    assert all(np.isfinite(list(solved.u.values())))
    assert solved.factor < 1e-3


def test_what_feeds_back_alone_within_limits_is_refused():
    supply, line = single_line([tap("x", 8.0, kw=-500.0)])
    solved = Solved(supply, line)
    assert 3600.0 < solved.u["x"] <= 3900.0 + 1e-6
    assert abs(solved.i["x"]) < 1e-5

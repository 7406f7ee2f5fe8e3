"""A run of a train as many vehicles, made by a short simulation of its own: a locomotive and five wagons on linear couplings.

It needs no compiled kernel. What it records goes through the same recorder and writer as that of a run, so folders, tables
and key figures are those that readers meet.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from tractionpower.dynamics.recorder import ChainRecorder
from tractionpower.kernels import chain_state as cs
from tractionpower.kernels import chain_tables as ct
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.results.kept import input_hash_of
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.results.versions import versions

WAGONS = 5
STEP_S, RECORD_S, END_S = 0.01, 0.05, 60.0
DRIVE = ((1.0, 4), (6.0, 9), (12.0, 15), (25.0, 0))
BRAKE = ((30.0, 6), (36.0, 15))
PERMILLE = 4.0
LEVELS = 15

SCENARIO = {
    "case": {
        "name": "A locomotive and five wagons",
        "source": "Made up for tests.",
        "vehicles": [{"id": "v43-like"}, {"id": "wagon-40t", "count": WAGONS}],
        "coupling": "linear-5",
        "traction": {"levels": LEVELS, "starting_effort_kn": 270.0, "power_kw": 2220.0, "time_constant_s": 0.4},
        "brake": {"cylinder_area_cm2": 1200.0, "rigging_ratio": 4.0},
        "track": {
            "gradients": [{"from_m": 150.0, "to_m": 1000.0, "permille": PERMILLE}],
            "curves": [{"from_m": 300.0, "to_m": 400.0, "radius_m": 500.0}],
        },
        "commands": [
            *({"time_s": time_s, "drive": level} for time_s, level in DRIVE),
            *({"time_s": time_s, "brake": level} for time_s, level in BRAKE),
        ],
        "run": {"duration_s": END_S, "step_s": STEP_S, "record_every_s": RECORD_S},
    },
    "vehicles": [
        {
            "id": "v43-like", "name": "Locomotive", "kind": "locomotive", "mass_t": 80.0, "length_m": 15.7,
            "max_speed_kmh": 130.0, "rotating_mass_factor": 1.15, "resistance": {"specific_a_n_per_kn": 2.0},
            "drive": {"kind": "inverter", "starting_effort_kn": 270.0, "power_kw": 2220.0, "efficiency": 0.85},
        },
        {
            "id": "wagon-40t", "name": "Wagon", "kind": "wagon", "mass_t": 40.0, "length_m": 14.0, "max_speed_kmh": 100.0,
            "rotating_mass_factor": 1.04, "resistance": {"specific_a_n_per_kn": 1.6},
        },
    ],
    "couplings": [
        {
            "id": "linear-5", "name": "Linear spring", "source": "Made up for tests.", "draw": {"stiffness_kn_per_mm": 5.0},
            "damping_kns_per_m": 60.0, "endurable_tension_kn": 850.0, "endurable_compression_kn": 60.0,
        }
    ],
}  # fmt: skip

MASSES = np.array([80e3, *[40e3] * WAGONS])
INERTIAS = MASSES * np.array([1.15, *[1.04] * WAGONS])
HALF_LENGTHS = np.array([7.85, *[7.0] * WAGONS])


def fake_scenario(**case: Any) -> DynamicsScenario:
    """Return the scenario of the fake run; `case` replaces keys of its case."""
    return DynamicsScenario.model_validate(SCENARIO | {"case": SCENARIO["case"] | case})


def fake_names() -> tuple[list[str], list[str]]:
    """Return the names of vehicles and couplings."""
    kinds = [part.id for part in fake_scenario().parts]
    vehicles = [f"{number} {kind}" for number, kind in enumerate(kinds, 1)]
    return vehicles, [f"{number}-{number + 1}" for number in range(1, len(kinds))]


def fake_bins() -> np.ndarray:
    """Return the bins of speed, force of the first coupling, acceleration of the first vehicle."""
    return np.array([(0.0, 1.0, 25), (-300e3, 20e3, 30), (-2.0, 0.1, 40)], ct.HISTOGRAM)


def fake_state() -> cs.ChainState:
    """Return the state at the start."""
    n = WAGONS + 1
    movers, links, ledger = np.zeros(n, cs.MOVER), np.zeros(n - 1, cs.LINK), np.zeros(1, cs.LEDGER)
    middles = np.cumsum(2.0 * HALF_LENGTHS) - HALF_LENGTHS
    movers["s_m"] = movers["start_m"] = -middles
    pipe = np.array([(0.0, 0.0, 0.0, 1.0, False), *((t, 0.0, level * 1e4, 1.33, False) for t, level in BRAKE)], ct.PIPE)
    moves = sorted([*((t, level, None) for t, level in DRIVE), *((t, None, level) for t, level in BRAKE)], key=lambda m: m[0])
    controls = [(0.0, 0, 0.0, 0.0, 0)]
    for time_s, drive, brake in moves:
        controls.append(
            (time_s, controls[-1][1] if drive is None else drive, 0.0, 0.0, controls[-1][4] if brake is None else brake)
        )
    ledger["pipe_rows"], ledger["control_rows"] = len(pipe), len(controls)
    bins = fake_bins()
    return cs.ChainState(
        movers,
        links,
        ledger,
        pipe,
        np.array(controls, ct.CONTROL),
        np.zeros((LEVELS + 1, bins["bins"][0] + 2)),
        np.zeros((LEVELS + 2, bins["bins"][0] + 2)),
        np.zeros(bins["bins"][1] + 2),
        np.zeros(bins["bins"][2] + 2),
    )


@lru_cache(maxsize=1)
def fake_run() -> SimpleNamespace:
    """Return the recorded rows (chain, vehicles, links, turns), the state at the start and that at the end."""
    state, start = fake_state(), fake_state()
    chain, vehicles, links, turns, marks = [], [], [], [], []
    every = round(RECORD_S / STEP_S)
    for step in range(round(END_S / STEP_S) + 1):
        held, before = int(state.ledger["control_row"][0]), state.movers.copy()
        rates = _move(state, step * STEP_S, is_first=step == 0)
        _watch(state, turns)
        _follow(state, before, held, marks)
        if step % every == 0:
            chain.append(_chain_row(state))
            vehicles.append(state.movers[list(cs.VEHICLE_ROW.names)].astype(cs.VEHICLE_ROW))
            links.append(np.array(list(zip(state.links["force_n"], state.links["stretch_m"], rates, strict=True)), cs.LINK_ROW))
    state.ledger["recorded"] = len(chain)
    return SimpleNamespace(
        chain=np.array(chain, cs.CHAIN_ROW),
        vehicles=np.stack(vehicles),
        links=np.stack(links),
        turns=np.array(turns, cs.TURN),
        marks=np.array(marks, cs.MARK),
        start=start,
        state=state,
    )


def _move(state: cs.ChainState, time_s: float, *, is_first: bool) -> np.ndarray:
    """Move the train by one step; velocities first. Return the speeds at which the couplings lengthen [m/s]."""
    movers, links, ledger = state.movers, state.links, state.ledger[0]
    h = 0.0 if is_first else STEP_S
    control = state.controls[state.controls["at_s"] <= time_s + 1e-9][-1]
    ledger["control_row"] = int((state.controls["at_s"] <= time_s + 1e-9).sum()) - 1
    v = movers["v_mps"].copy()
    aim = min(control["drive"] / LEVELS * 270e3, control["drive"] / LEVELS * 2.22e6 / max(v[0], 0.1))
    movers["traction_n"][0] += (aim - movers["traction_n"][0]) * h / 0.4
    delays = -movers["start_m"] / 250.0
    for i, delay in enumerate(delays):
        pushed = [level for at_s, level in BRAKE if at_s + delay <= time_s]
        movers["cylinder_pa"][i] += ((pushed[-1] if pushed else 0) / LEVELS * 3.8e5 - movers["cylinder_pa"][i]) * h / 1.33
    brake = 0.5 * (1.0 + 0.5 * np.exp(-v / 5.0)) * movers["cylinder_pa"] * 1200e-4 * 4.0 * 0.83 * MASSES / 160e3
    run = MASSES * 9.80665e-3 * np.where(np.arange(len(v)) == 0, 2.0, 1.6) + 2.0 * v * v
    grade = MASSES * 9.80665e-3 * np.where(movers["s_m"] > 150.0, PERMILLE, 0.0)
    stretch = movers["s_m"][:-1] - movers["s_m"][1:] - (HALF_LENGTHS[:-1] + HALF_LENGTHS[1:])
    rate = v[:-1] - v[1:]
    force = 5e6 * stretch + 60e3 * rate
    pull = movers["traction_n"] - grade
    pull[:-1] -= force
    pull[1:] += force
    free = v + pull / INERTIAS * h
    held = (brake + run) / INERTIAS * h
    new = np.sign(free) * np.maximum(np.abs(free) - held, 0.0)
    middle = 0.5 * (v + new)
    acting = np.where(h > 0.0, (free - new) * INERTIAS / max(h, 1e-9), 0.0)
    share = brake / np.maximum(brake + run, 1.0)
    movers["brake_n"], movers["resistance_n"], movers["grade_n"] = acting * share, acting * (1.0 - share), grade
    movers["a_mps2"] = (new - v) / max(h, 1e-9) if h else 0.0
    movers["v_mps"] = new
    movers["s_m"] += new * h
    links["force_n"], links["stretch_m"] = force, stretch
    work = force * (middle[:-1] - middle[1:]) * h
    links["absorbed_j"] += work
    links["damper_j"] += 60e3 * rate * (middle[:-1] - middle[1:]) * h
    for name, forces in (("traction_j", movers["traction_n"]), ("brake_j", movers["brake_n"]),
                         ("resistance_j", movers["resistance_n"]), ("grade_j", grade)):  # fmt: skip
        ledger[name] += float(forces @ middle) * h
    ledger["coupling_j"] += work.sum()
    ledger["time_s"], ledger["steps"] = time_s, ledger["steps"] + (h > 0.0)
    _spend(state, control, h)
    return rate


def _watch(state: cs.ChainState, turns: list[tuple[int, float]]) -> None:
    """Note extremes and turning points of the forces."""
    for j, link in enumerate(state.links):
        force, now = link["force_n"], state.ledger[0]["time_s"]
        if force > link["greatest_n"]:
            link["greatest_n"], link["greatest_at_s"] = force, now
        if force < link["least_n"]:
            link["least_n"], link["least_at_s"] = force, now
        if link["turning"] == 0.0:
            if abs(force) < cs.TURN_N:
                continue
            turns.append((j, 0.0))
            link["turning"] = np.sign(force)
        if (force - link["turn_n"]) * link["turning"] > 0.0:
            link["turn_n"] = force
        elif abs(force - link["turn_n"]) >= cs.TURN_N:
            turns.append((j, float(link["turn_n"])))
            link["turn_n"], link["turning"] = force, -link["turning"]


def _follow(state: cs.ChainState, before: np.ndarray, held: int, marks: list[tuple[float, float, float, int]]) -> None:
    """Keep the extremes of the vehicles, and mark commands and standstills; `before` are the vehicles at the beginning."""
    movers, ledger = state.movers, state.ledger[0]
    now, first = ledger["time_s"], movers[0]
    if ledger["control_row"] > held:
        marks.append((now, first["s_m"], first["v_mps"], int(ledger["control_row"])))
    moved = movers["s_m"] - movers["start_m"]
    for name, at, values in (
        ("greatest_mps", "greatest_at_s", movers["v_mps"]),
        ("sharpest_mps2", "sharpest_at_s", (movers["v_mps"] - before["v_mps"]) / STEP_S),
        ("furthest_m", "furthest_at_s", moved - moved[0]),
    ):
        more = np.abs(values) > np.abs(movers[name])
        movers[name][more], movers[at][more] = values[more], now
    if (movers["v_mps"] == 0.0).all() and (before["v_mps"] != 0.0).any():
        marks.append((now, movers["s_m"][0], 0.0, -1))


def _spend(state: cs.ChainState, control: np.void, h: float) -> None:
    """Add the time of a step to the bins."""
    speed, force, acceleration = fake_bins()

    def bin_of(value: float, bins: np.void) -> int:
        return int(np.clip(np.floor((value - bins["from_"]) / bins["width"]) + 1, 0, bins["bins"] + 1))

    column = bin_of(state.movers["v_mps"][0], speed)
    state.drive_speed[control["drive"], column] += h
    state.brake_speed[control["brake"], column] += h
    state.force[bin_of(state.links["force_n"][0], force)] += h
    state.acceleration[bin_of(state.movers["a_mps2"][0], acceleration)] += h


def _chain_row(state: cs.ChainState) -> tuple[Any, ...]:
    ledger, control = state.ledger[0], state.controls[state.ledger[0]["control_row"]]
    reduction = state.movers["cylinder_pa"][0] * 1.5 / 3.8
    works = [ledger[name] for name in ("traction_j", "electric_j", "brake_j", "resistance_j", "grade_j", "coupling_j")]
    return (
        ledger["time_s"],
        control["drive"],
        control["brake"],
        control["electric"],
        control["independent_pa"],
        reduction,
        *works,
    )


def record_fake(writer: Any, cuts: tuple[int, ...] = (300, 700), **case: Any) -> tuple[ChainRecorder, cs.ChainState]:
    """Record the fake run into a writer, cut into parts anywhere; return the recorder and the state at the end."""
    made = fake_run()
    recorder = ChainRecorder(fake_scenario(**case), fake_names(), INERTIAS, made.start, writer)
    edges = [0, *cuts, len(made.chain)]
    mark_edges = [round(edge / len(made.chain) * len(made.marks)) for edge in edges]
    turn_edges = [round(edge / len(made.chain) * len(made.turns)) for edge in edges]
    for k in range(len(edges) - 1):
        rows, turns = slice(edges[k], edges[k + 1]), slice(turn_edges[k], turn_edges[k + 1])
        marks = made.marks[mark_edges[k] : mark_edges[k + 1]]
        recorder.add(made.chain[rows], made.vehicles[rows], made.links[rows], made.turns[turns], marks)
    recorder.close(made.state, fake_bins())
    return recorder, made.state


def write_fake(folder: Path, study: str = "fake-train", **case: Any) -> dict[str, Any]:
    """Write the fake run into a folder and return what its ``run.json`` says."""
    scenario = fake_scenario(**case)
    writer = RunWriter(folder, study, input_hash_of(scenario), kind="dynamics", scenario=scenario)
    recorder, state = record_fake(writer, **case)
    run = {
        "format": 1,
        "status": "complete",
        "kind": "dynamics",
        "study": study,
        "name": scenario.name,
        "input_hash": input_hash_of(scenario),
        "seed": 0,
        "versions": versions(),
        "wall_seconds": 0.1,
        "compile_seconds": 0.0,
        "ended": "duration",
        **recorder.summary(state),
    }
    return writer.finish(run, recorder.key_figures(state))


def fake_results(folder: Path, **case: Any) -> Results:
    """Return results of kind dynamics, with all tables, written into a folder and opened again; `case` as `fake_scenario`."""
    write_fake(folder, **case)
    return Results.open(folder)

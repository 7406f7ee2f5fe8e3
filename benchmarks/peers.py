"""The same snapshots of case M, loop circuit, solved by general programs and by ours, in turn."""

from __future__ import annotations

import importlib
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cases import CASES, MovingCase, compile_case
from peer import Peer, Solver
from report import goal, table
from snapshots import Snapshots, take_snapshots, worst_difference
from timing import Action, Times, take_turns

MODULES = {
    "pandapower": "peer_pandapower",
    "power-grid-model": "peer_power_grid_model",
    "lightsim2grid": "peer_lightsim2grid",
    "SciPy": "peer_scipy",
}
AGREE = 1e-6
"""Relative difference of a voltage above which a program is not timed."""

SWEEPS = 20
WARM, COLD = "tractionpower: warm from the second before", "tractionpower: cold, from no load"
US = 1e6


@dataclass
class Comparison:
    """Times of one snapshot by name, what the programs are, how far they differ, what could not be timed and why."""

    seconds: int
    peers: list[Peer] = field(default_factory=list)
    times: dict[str, Times] = field(default_factory=dict)
    difference: dict[str, float] = field(default_factory=dict)
    iterations: dict[str, float] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)


def compare(seconds: int, rounds: int) -> Comparison:
    """Check and time all programs that are installed on `seconds` consecutive snapshots."""
    moving = compile_case(CASES["M"], "loop", "both")
    snapshots = take_snapshots(moving, seconds)
    found = Comparison(seconds)
    ours = {WARM: True, COLD: False}
    reference = np.empty(0)
    for name, warm in ours.items():
        iterations, _, voltage = moving.run_snapshots(snapshots.place_m, snapshots.power_w, warm)
        found.iterations[name] = iterations / seconds
        reference = voltage if warm else reference
        found.difference[name] = float(np.abs(voltage - reference).max() / np.abs(reference).max())
    actions: dict[str, Action] = {name: _our_action(moving, snapshots, warm) for name, warm in ours.items()}
    for peer, solver in _agreeing(snapshots, reference, found):
        found.peers.append(peer)
        actions[peer.name] = _action(peer, solver)
    times = take_turns(actions, rounds, between=WARM)
    found.times = {name: taken.each(seconds * (SWEEPS if name in ours else 1)) for name, taken in times.items()}
    return found


def _agreeing(snapshots: Snapshots, reference: NDArray[np.float64], found: Comparison) -> list[tuple[Peer, Solver]]:
    solvers = []
    for program, module in MODULES.items():
        try:
            peers: tuple[Peer, ...] = importlib.import_module(module).PEERS
        except ImportError as error:
            found.missing.append(f"{program} is not timed: the module {error.name} cannot be imported")
            continue
        for peer in peers:
            try:
                solver = peer.prepare(snapshots)
                found.difference[peer.name] = worst_difference(snapshots, solver(), reference)
            except Exception as error:  # a peer that breaks is told, and the others go on
                found.missing.append(f"{peer.name} is not timed: {type(error).__name__}: {error}")
                continue
            if found.difference[peer.name] <= AGREE:
                solvers.append((peer, solver))
            else:
                found.missing.append(f"{peer.name} is not timed: voltages differ by {found.difference[peer.name]:.1e}")
    return solvers


def _our_action(moving: MovingCase, snapshots: Snapshots, warm: bool) -> Action:
    def action() -> None:
        moving.run_snapshots(snapshots.place_m, snapshots.power_w, warm, SWEEPS)

    return action


def _action(peer: Peer, solver: Solver) -> Action:
    def action() -> float | None:
        solver()
        return solver.seconds if peer.own_clock else None

    return action


def describe(found: Comparison) -> str:
    """Return the comparison as markdown."""
    ours = found.times[WARM]
    headings = ["program and use", "µs a solution, least", "median", "times ours, least", "median", "greatest difference",
                "aim"]  # fmt: skip
    rows = []
    aims = {peer.name: peer.aim for peer in found.peers}
    for name, times in found.times.items():
        least, middle, aim = times.least / ours.least, times.median / ours.median, aims.get(name)
        verdict = f"{aim:g}: {goal(least, aim, at_least=True)}" if aim is not None else ""
        rows.append([name, _us(times.least), _us(times.median), _times(least), _times(middle),
                     f"{found.difference[name]:.0e}", verdict])  # fmt: skip
    lines = [
        f"### Beside general programs (case M, loop circuit, two-way sources, {found.seconds} consecutive seconds)",
        table(headings, rows),
        f"Linear solutions a snapshot of ours: warm {found.iterations[WARM]:.2f}, cold {found.iterations[COLD]:.2f}."
        " The difference is the greatest of all voltages of substations and trains, relative to 3600 V.",
    ]
    return "\n\n".join(lines + [f"- {line}" for line in found.missing])


def _us(seconds: float) -> str:
    return f"{seconds * US:.2f}" if seconds * US < 100.0 else f"{seconds * US:.0f}"


def _times(ratio: float) -> str:
    return f"{ratio:.1f}" if ratio < 100.0 else f"{ratio:.0f}"

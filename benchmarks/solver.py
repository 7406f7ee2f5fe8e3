"""Time of one network solution: trains move every second, warm start; assembly, Newton and factorisation included."""

from __future__ import annotations

from dataclasses import dataclass

from cases import CASES, CIRCUITS, TREE, MovingCase, compile_case
from report import goal, table
from timing import Times, take_turns

GOALS_US = {("M", "common_return"): (20.0, 8.0), ("M", "loop"): (8.0, 5.0), ("M", "rails_per_track"): (60.0,)}
"""Limit and wish [us] of the time of one solution."""

GROWTH_GOAL = 5.5
US = 1e6


@dataclass(frozen=True)
class Result:
    """One case with one circuit: times of a solution, and what the solver said of `steps` steps."""

    case: str
    circuit: str
    times: Times
    iterations: float
    nodes: int  # of the skeleton, and ports: what a linear solution has to work through
    worst_a: float
    cold: int


def measure(steps: int, rounds: int) -> list[Result]:
    """Time all cases with both circuits; all of them take turns."""
    moving = {(name, circuit): compile_case(CASES[name], circuit) for name in CASES for circuit in CIRCUITS}
    moving["tree", "common_return"] = compile_case(TREE, "common_return")
    said = {key: case.run(steps) for key, case in moving.items()}
    worst = {key: case.worst_balance(steps) for key, case in moving.items()}
    actions = {}
    for key, case in moving.items():
        actions[f"{key} solve"] = _action(case, steps, solve_too=True)
        actions[f"{key} move"] = _action(case, steps, solve_too=False)
    times = take_turns(actions, rounds)
    results = []
    for key, case in moving.items():
        each = times[f"{key} solve"].each(steps).minus(times[f"{key} move"].least / steps)
        iterations, cold, _, _ = said[key]
        network = case.tables.network
        results.append(Result(*key, each, iterations / steps, network.nodes + len(network.ports), worst[key], cold))
    return results


def _action(case: MovingCase, steps: int, solve_too: bool):
    def action() -> None:
        case.run(steps, solve_too=solve_too)

    return action


def describe(results: list[Result], steps: int) -> str:
    """Return the results as markdown."""
    headings = ["case, circuit", "µs a solution, least", "median", "linear solutions a step", "worst residual [A]",
                "cold starts", "goal [µs]"]  # fmt: skip
    rows = []
    for r in results:
        verdict = ", ".join(f"{us:g}: {goal(r.times.least * US, us)}" for us in GOALS_US.get((r.case, r.circuit), ()))
        rows.append([f"{r.case} {r.circuit.replace('_', ' ')}", f"{r.times.least * US:.2f}", f"{r.times.median * US:.2f}",
                     f"{r.iterations:.2f}", f"{r.worst_a:.1e}", r.cold, verdict])  # fmt: skip
    by_key = {(r.case, r.circuit): r.times for r in results}
    growth = []
    for circuit in CIRCUITS:
        large, middle = by_key["L", circuit], by_key["M", circuit]
        ratio = large.least / middle.least
        growth.append(
            f"{circuit.replace('_', ' ')} {ratio:.2f} (medians {large.median / middle.median:.2f}),"
            f" goal {GROWTH_GOAL:g}: {goal(ratio, GROWTH_GOAL)}"
        )
    line, tree = (next(r for r in results if (r.case, r.circuit) == (name, "common_return")) for name in ("M", "tree"))
    per_node = [1e9 * r.times.least / (r.iterations * r.nodes) for r in (line, tree)]
    return (
        f"### One network solution ({steps} seconds of moving trains)\n\n{table(headings, rows)}\n\n"
        f"Time of L over time of M: {'; '.join(growth)}. The first second always starts cold and is not counted as such.\n\n"
        f"A tree of five branches takes {per_node[1]:.1f} ns for each node and port of a linear solution, the line M"
        f" {per_node[0]:.1f} ns: {per_node[1] / per_node[0]:.2f} times, goal 1.1: {goal(per_node[1] / per_node[0], 1.1)}."
    )

"""Trains of many vehicles: how much faster than they run they are computed, by method; driving; beside SciPy and NumPy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from report import goal, table
from timing import Times, take_turns
from tractionpower.dynamics.session import Session
from tractionpower.io.dynamics_files import load_case
from tractionpower.model.dynamics.case import DynamicsScenario

Floats = NDArray[np.float64]

HEAVY, DRIVEN = "heavy-haul-200", "drive-50"
TIMES_GOAL = 50.0
STEPS_GOAL, SHOWN_PER_S = 100.0, 25.0
"""Steps of the model and displays, a second of the clock on the wall."""

METHODS = {"symplectic": (0.005, 1), "rk4": (0.005, 4), "variable": (0.05, 0)}
"""Step, or the longest one, of each method [s], and how often it evaluates the couplings in a step; 0: as often as it takes."""

PEER_S, PEER_STEP_S, PEER_TOLERANCE = 60.0, 0.005, 1e-6
PEER_AGREES = 1e-3
"""Greatest difference of a speed between programs that are compared [m/s]."""


@dataclass(frozen=True)
class MethodResult:
    """One method on the heavy-haul train: time, simulated time, steps, closing error of its works over their sum."""

    method: str
    times: Times
    simulated_s: float
    steps: int
    couplings: int
    gap: float


@dataclass(frozen=True)
class DrivingResult:
    """Driving in ticks of a display: time of a tick with its snapshot, of all ticks together; steps of a tick."""

    times: Times
    longest_s: float
    steps_per_s: float


@dataclass(frozen=True)
class PeerResult:
    """One program on the same springs, masses and efforts."""

    name: str
    times: Times
    difference_mps: float


@dataclass(frozen=True)
class Results:
    """All that is measured of train dynamics."""

    methods: list[MethodResult]
    driving: DrivingResult
    peers: list[PeerResult]


def measure(rounds: int, simulated_s: float) -> Results:
    """Measure trains of many vehicles."""
    return Results(_measure_methods(rounds, simulated_s), _measure_driving(rounds), _measure_peers(rounds))


def _scenario(name: str, **case: Any) -> DynamicsScenario:
    scenario = load_case(name).scenario
    assert isinstance(scenario, DynamicsScenario)
    data = scenario.model_dump()
    data["case"] |= case | {"run": data["case"]["run"] | case.pop("run", {})}
    return DynamicsScenario.model_validate(data)


def _measure_methods(rounds: int, simulated_s: float) -> list[MethodResult]:
    sessions: dict[str, Session] = {}

    def action(method: str) -> Callable[[], float]:
        run = {"method": method, "step_s": METHODS[method][0], "duration_s": simulated_s, "record_every_s": 0.5}
        scenario = _scenario(HEAVY, run=run)

        def run_once() -> float:
            sessions[method] = session = Session(scenario)
            start = perf_counter()
            session.advance(simulated_s)
            return perf_counter() - start

        return run_once

    times = take_turns({method: action(method) for method in METHODS}, rounds)
    return [
        MethodResult(method, times[method], session.time_s, session.steps, len(session.state.links), _gap(session))
        for method, session in sessions.items()
    ]


def _gap(session: Session) -> float:
    """Return the closing error of the works since a start at rest, over their sum."""
    ledger, chain = session.state.ledger[0], session.compiled.chain
    kinetic = float(0.5 * (chain.vehicles["inertia_kg"] * session.state.movers["v_mps"] ** 2).sum())
    taken = [float(ledger[name]) for name in ("electric_j", "brake_j", "resistance_j", "grade_j", "coupling_j")]
    given = float(ledger["traction_j"])
    return abs(given - sum(taken) - kinetic) / (given + sum(map(abs, taken)) + kinetic)


def _measure_driving(rounds: int) -> DrivingResult:
    scenario = _scenario(DRIVEN, run={"step_s": 0.01})
    longest: list[float] = []
    ticks = int(10.0 * SHOWN_PER_S)

    def drive() -> float:
        session = Session(scenario, live=True)
        session.set(drive=15)
        total = 0.0
        for tick in range(1, ticks + 1):
            if tick == ticks // 2:
                session.set(drive=0, brake="full_service")
            start = perf_counter()
            session.advance(tick / SHOWN_PER_S)
            session.snapshot()
            longest.append(perf_counter() - start)
            total += longest[-1]
        return total

    times = take_turns({"drive": drive}, rounds)["drive"]
    return DrivingResult(times.each(ticks), max(longest[ticks:]), 10.0 * STEPS_GOAL / times.least)


def _pulled(gears: bool) -> DynamicsScenario:
    """Return the heavy-haul train pulled on level track from 5 m/s on, with its friction gears or with linear springs."""
    data = _scenario(HEAVY).model_dump()
    if not gears:
        springs = {"slack_mm": 0.0, "draw": {"stiffness_kn_per_mm": 20.0}, "damping_kns_per_m": 50.0}
        data["couplings"] = [data["couplings"][0] | springs]
    data["case"] |= {
        "track": {"gradients": [], "curves": []},
        "brake": None,
        "traction": data["case"]["traction"] | {"time_constant_s": 0.0},
        "commands": [{"time_s": 0.0, "drive": 8}],
        "start": {"speed_kmh": 18.0, "couplings": "bunched"},
    }
    return DynamicsScenario.model_validate(data)


class _Springs:
    """The same train for programs that integrate a function, written with arrays of NumPy."""

    def __init__(self, scenario: DynamicsScenario) -> None:
        vehicles = Session(scenario).compiled.chain.vehicles
        self.inertia, self.a, self.b, self.c = (
            vehicles[name].copy() for name in ("inertia_kg", "a_n", "b_ns_per_m", "c_ns2_per_m2")
        )
        self.driven = np.flatnonzero(vehicles["engine"] >= 0)
        traction = scenario.case.traction
        assert traction is not None
        self.effort, self.power = 1e3 * (traction.starting_effort_kn or 0.0), 1e3 * (traction.power_kw or 0.0)
        coupling = scenario.couplings[0]
        self.k, self.d = 1e6 * (coupling.draw.stiffness_kn_per_mm or 0.0), 1e3 * coupling.damping_kns_per_m
        self.n = len(vehicles)

    def force(self, stretch: Floats, rate: Floats) -> Floats:
        """Return the forces of the couplings [N]."""
        return np.asarray(self.k * stretch + self.d * rate)

    def acceleration(self, x: Floats, v: Floats) -> Floats:
        """Return accelerations [m/s2] at displacements [m] and speeds [m/s]."""
        force = self.force(x[:-1] - x[1:], v[:-1] - v[1:])
        net = -(self.a + (self.b + self.c * v) * v)
        net[self.driven] += np.minimum(self.effort, self.power / v[self.driven])
        net[:-1] -= force
        net[1:] += force
        return np.asarray(net / self.inertia)

    def __call__(self, _: float, y: Floats) -> Floats:
        """Return the rates of change of displacements and speeds."""
        v = y[self.n :]
        return np.concatenate([v, self.acceleration(y[: self.n], v)])

    def start(self) -> Floats:
        """Return displacements and speeds at the start."""
        return np.concatenate([np.zeros(self.n), np.full(self.n, 5.0)])


class _Gears(_Springs):
    """The train with friction gears that remember, one value of each array for a coupling."""

    def __init__(self, scenario: DynamicsScenario) -> None:
        super().__init__(scenario)
        coupling = scenario.couplings[0]
        gear, wedge = coupling.draw, coupling.draw.wedge
        assert wedge is not None
        self.half = 0.5e-3 * coupling.slack_mm
        x, y = (
            [0.0, *values] for values in zip(*((1e-3 * p.deflection_mm, 1e3 * p.force_kn) for p in gear.loading), strict=True)
        )
        last = (y[-1] - y[-2]) / (x[-1] - x[-2])  # goes on beyond the last point
        self.x, self.y = np.array([*x, x[-1] + 1.0]), np.array([*y, y[-1] + last])
        tan, mu = np.tan(np.radians(wedge.angle_deg)), wedge.kinetic_friction
        self.load, self.unload = tan / (tan - mu), tan / (tan + mu)
        self.locked = 1e6 * (gear.locked_stiffness_kn_per_mm or 0.0)
        self.relaxing = 1e6 * gear.relaxing_stiffness_kn_per_mm
        self.before = np.zeros((2, 2, self.n - 1))

    def start(self) -> Floats:
        """Return displacements, couplings pushed together, and speeds; what gears remember is forgotten."""
        self.before[:] = 0.0
        y = super().start()
        y[: self.n] = self.half * np.arange(self.n)
        return y

    def force(self, stretch: Floats, rate: Floats) -> Floats:
        """Return the forces of the couplings [N], and remember them."""
        total = np.zeros(self.n - 1)
        for side, sign in enumerate((1.0, -1.0)):
            x = np.maximum(sign * stretch - self.half, 0.0)
            spring = np.interp(x, self.x, self.y)
            high = np.minimum(self.load * spring, self.locked * x)
            low = np.minimum(np.maximum(self.unload * spring, self.relaxing * x), high)
            force, place = self.before[side]
            found = np.minimum(np.maximum(force + self.locked * (x - place), low), high)
            self.before[side] = found, x
            total += sign * found
        return total


def _loop(equations: _Springs) -> Floats:
    """Return the speeds after the same leapfrog steps as ours, in a loop of Python over arrays."""
    y, h = equations.start(), PEER_STEP_S
    x, v = y[: equations.n], y[equations.n :]
    for _ in range(round(PEER_S / h)):
        after = v + h * equations.acceleration(x + 0.5 * h * v, v)
        x, v = x + 0.5 * h * (v + after), after
    return v


def _measure_peers(rounds: int) -> list[PeerResult]:
    found: dict[str, Floats] = {}
    actions: dict[str, Callable[[], float | None]] = {}

    def ours(name: str, scenario: DynamicsScenario, method: str) -> None:
        run = {"method": method, "step_s": PEER_STEP_S if method != "variable" else 1.0, "tolerance": PEER_TOLERANCE}
        run |= {"record_every_s": PEER_S, "duration_s": PEER_S}
        case = scenario.case.model_copy(update={"run": scenario.case.run.model_copy(update=run)})
        own = scenario.model_copy(update={"case": case})

        def run_once() -> float:
            session = Session(own)
            start = perf_counter()
            session.advance(PEER_S)
            found[name] = session.state.movers["v_mps"].copy()
            return perf_counter() - start

        actions[name] = run_once

    def theirs(name: str, action: Callable[[], Floats]) -> None:
        def run_once() -> None:
            found[name] = action()

        actions[name] = run_once

    def integrated(method: Any) -> Callable[[], Floats]:
        limits = {"rtol": PEER_TOLERANCE, "atol": PEER_TOLERANCE}
        return lambda: np.asarray(solve_ivp(springs, (0.0, PEER_S), springs.start(), method, **limits).y[springs.n :, -1])

    springs, gears = _Springs(_pulled(gears=False)), _Gears(_pulled(gears=True))
    ours("friction gears: ours, symplectic", _pulled(gears=True), "symplectic")
    theirs("friction gears: NumPy, the same steps", lambda: _loop(gears))
    ours("springs: ours, symplectic", _pulled(gears=False), "symplectic")
    theirs("springs: NumPy, the same steps", lambda: _loop(springs))
    ours("springs: ours, variable", _pulled(gears=False), "variable")
    for method in ("RK45", "DOP853", "LSODA"):
        theirs(f"springs: SciPy solve_ivp, {method}", integrated(method))
    times = take_turns(actions, rounds)
    reference = {
        "springs": found["springs: SciPy solve_ivp, DOP853"],
        "friction gears": found["friction gears: ours, symplectic"],
    }
    return [PeerResult(n, times[n], float(np.abs(v - reference[n.partition(":")[0]]).max())) for n, v in found.items()]


def describe(results: Results) -> str:
    """Return the results as markdown."""
    rows = []
    for r in results.methods:
        fast = r.simulated_s / r.times.least
        evaluations = METHODS[r.method][1]
        each = f"{1e9 * r.times.least / (r.steps * evaluations * r.couplings):.0f}" if evaluations else ""
        verdict = f"{TIMES_GOAL:g}: {goal(fast, TIMES_GOAL, at_least=True)}" if r.method == "symplectic" else ""
        rows.append([f"{r.method}, {METHODS[r.method][0]:g} s", f"{r.times.least:.2f}", f"{r.times.median:.2f}", r.steps,
                     each, f"{r.gap:.0e}", f"{fast:.0f}", verdict])  # fmt: skip
    headings = ["method, step", "s, least", "median", "steps", "ns a coupling", "works, gap", "times real time", "goal"]
    simulated = results.methods[0].simulated_s
    text = f"### A train of 200 vehicles with draft gears (`{HEAVY}`, {simulated:g} s)\n\n{table(headings, rows)}"
    return "\n\n".join([text, _describe_driving(results.driving), _describe_peers(results.peers)])


def _describe_driving(d: DrivingResult) -> str:
    shown = 1e3 / SHOWN_PER_S
    return (
        f"Driving `{DRIVEN}` (50 vehicles, {STEPS_GOAL:g} steps and {SHOWN_PER_S:g} displays a second): the steps of a display"
        f" and its numbers take {1e3 * d.times.least:.2f} ms of {shown:g} ms (median {1e3 * d.times.median:.2f}, longest"
        f" {1e3 * d.longest_s:.1f}): {d.steps_per_s:.0f} steps a second would be possible; goal {STEPS_GOAL:g}:"
        f" {goal(d.steps_per_s, STEPS_GOAL, at_least=True)}."
    )


def _describe_peers(peers: list[PeerResult]) -> str:
    rows = []
    for p in peers:
        own = next(each for each in peers if each.name == f"{p.name.partition(':')[0]}: ours, symplectic")
        ratio = f"{p.times.least / own.times.least:.1f}"
        rows.append([p.name, f"{p.times.least:.3f}", f"{p.times.median:.3f}", ratio, f"{p.difference_mps:.0e}"])
    headings = ["program", "s, least", "median", "times ours, symplectic", "difference of speeds [m/s]"]
    agreed = "agree" if max(p.difference_mps for p in peers) <= PEER_AGREES else "do not agree"
    return (
        f"The same 200 vehicles on level track, pulled from 5 m/s for {PEER_S:g} s, once with their friction gears and once with"
        f" linear springs and dampers:\n\n{table(headings, rows)}\n\nAll {agreed} within {PEER_AGREES:g} m/s."
    )

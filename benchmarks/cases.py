"""The benchmark cases S, M and L: evenly spaced substations, cabins between them, trains that run round and round.

3.6 kV no-load, 0.12 ohm a substation, diodes, double track; tracks tied at every substation and cabin. Train i runs on
track i mod 2 at +33 or -33 m/s, wrapping round; its power follows a cycle of 600 s from a random phase: 120 s full,
240 s 40 %, 120 s 4 %, 120 s -60 %, times a personal factor of 0.8 to 1.2 and the peak power. Traction ramps to zero
from 2700 to 2000 V, regeneration folds back from 3800 to 3900 V.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.jit import njit
from tractionpower.kernels.spans import place_ports
from tractionpower.kernels.network import solve
from tractionpower.kernels.tables import SEGMENT, Work, new_work
from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.compile import SupplyTables, compile_network

NO_LOAD_V, SOURCE_OHM, SPEED_MPS, CYCLE_S = 3600.0, 0.12, 33.0, 600.0
TRAIN_SEGMENTS = 4


@dataclass(frozen=True)
class Case:
    """A case: length of the line [km], numbers of substations and trains, peak power of a train [W]."""

    name: str
    length_km: float
    substations: int
    trains: int
    peak_w: float

    @property
    def substation_kms(self) -> NDArray[np.float64]:
        return np.linspace(0.0, self.length_km, self.substations)

    @property
    def cabin_kms(self) -> NDArray[np.float64]:
        kms = self.substation_kms
        return 0.5 * (kms[1:] + kms[:-1])

    def line(self) -> Line:
        return Line.model_validate({"tracks": [{"id": t, "from_km": 0.0, "to_km": self.length_km} for t in "12"]})

    def supply(self, circuit: str) -> Supply:
        """Return the supply with the circuit ``loop`` (contact line and rails in one) or ``common_return``."""
        contact, rails = (0.06, 0.0) if circuit == "loop" else (0.05, 0.01)
        stretch = {"from_km": 0.0, "to_km": self.length_km}
        return Supply.model_validate(
            {
                "substations": [
                    {"id": f"S{k:03d}", "km": km, "no_load_voltage_v": NO_LOAD_V, "internal_resistance_ohm": SOURCE_OHM}
                    for k, km in enumerate(self.substation_kms.tolist())
                ],
                "section_cabins": [{"id": f"C{k:03d}", "km": km} for k, km in enumerate(self.cabin_kms.tolist())],
                "contact_lines": [stretch | {"resistance_ohm_per_km": contact}],
                "return_circuit": [stretch | {"resistance_ohm_per_km": rails}],
                "loads": [
                    {"id": f"T{k:03d}", "track": "12"[k % 2], "km": 0.5, "power_kw": 0.0} for k in range(self.trains)
                ],
            }
        )


CASES = {
    "S": Case("S", 20.0, 2, 4, 3.0e6),
    "M": Case("M", 100.0, 8, 30, 3.5e6),
    "L": Case("L", 500.0, 40, 150, 3.5e6),
}


@dataclass(frozen=True)
class Trains:
    """Trains of a case as arrays: start [m], direction, phase of the cycle [s], full power [W]."""

    start_m: NDArray[np.float64]
    direction: NDArray[np.float64]
    phase_s: NDArray[np.float64]
    power_w: NDArray[np.float64]


def draw_trains(case: Case) -> Trains:
    """Draw the trains of a case, always the same."""
    rng = np.random.default_rng(1)
    number = np.arange(case.trains)
    each = (case.trains + 1) // 2
    start = (number // 2 + 0.25 + 0.5 * rng.random(case.trains)) * 1000.0 * case.length_km / each
    phase = CYCLE_S * rng.random(case.trains)
    factor = 0.8 + 0.4 * rng.random(case.trains)
    return Trains(start, np.where(number % 2 == 0, 1.0, -1.0), phase, factor * case.peak_w)


@njit
def cycle_share(t):
    """Return the share of full power at `t` [s] of the cycle."""
    t = t % 600.0
    if t < 120.0:
        return 1.0
    if t < 360.0:
        return 0.4
    return 0.04 if t < 480.0 else -0.6


@njit
def write_train(segments, first, p):
    """Write the characteristic of a train that wants the power `p` [W], negative feeding back."""
    for k in range(4):
        segments[first + k].a = 0.0
        segments[first + k].b = 0.0
        segments[first + k].c = 0.0
    segments[first].from_v = -np.inf
    segments[first + 1].from_v = 2000.0
    if p >= 0.0:
        segments[first + 1].a = p / 700.0
        segments[first + 1].c = -p * 2000.0 / 700.0
        segments[first + 2].from_v = 2700.0
        segments[first + 2].c = p
        segments[first + 3].from_v = 1e5
        segments[first + 3].c = p
    else:
        segments[first].b = p / 4.0e6 
        segments[first + 1].c = p
        segments[first + 2].from_v = 3800.0
        segments[first + 2].a = -p / 100.0
        segments[first + 2].c = p * 39.0
        segments[first + 3].from_v = 3900.0


@njit
def move_trains(network, trains, first_port, span_length, spans_of_track, t):
    """Place all trains and set their characteristics at the time `t` [s]."""
    start_m, direction, phase_s, power_w = trains
    spans = spans_of_track.shape[1]
    length = span_length * spans
    for k in range(start_m.shape[0]):
        x = (start_m[k] + direction[k] * 33.0 * t) % length
        s = min(int(x / span_length), spans - 1)
        port = network.ports[first_port + k]
        port.span = s
        port.x_m = x - s * span_length
        port.positive = spans_of_track[k % 2, s]
        port.negative = spans_of_track[2, s]
        write_train(network.segments, port.first_segment, power_w[k] * cycle_share(t + phase_s[k]))


@njit
def run_steps(network, work, trains, first_port, span_length, spans_of_track, t0, steps, solve_too):
    """Move and solve `steps` steps of 1 s; return linear solutions, cold starts, worst imbalance [A], lowest voltage [V]."""
    iterations, cold, worst, lowest = 0, 0, 0.0, np.inf
    for step in range(steps):
        move_trains(network, trains, first_port, span_length, spans_of_track, t0 + step)
        if solve_too:
            place_ports(network, work)
            status, n, w, factor, port = solve(network, work, step > 0)
            iterations += n
            cold += n > 6
            worst = max(worst, w)
            for k in range(start_count(trains)):
                lowest = min(lowest, work.ports[first_port + k].u)
    return iterations, cold, worst, lowest


@njit
def start_count(trains):
    return trains[0].shape[0]


@dataclass(frozen=True)
class MovingCase:
    """A case compiled with moving trains."""

    tables: SupplyTables
    work: Work
    arguments: tuple

    def run(self, steps: int, t0: float = 0.0, solve_too: bool = True) -> tuple[int, int, float, float]:
        return run_steps(self.tables.network, self.work, *self.arguments, t0, steps, solve_too)


def compile_case(case: Case, circuit: str) -> MovingCase:
    """Compile a case for the solver alone, without the rest of the program."""
    tables = compile_network(case.supply(circuit), case.line(), shipped_voltages())
    network = tables.network
    segments = np.zeros(len(network.segments) + TRAIN_SEGMENTS * case.trains, SEGMENT)
    segments[: len(network.segments)] = network.segments
    first_port = int(tables.load_port[0])
    network.ports["first_segment"][first_port:] = len(network.segments) + TRAIN_SEGMENTS * np.arange(case.trains)
    network.ports["segments"][first_port:] = TRAIN_SEGMENTS
    network.ports["floor_v"][first_port:] = 0.0
    network = network._replace(segments=segments)
    tables = SupplyTables(**{name: getattr(tables, name) for name in tables.__slots__} | {"network": network})
    first = network.spans["first_conductor"]
    spans_of_track = np.array([first, first + 1, first + 2])
    trains = draw_trains(case)
    arrays = (trains.start_m, trains.direction, trains.phase_s, trains.power_w)
    span_m = 1000.0 * case.length_km / len(network.spans)
    return MovingCase(tables, new_work(network), (arrays, first_port, span_m, spans_of_track))


def shipped_voltages() -> tuple[Limit, ...]:
    """Return the voltage limits of the 3 kV system that ship."""
    from tractionpower.io.limits_files import read_shipped_limits  # noqa: PLC0415

    return read_shipped_limits()

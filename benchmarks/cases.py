"""The benchmark cases S, M and L: evenly spaced substations, cabins between them, trains that run round and round.

3.6 kV no-load, 0.12 ohm a substation, diodes; double track; tracks tied at every substation and cabin. Train i runs on
track i mod 2 at +33 or -33 m/s, wrapping round; its power follows a cycle of 600 s from a random phase: 120 s full,
240 s 40 %, 120 s 4 %, 120 s -60 %, times a personal factor of 0.8 to 1.2 and the peak power. Traction ramps to zero
from 2700 to 2000 V, regeneration folds back from 3800 to 3900 V.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from driver import CYCLE_S, TRAIN_SEGMENTS, find_worst_balance, run_snapshots, run_steps
from tractionpower.io.limits_files import shipped_limits
from tractionpower.kernels.tables import SEGMENT, Work, new_work
from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.compile import SupplyTables, compile_network

NO_LOAD_V, SOURCE_OHM = 3600.0, 0.12
CIRCUITS = {"loop": (0.06, 0.0), "common_return": (0.05, 0.01), "rails_per_track": (0.05, 0.01)}
"""Contact line of one track and rails of both tracks together [ohm/km]; loop: all of it in the contact line; rails per
track: twice their resistance each, bonds every 500 m, leakage of 0.1 S/km of each track."""

BOND_KM, LEAKAGE_S_PER_KM = 0.5, 0.1


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

    def supply(self, circuit: str, conducts: str = "forward") -> Supply:
        """Return the supply with a circuit of `CIRCUITS`; substations conduct ``forward`` (diodes) or ``both`` ways."""
        contact, rails = CIRCUITS[circuit]
        stretch = {"from_km": 0.0, "to_km": self.length_km}
        plant = {"no_load_voltage_v": NO_LOAD_V, "internal_resistance_ohm": SOURCE_OHM, "conducts": conducts}
        return Supply.model_validate(
            {
                "substations": [{"id": f"S{k:03d}", "km": km} | plant for k, km in enumerate(self.substation_kms.tolist())],
                "section_cabins": [{"id": f"C{k:03d}", "km": km} for k, km in enumerate(self.cabin_kms.tolist())],
                "contact_lines": [stretch | {"resistance_ohm_per_km": contact}],
                **self._return_circuit(circuit, rails),
                "loads": [{"id": f"T{k:03d}", "track": "12"[k % 2], "km": 0.5, "power_kw": 0.0} for k in range(self.trains)],
            }
        )

    def _return_circuit(self, circuit: str, ohm: float) -> dict[str, object]:
        stretch = {"from_km": 0.0, "to_km": self.length_km}
        if circuit != "rails_per_track":
            return {"return_circuit": [stretch | {"resistance_ohm_per_km": ohm}]}
        own = stretch | {"resistance_ohm_per_km": 2.0 * ohm, "leakage_s_per_km": LEAKAGE_S_PER_KM}
        return {"return_circuit": [own | {"tracks": [t]} for t in "12"], "bonds": [stretch | {"every_km": BOND_KM}]}


@dataclass(frozen=True)
class Tree(Case):
    """Five double-track branches that meet in one point, with as many devices and trains as a line of their length."""

    branches: int = 5

    @property
    def tracks(self) -> tuple[str, ...]:
        return tuple(f"{branch}{side}" for branch in range(self.branches) for side in "ab")

    @property
    def branch_km(self) -> float:
        return self.length_km / self.branches

    def line(self) -> Line:
        first = dict(zip("ab", self.tracks, strict=False))
        others = self.tracks[2:]
        joints = [{"from": {"track": t, "km": 0.0}, "to": {"track": first[t[-1]], "km": 0.0}} for t in others]
        tracks = [{"id": t, "from_km": 0.0, "to_km": self.branch_km} for t in self.tracks]
        return Line.model_validate({"tracks": tracks, "connections": joints})

    def supply(self, circuit: str, conducts: str = "forward") -> Supply:
        """Return the supply: two substations and a cabin between them on each branch."""
        contact, rails = CIRCUITS[circuit]
        stretch = {"from_km": 0.0, "to_km": self.branch_km}
        plant = {"no_load_voltage_v": NO_LOAD_V, "internal_resistance_ohm": SOURCE_OHM, "conducts": conducts}
        pairs = [[f"{branch}{side}" for side in "ab"] for branch in range(self.branches)]
        return Supply.model_validate(
            {
                "substations": [
                    {"id": f"S{k}{n}", "km": share * self.branch_km, "tracks": pair} | plant
                    for k, pair in enumerate(pairs)
                    for n, share in enumerate((0.4, 1.0))
                ],
                "section_cabins": [{"id": f"C{k}", "km": 0.7 * self.branch_km, "tracks": pair} for k, pair in enumerate(pairs)],
                "contact_lines": [stretch | {"resistance_ohm_per_km": contact}],
                "return_circuit": [stretch | {"resistance_ohm_per_km": rails, "tracks": pair} for pair in pairs],
                "loads": [
                    {"id": f"T{k:03d}", "track": self.tracks[k % len(self.tracks)], "km": 0.5, "power_kw": 0.0}
                    for k in range(self.trains)
                ],
            }
        )


CASES = {
    "S": Case("S", 20.0, 2, 4, 3.0e6),
    "M": Case("M", 100.0, 8, 30, 3.5e6),
    "L": Case("L", 500.0, 40, 150, 3.5e6),
}
TREE = Tree("tree", 100.0, 10, 30, 3.5e6)


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


@dataclass(frozen=True)
class MovingCase:
    """A case compiled for the solver, with trains that the compiled drivers move."""

    case: Case
    tables: SupplyTables
    work: Work
    spot: tuple[int, NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]
    trains: Trains

    @property
    def _arrays(self) -> tuple[NDArray[np.float64], ...]:
        return self.trains.start_m, self.trains.direction, self.trains.phase_s, self.trains.power_w

    def run(self, steps: int, t0: float = 0.0, solve_too: bool = True) -> tuple[int, int, float, float]:
        """Run `steps` seconds, see `driver.run_steps`."""
        return run_steps(self.tables.network, self.work, self.spot, self._arrays, float(t0), steps, solve_too)

    def worst_balance(self, steps: int, t0: float = 0.0) -> float:
        """Return the largest imbalance of any node in `steps` seconds [A], see `driver.find_worst_balance`."""
        network, balance = self.tables.network, np.zeros(self.tables.network.nodes + 1)
        return find_worst_balance(network, self.work, self.tables.edges, balance, self.spot, self._arrays, float(t0), steps)

    def run_snapshots(
        self, place_m: NDArray[np.float64], power_w: NDArray[np.float64], warm: bool, sweeps: int = 1
    ) -> tuple[int, float, NDArray[np.float64]]:
        """Solve snapshots, see `driver.run_snapshots`; return iterations, worst imbalance and the ports' voltages."""
        voltage = np.empty((len(place_m), len(self.work.ports)))
        iterations, worst = run_snapshots(self.tables.network, self.work, self.spot, place_m, power_w, warm, sweeps, voltage)
        return iterations, worst, voltage


def compile_case(case: Case, circuit: str, conducts: str = "forward") -> MovingCase:
    """Compile a case for the solver alone, without the rest of the program."""
    tables = compile_network(case.supply(circuit, conducts), case.line(), shipped_voltages())
    network = tables.network
    segments = np.zeros(len(network.segments) + TRAIN_SEGMENTS * case.trains, SEGMENT)
    segments[: len(network.segments)] = network.segments
    first_port = int(tables.load_port[0])
    network.ports["first_segment"][first_port:] = len(network.segments) + TRAIN_SEGMENTS * np.arange(case.trains)
    network.ports["segments"][first_port:] = TRAIN_SEGMENTS
    network.ports["floor_v"][first_port:] = 0.0
    network = network._replace(segments=segments)
    tables = SupplyTables(**{name: getattr(tables, name) for name in tables.__slots__} | {"network": network})
    return MovingCase(case, tables, new_work(network), (first_port, *_spots(tables)), draw_trains(case))


def _spots(tables: SupplyTables) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return by track the places of the cuts [m], the spans between them, their contact lines and their rails."""
    tracks = sorted({stretch.track for stretch in tables.stretches})
    found = [sorted((s.from_m, s.to_m, s.span, s.positive, s.negative) for s in tables.stretches if s.track == t) for t in tracks]
    cuts = np.array([[row[0] for row in rows] + [rows[-1][1]] for rows in found])
    spans, contact, rails = (np.array([[row[k] for row in rows] for rows in found], np.int64) for k in (2, 3, 4))
    return cuts, spans, contact, rails


def shipped_voltages() -> tuple[Limit, ...]:
    """Return the voltage limits that ship with the package."""
    return shipped_limits()

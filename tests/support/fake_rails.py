"""Rail potentials by the closed form of a homogeneous leaky line, and runs that record them."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from fake_runs import small_run
from small_studies import make_scenario

from tractionpower.cosimulation.places import Placed
from tractionpower.cosimulation.rail_recorder import RailRecorder
from tractionpower.kernels.block_tables import STEP_RESULT
from tractionpower.kernels.train_tables import TRAIN_ROW
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.supply.rail_places import RailPlace

RAIL_OHM_PER_KM = 0.0055


def leaky_v(km: Any, at_km: Any, current_a: Any, length_km: float, s_per_km: float) -> Any:
    """Return the potential [V] at `km` for a current put into rails at `at_km`; both ends of the line are open."""
    alpha, impedance = np.sqrt(RAIL_OHM_PER_KM * s_per_km), np.sqrt(RAIL_OHM_PER_KM / s_per_km)
    low, high = np.minimum(km, at_km), np.maximum(km, at_km)
    wave = np.cosh(alpha * low) * np.cosh(alpha * (length_km - high)) / np.sinh(alpha * length_km)
    return current_a * impedance * wave


def rail_places(tracks: str, km: Any, s_per_km: float) -> tuple[RailPlace, ...]:
    """Return places that stand for half of the lengths to both sides."""
    edges = np.concatenate(([km[0]], (km[1:] + km[:-1]) / 2.0, [km[-1]]))
    return tuple(
        RailPlace(tracks, float(at), s_per_km / 1000.0, float(long) * 1000.0, -1)
        for at, long in zip(km, np.diff(edges), strict=True)
    )


def make_recorder(
    places: tuple[RailPlace, ...], scenario: Scenario | None = None, devices: tuple[str, ...] = (), trains: tuple[str, ...] = ()
) -> RailRecorder:
    supply: Any = SimpleNamespace(rail_places=places, earth_devices=devices)
    return RailRecorder(scenario or make_scenario(), supply, trains, ("1", "2"))


def rows_of(potential_v: Any, earth_a: Any = None, leaked_a: Any = 0.0) -> Any:
    """Return what a recorder of rails needs of buffers."""
    steps = np.zeros(len(potential_v), STEP_RESULT)
    steps["leaked_a"] = leaked_a
    devices = np.zeros((len(potential_v), 0)) if earth_a is None else np.asarray(earth_a, float)
    return SimpleNamespace(rail_v=np.asarray(potential_v, float), earth_a=devices, steps=steps)


def train_rows(time_s: Any, train: Any, rail_v: Any, km: Any) -> tuple[Any, Placed]:
    """Return rows of trains on the first track, and their places."""
    rows = np.zeros(len(time_s), TRAIN_ROW)
    rows["time_s"], rows["train"], rows["rail_v"] = time_s, train, rail_v
    return rows, Placed(np.zeros(len(rows), np.int64), np.asarray(km, float), np.ones(len(rows), np.int64))


@dataclass(frozen=True)
class RailRun:
    """A run with rails, and the recorder that wrote them."""

    scenario: Scenario
    results: Results
    recorder: RailRecorder


def rail_run(scale: float = 1.0, base: Any = None, apart_km: float = 0.5) -> RailRun:
    """Return the four trains of `fake_runs` with rails per track that leak, an earthed depot and a voltage-limiting device.

    Currents of the trains go into the rails where they are and out of them at substations, in parts as the substations feed.
    """
    base = base or small_run()
    supply = base.scenario.supply
    earthing = {"id": "depot", "track": "1", "km": 2.0, "resistance_ohm": 0.5}
    device = {"id": "VLD 10", "track": "2", "km": 10.0, "closes": [{"above_v": 120.0}]}
    more = {"earthing": [earthing], "voltage_limiting_devices": [device]}
    plain = base.scenario.model_dump(mode="json", by_alias=True)
    plain["supply"] |= more
    scenario = Scenario.model_validate(plain)
    length = max(track.to_km for track in scenario.line.tracks)
    km = np.arange(0.0, length + 1e-9, apart_km)
    places = tuple(place for track in "12" for place in rail_places(track, km, 0.2))
    trains = base.results.table("trains")
    names = tuple(sorted(str(name) for name in trains["train"].unique()))
    recorder = make_recorder(places, scenario, ("depot", "VLD 10"), names)
    tables: dict[str, list[Any]] = {}
    stations = [each.km for each in supply.substations]
    fed = base.results.table("substations").pivot_table(index="time_s", columns="substation", values="current_a", observed=True)
    fed = fed[[each.id for each in supply.substations]].to_numpy(float)
    time_s = scenario.clock.start + np.arange(len(fed), dtype=float)
    volts = np.zeros((len(fed), 2, len(km)))
    for k, at in enumerate(stations):
        volts -= fed[:, k, None, None] / 2.0 * leaky_v(km, at, 1.0, length, 0.2)
    step = (trains["time_s"].to_numpy() - scenario.clock.start).astype(int)
    track, at, current = (trains["track"].astype(int) - 1).to_numpy(), trains["position_km"].to_numpy(), trains["current_a"]
    for part in np.array_split(np.arange(len(trains)), max(1, len(trains) // 2000)):
        wave = leaky_v(km[None, :], at[part, None], current.to_numpy(float)[part, None], length, 0.2)
        np.add.at(volts, (step[part], track[part]), wave)
    volts *= scale
    rows = np.zeros(len(trains), TRAIN_ROW)
    rows["time_s"], rows["train"] = trains["time_s"], [names.index(str(name)) for name in trains["train"]]
    nearest = np.rint(at / apart_km).astype(int).clip(0, len(km) - 1)
    rows["rail_v"] = volts[step, track, nearest] + 2.0 * np.sign(current)
    potential = volts.reshape(len(fed), -1)
    at_depot, at_device = potential[:, int(2.0 / apart_km)], potential[:, len(km) + int(10.0 / apart_km)]
    earth = np.stack([at_depot / 0.5, np.where(np.abs(at_device) > 100.0, at_device / 0.1, 0.0)], axis=1)
    leaving = np.maximum(potential, 0.0) @ np.array([each.leakage_s_per_m * each.length_m for each in places])
    buffers = rows_of(potential, earth, leaving)
    append = lambda name, table: tables.setdefault(name, []).append(table)  # noqa: E731
    recorder.add(time_s, buffers)
    recorder.add_trains(rows, Placed(track.astype(np.int64), at, np.ones(len(rows), np.int64)))
    recorder.write(np.arange(len(fed)), time_s, buffers, append)
    recorder.write_devices(time_s, buffers, append)
    append("rail_profile", recorder.profile())
    made = {name: parts[0] for name, parts in tables.items()}
    run = base.results.run | recorder.summary() | {"verdicts": recorder.verdicts()}
    figures = [*base.results.key_figures, *(each.as_dict() for each in recorder.figures())]
    return RailRun(scenario, Results(run, figures, base.results._source | made), recorder)

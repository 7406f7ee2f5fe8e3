"""Results of runs with trains made by hand: theoretical journeys on a made-up voltage, shared by substations."""

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from small_studies import station

from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rolling_stock import load_train
from tractionpower.kernels.train_tables import BY_VOLTAGE
from tractionpower.model.base import format_time
from tractionpower.model.quantity import unit_of
from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import theoretical_journeys
from tractionpower.results.results import Results
from tractionpower.results.tables import make_table, substations_table
from tractionpower.results.trains import CallRow, calls_table, trains_table

NO_LOAD_V = 3600.0
BIN_KM = 0.5
LIMITING_V = 2950.0


@dataclass(frozen=True)
class FakeRun:
    """A run and what it was made of."""

    scenario: Scenario
    results: Results

    def without(self, *tables: str) -> Results:
        kept = {name: self.results._source[name] for name in self.results.tables if name not in tables}
        return Results(self.results.run, self.results.key_figures, kept)


@cache
def small_run() -> FakeRun:
    """Return four trains on 20 km between two substations with a cabin, a stop, hills and a current limit."""
    line = {
        "tracks": [{"id": track, "from_km": 0.0, "to_km": 20.0} for track in ("1", "2")],
        "stations": [{"id": name[0], "name": name, "km": km} for name, km in (("Alfa", 0.0), ("Ćma", 10.0), ("Beta", 20.0))],
        "gradients": [{"from_km": 0.0, "to_km": 8.0, "permille": 4.0}, {"from_km": 8.0, "to_km": 20.0, "permille": -3.0}],
        "speed_limits": [{"from_km": 0.0, "to_km": 12.0, "kmh": 160}, {"from_km": 12.0, "to_km": 20.0, "kmh": 120}],
        "train_current_limits": [{"from_km": 0.0, "to_km": 5.0, "max_current_a": 1600.0}],
    }  # fmt: skip
    runs = [
        _run("1", "ep09-10-coaches", "1", (10.0, 20.0), start={"time": 0.0, "speed_kmh": 108}),
        _run("2", "ed250", "1", (0.0, 20.0), calls=[("A", None, 0.0), ("Ć", 330.0, 360.0), ("B", 700.0, None)]),
        _run("3/IC", "ep09-10-coaches", "2", (10.0, 0.0), start={"time": 0.0, "speed_kmh": 108}),
        _run("4", "ed250", "2", (20.0, 0.0), start={"time": 60.0}),
    ]
    supply = {"substations": [station("A", 0.0), station("B", 20.0)], "section_cabins": [{"id": "C", "km": 10.0}]}
    return fake_run(_scenario(line, supply, runs, {"start": 0.0, "end": 1200.0}, "Four trains"))


@cache
def constant_run() -> Results:
    """Return the four trains with currents at 3000 V, 20 s late."""
    run = small_run()
    trains = run.results.table("trains")
    trains["time_s"] += 20.0
    trains["current_a"], trains["voltage_v"] = trains["power_kw"] / 3.0, trains["voltage_v"] - 100.0
    ways = [way | {"finished_s": way["finished_s"] + 20.0} for way in run.results.run["trains"]]
    said = run.results.run | {"coupling": "constant_voltage", "coupling_voltage_v": 3000.0, "trains": ways}
    return Results(said, [], {"trains": pa.Table.from_pandas(trains)})


@cache
def big_run() -> FakeRun:
    """Return 120 trains in a day on 220 km with 14 substations, 13 cabins and 25 stations."""
    km = [0.0, *np.round(np.linspace(14.0, 206.0, 12) + 2.0 * np.sin(np.arange(12)), 1).tolist(), 220.0]
    line = {
        "tracks": [{"id": track, "from_km": 0.0, "to_km": 220.0} for track in ("1", "2")],
        "stations": [{"id": f"s{k}", "name": f"Station {chr(65 + k)}", "km": round(k * 220.0 / 24, 1)} for k in range(25)],
        "gradients": [
            {"from_km": 10.0 * k, "to_km": 10.0 * (k + 1), "permille": round(5.0 * np.sin(1.7 * k), 1)} for k in range(22)
        ],
        "speed_limits": [{"from_km": 55.0 * k, "to_km": 55.0 * (k + 1), "kmh": (160, 200, 120, 200)[k]} for k in range(4)],
    }
    supply = {
        "substations": [station(f"Substation {k + 1}", place) for k, place in enumerate(km)],
        "section_cabins": [{"id": f"C{k}", "km": round((a + b) / 2, 1)} for k, (a, b) in enumerate(pairwise(km), 1)],
    }  # fmt: skip
    trains = ("ed250", "ep09-10-coaches", "vectron-freight")
    runs = []
    for k in range(120):
        start = 3600.0 * 5 + 570.0 * k + 100.0 * (k % 3) if k % 4 else 720.0 * k
        route = (0.0, 220.0) if k % 2 else (220.0, 0.0)
        calls = [("s0", None, start), ("s8", start + 2500.0, start + 2560.0), ("s24", start + 5000.0, None)]
        calls = calls if k % 2 else [(name, a, d) for (_, a, d), name in zip(calls, ("s24", "s12", "s0"), strict=True)]
        runs.append(_run(f"{10000 + k}", trains[k % 3], "1" if k % 2 else "2", route, calls=calls))
    return fake_run(_scenario(line, supply, runs, {"start": 0.0, "end": 86400.0}, "A day with 120 trains"))


def _run(name: str, train: str, track: str, km: Any, *, start: Any = None, calls: Any = ()) -> dict[str, Any]:
    rows = [
        {
            "station": where,
            **({} if arrival is None else {"arrival": arrival}),
            **({} if leaves is None else {"departure": leaves}),
        }
        for where, arrival, leaves in calls
    ]
    more = {"calls": rows} if rows else {"start": start}
    return {"id": name, "train": train, "route": [{"track": track, "from_km": km[0], "to_km": km[1]}], **more}


def _scenario(line: Any, supply: Any, runs: list[Any], clock: Any, name: str) -> Scenario:
    stock = [load_train(train) for train in sorted({run["train"] for run in runs})]
    vehicles = {vehicle.id: vehicle for _, those in stock for vehicle in those}
    whole = {"from_km": 0.0, "to_km": line["tracks"][0]["to_km"]}
    wires = {
        "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
        "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
    }
    return Scenario.model_validate(
        {
            "name": name, "line": line, "supply": supply | wires, "clock": clock | {"step_s": 1.0}, "limits": shipped_limits(),
            "timetable": {"trains": runs}, "trains": [train for train, _ in stock], "vehicles": list(vehicles.values()),
        }
    )  # fmt: skip


def fake_run(scenario: Scenario) -> FakeRun:
    """Return made-up results of a scenario whose trains run on one of tracks 1 and 2 each."""
    clock = scenario.clock
    trains, calls, finished = _trains(scenario)
    current = _substation_currents(scenario, trains.to_pandas())
    time_s = clock.start + np.arange(len(current), dtype=float)
    names = [each.id for each in scenario.supply.substations]
    voltage = NO_LOAD_V - 0.12 * current
    tables = {
        "trains": trains,
        "substations": substations_table(
            time_s, names, np.full(len(names), NO_LOAD_V), np.full(len(names), np.nan), voltage, current
        ),
        "profile": _profile(scenario, trains.to_pandas(), voltage),
    }
    if calls:
        tables["calls"] = calls_table(calls)
    run = {
        "status": "complete", "study": "fake", "name": scenario.name, "steps": len(current), "start_s": clock.start,
        "end_s": clock.end, "step_s": 1.0, "coupling": "full", "verdicts": [],
        "trains": [
            {"train": key, "status": "left", "entered_s": begin, "finished_s": end}
            if end <= clock.end
            else {"train": key, "status": "on_line", "entered_s": begin, "finished_s": None}
            for key, (begin, end) in finished.items()
        ],
    }  # fmt: skip
    figures = [*_train_figures(trains.to_pandas()), *_substation_figures(names, voltage * current / 1000.0, current)]
    return FakeRun(scenario, Results(run, figures, tables))


def _trains(scenario: Scenario) -> Any:
    """Run one train of each kind and way at the nominal voltage; the others are the same, shifted in time."""
    parts, codes, calls, finished, known = [], [], [], {}, {}
    runs = sorted(scenario.timetable.trains, key=lambda run: run.id)
    for number, run in enumerate(runs):
        begin = run.start.time if run.start is not None else run.calls[0].departure
        key = (run.train, run.route, tuple(call.station for call in run.calls), run.start is not None)
        if key not in known:
            (journey,) = theoretical_journeys(scenario, runs=[run.id])
            known[key] = begin, journey
        first, journey = known[key]
        rows = journey.rows.copy()
        rows["time_s"] += begin - first
        rows = rows[rows["time_s"] < scenario.clock.end]
        parts.append(rows)
        codes.append(np.full(len(rows), number))
        finished[run.id] = begin, journey.finished_s + begin - first
        for call in journey.calls:
            planned = next(own for own in run.calls if own.station == call.station)
            for kind, plan, real in (
                ("arrival", planned.arrival, call.arrival_s),
                ("departure", planned.departure, call.departure_s),
            ):
                if plan is not None:
                    calls.append(CallRow(run.id, call.station, kind, plan, real + begin - first))
    rows, code = np.concatenate(parts), np.concatenate(codes)
    order = np.lexsort((code, rows["time_s"]))
    rows, code = rows[order], code[order]
    km = np.array([run.route[0].from_km for run in runs])[code]
    sign = np.array([1.0 if run.route[0].to_km > run.route[0].from_km else -1.0 for run in runs])[code]
    km = km + sign * rows["s_m"] / 1000.0
    _spread_voltages(scenario, rows, km)
    track = (np.array([int(run.route[0].track) - 1 for run in runs])[code], ["1", "2"])
    return trains_table(rows, (code, [run.id for run in runs]), track, km), calls, finished


def _spread_voltages(scenario: Scenario, rows: Any, km: Any) -> None:
    """Lower the voltage between substations and under load, as a network would, at the same power."""
    places = np.array([each.km for each in scenario.supply.substations])
    right = np.searchsorted(places, km).clip(1, len(places) - 1)
    low, high = places[right - 1], places[right]
    ohm = 0.06 + 0.06 * (km - low) * (high - km) / (high - low)
    free = 3550.0 - 40.0 * np.sin(rows["time_s"] / 97.0)
    rows["voltage_v"] = np.minimum(free - ohm * rows["power_w"] / 3000.0, 3780.0)
    rows["limited_by"][rows["voltage_v"] < LIMITING_V] = BY_VOLTAGE
    rows["current_a"] = rows["power_w"] / rows["voltage_v"]


def _substation_currents(scenario: Scenario, trains: pd.DataFrame) -> Any:
    """Share each train's current between its neighbouring substations by distance; shape (steps, substations)."""
    places = np.array([each.km for each in scenario.supply.substations])
    steps = round(scenario.clock.end - scenario.clock.start)
    current = np.zeros((steps, len(places)))
    km, step = trains["position_km"].to_numpy(), (trains["time_s"].to_numpy() - scenario.clock.start).astype(int)
    right = np.searchsorted(places, km).clip(1, len(places) - 1)
    share = ((km - places[right - 1]) / (places[right] - places[right - 1])).clip(0.0, 1.0)
    taken = trains["current_a"].to_numpy()
    np.add.at(current, (step, right), share * taken)
    np.add.at(current, (step, right - 1), (1.0 - share) * taken)
    return np.maximum(current, 0.0)


def _profile(scenario: Scenario, trains: pd.DataFrame, busbar_v: Any) -> Any:
    fixed = [(each.km, busbar_v[:, k]) for k, each in enumerate(scenario.supply.substations)]
    fixed += [(each.km, busbar_v[:, 0] - 60.0) for each in scenario.supply.section_cabins]
    rows = [
        (km, code, volts.min(), volts.mean(), volts.max(), len(volts), "cross_section")
        for code in (0, 1)
        for km, volts in sorted(fixed, key=lambda each: each[0])
    ]
    bins = np.floor(trains["position_km"] / BIN_KM) * BIN_KM + BIN_KM / 2
    for (track, km), volts in trains.groupby(["track", bins], observed=True)["voltage_v"]:
        rows.append((km, int(track) - 1, volts.min(), volts.mean(), volts.max(), len(volts), "pantograph"))
    km, code, low, mean, high, count, where = zip(*rows, strict=True)
    kinds = ["cross_section", "pantograph"]
    columns = {
        "km": km, "track": (code, ["1", "2"]), "lowest_voltage_v": low, "mean_voltage_v": mean, "highest_voltage_v": high,
        "count": count, "where": ([kinds.index(kind) for kind in where], kinds),
    }  # fmt: skip
    return make_table("profile", columns)


def figure(name: str, value: float, place: str = "", when_s: float | None = None) -> dict[str, Any]:
    when = "" if when_s is None else format_time(when_s)
    return {
        "name": name,
        "value": float(value),
        "unit": unit_of(name),
        "place": place,
        "time": when,
        "definition": "",
        "status": "",
    }


def _train_figures(trains: pd.DataFrame) -> list[dict[str, Any]]:
    lowest = trains.loc[trains["voltage_v"].idxmin()]
    where = f"train {lowest['train']}, track {lowest['track']}, km {lowest['position_km']:.1f}"
    figures = [figure("lowest_voltage_v", lowest["voltage_v"], where, lowest["time_s"])]
    for name, rows in trains.groupby("train", observed=True):
        place = f"train {name}"
        worst = rows.loc[rows["voltage_v"].idxmin()]
        taking = rows[rows["current_a"] > 0.0]
        useful = (taking["voltage_v"] * taking["current_a"]).sum() / taking["current_a"].sum()
        figures += [
            figure("lowest_pantograph_voltage_v", worst["voltage_v"], place, worst["time_s"]),
            figure("mean_useful_voltage_current_weighted_v", useful, place),
            figure("mean_useful_voltage_time_mean_v", taking["voltage_v"].mean(), place),
        ]
    return figures


def _substation_figures(names: list[str], power_kw: Any, current: Any) -> list[dict[str, Any]]:
    figures, hours = [], len(power_kw) / 3600.0
    sums = np.concatenate((np.zeros((1, len(names))), np.cumsum(power_kw, axis=0)))
    squares = np.concatenate((np.zeros((1, len(names))), np.cumsum(current**2, axis=0)))
    window = min(900, len(power_kw))
    mean = (sums[window:] - sums[:-window]) / window
    rms = np.sqrt((squares[window:] - squares[:-window]) / window)
    for k, name in enumerate(names):
        place = f"substation {name}"
        figures += [
            figure("highest_current_a", current[:, k].max(), place, float(current[:, k].argmax())),
            figure("rms_current_a", np.sqrt((current[:, k] ** 2).mean()), place),
            figure("highest_power_kw", power_kw[:, k].max(), place, float(power_kw[:, k].argmax())),
            figure("highest_mean_power_15_min_kw", mean[:, k].max(), place, float(mean[:, k].argmax())),
            figure("highest_rms_current_15_min_a", rms[:, k].max(), place, float(rms[:, k].argmax())),
            figure("energy_kwh", power_kw[:, k].mean() * hours, place),
        ]
    return figures

"""Random lines with a random train on them, drawn from a seed."""

import itertools
from typing import Any

import numpy as np
from small_trains import BRAKE, INVERTER, SERIES_MOTORS, TABLE, call, make_trains, passing

from tractionpower.model.scenario import Scenario

KINDS = ("inverter", "series_motors", "table")


def random_rows(rng: np.random.Generator, length_km: float, count: int, values: Any) -> list[tuple[float, float, float]]:
    """Return rows that cover a track from 1 km before to 1 km behind the route."""
    inner = np.sort(np.round(rng.uniform(0.0, length_km, count - 1), 3))
    edges = [-1.0, *np.unique(inner).tolist(), length_km + 1.0]
    return [(low, high, float(values())) for low, high in itertools.pairwise(edges)]


def random_power_off(rng: np.random.Generator, length_km: float) -> list[dict[str, Any]]:
    """Return up to four stretches without power, from 20 m to a kilometre long, which may meet or overlap."""
    starts = np.round(rng.uniform(0.3, length_km, int(rng.integers(1, 5))), 3).tolist()
    lengths = np.round(np.exp(rng.uniform(np.log(0.02), 0.0, len(starts))), 3).tolist()
    kinds = rng.choice(["neutral", "coast", "lower_pantograph"], len(starts)).tolist()
    return [
        {"from_km": low, "to_km": round(low + long, 3), "kind": kind}
        for low, long, kind in zip(starts, lengths, kinds, strict=True)
    ]


def random_study(seed: int, kind: str | None = None, **more: Any) -> Scenario:
    """Return one train on a hilly line of 4 to 12 km with limits, curves, tunnels, stops, and current limits."""
    rng = np.random.default_rng(seed)
    length = round(rng.uniform(4.0, 12.0), 3)
    kind = kind if kind is not None else KINDS[seed % 3]
    drive = {"inverter": INVERTER, "series_motors": SERIES_MOTORS, "table": TABLE}[kind]
    if kind == "inverter":
        drive = drive | {"max_current_a": float(rng.uniform(600.0, 1500.0))}
        if rng.random() < 0.3:
            drive = drive | {"pull_out_kmh": 90.0}
    if kind == "series_motors" and rng.random() < 0.5:
        drive = drive | {"relay": {"off_v": 2000.0, "on_v": 2200.0, "delay_s": 2.0}}
    low_km, high_km = np.sort(np.round(rng.uniform(0.0, length, 2), 3)).tolist()
    middle = np.sort(np.round(rng.uniform(0.2, length - 0.2, 2), 3)).tolist()
    stations = {"P": middle[0], "Q": middle[1] + 0.001, "Z": length}
    calls = [passing("P") if rng.random() < 0.5 else call("P", min_dwell_s=round(rng.uniform(0.0, 40.0), 1))]
    calls += [call("Q", min_dwell_s=20.0)] if rng.random() < 0.7 else []
    end = str(rng.choice(["leave", "stop", "stay"]))
    calls += [call("Z")] if end != "leave" else []
    plain = {
        "slopes": random_rows(rng, length, int(rng.integers(1, 8)), lambda: round(rng.uniform(-15.0, 12.0), 2)),
        "limits": random_rows(rng, length, int(rng.integers(1, 7)), lambda: round(rng.uniform(30.0, 150.0))),
        "curves": [{"from_km": low_km, "to_km": high_km + 0.1, "radius_m": float(rng.uniform(200.0, 900.0))}],
        "tunnels": [{"from_km": 0.5 * low_km, "to_km": low_km + 0.3, "kind": "single_track"}],
        "stations": stations,
        "calls": calls,
        "end": end,
        "drive": drive,
        "brake": BRAKE | {"electric_above_kmh": 5.0, "rheostat_kw": float(rng.choice([0.0, 500.0]))},
        "mass_t": float(rng.uniform(90.0, 250.0)),
        "length_m": float(rng.uniform(20.0, 400.0)),
        "rotating_mass_factor": float(rng.uniform(1.0, 1.2)),
        "resistance": {"a_n": 2500.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.6},
        "auxiliaries": {"power_kw": 60.0, "heating_kw": 40.0},
        "mass_distribution": "point" if rng.random() < 0.2 else "uniform",
    }
    if rng.random() < 0.3:
        plain["train_current_limits"] = [
            {"from_km": low_km, "to_km": high_km + 0.2, "max_current_a": 700.0, "standstill_current_a": 200.0}
        ]
    if seed % 2:
        plain["power_off"] = random_power_off(np.random.default_rng((1, seed)), length)
    return make_trains(length, **plain | more)

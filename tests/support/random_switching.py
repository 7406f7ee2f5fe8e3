"""Random studies whose supply switches while trains run: rails per track that leak, breakers, devices, events."""

from typing import Any

import numpy as np
from random_coupling import RandomCoupling

from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Supply

Row = dict[str, Any]


def random_switching(seed: int) -> Scenario:
    """Return a study of `random_coupling` with rails per track, and with all that can switch drawn over it."""
    base, rng = RandomCoupling(seed).scenario, np.random.default_rng((9, seed))
    clock, line = base.clock, base.line
    low, high = line.tracks[0].from_km, line.tracks[0].to_km
    tracks = [track.id for track in line.tracks]
    plain = base.supply.model_dump(by_alias=True)
    between = lambda a, b: round(float(rng.uniform(a, b)), 3)  # noqa: E731
    for station in [*plain["substations"], *plain["section_cabins"]]:
        station["feeder_resistance_ohm"] = between(0.001, 0.02)
        if rng.random() < 0.7:
            station |= {"trip_current_a": between(200.0, 1500.0), "trip_delay_s": float(rng.choice([0.0, 2.0, 7.5]))}
            if rng.random() < 0.8:
                station |= {"reclose_after_s": between(3.0, 30.0), "reclosures": int(rng.integers(1, 4))}
    for station in plain["substations"]:
        station["units"] = 3
    plain["return_circuit"] = [
        {"tracks": [track], "from_km": low, "to_km": high, "resistance_ohm_per_km": 0.02, "leakage_s_per_km": between(0.01, 2.0)}
        for track in tracks
    ]
    ohm = float(rng.choice([0.0, 0.002]))
    plain["bonds"] = [{"from_km": low, "to_km": high, "every_km": between(0.4, 3.0), "resistance_ohm": ohm}]
    plain["earthing"] = [{"id": "E", "track": tracks[0], "km": between(0.0, high), "resistance_ohm": between(0.1, 10.0)}]
    points = [{"above_v": between(3.0, 30.0), "after_s": between(0.0, 8.0)}, {"above_v": 60.0}]
    device: Row = {"id": "V", "track": tracks[-1], "km": between(0.0, high), "closes": points}
    plain["voltage_limiting_devices"] = [device | ({"opens_after_s": between(5.0, 50.0)} if rng.random() < 0.6 else {})]
    plain["switch_events"] = _events(rng, clock.start, clock.end, plain, tracks)
    return base.model_copy(update={"supply": Supply.model_validate(plain)})


def _events(rng: np.random.Generator, start: float, end: float, plain: Row, tracks: list[str]) -> list[Row]:
    events = {}
    for _ in range(int(rng.integers(1, 9))):
        when = round(float(rng.uniform(start - 10.0, end)), 3)
        station = plain["substations"][int(rng.integers(len(plain["substations"])))]["id"]
        change: Row = {"state": str(rng.choice(["in_service", "in_service", "rectifiers_out", "bypassed", "open"]))}
        device = station
        if rng.random() < 0.3:
            change = {"units_in_service": int(rng.integers(0, 4))}
        elif rng.random() < 0.3:
            device = f"{station} {rng.choice(tracks)} {rng.choice(['low_km', 'high_km'])}"
            change = {"state": str(rng.choice(["open", "closed"]))}
        elif plain["section_cabins"] and rng.random() < 0.4:
            device, change = "C", {"state": str(rng.choice(["closed", "bypassed", "open"]))}
        if when >= 0.0:
            events[device, when] = {"time": when, "device": device} | change
    return list(events.values())

"""Random lines, supplies and trains together, drawn from a seed."""

from typing import Any

import numpy as np
from coupled import vehicle
from random_trains import random_power_off, random_rows
from small_trains import BRAKE, INVERTER, SERIES_MOTORS, TABLE

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.scenario import Scenario

Row = dict[str, Any]

STEPS = 300
STEPS_S = (0.25, 1.0, 1.0, 2.0, 5.0)
EFFICIENCIES = [
    {"speed_kmh": speed, "load_percent": load, "efficiency": 0.9 - 0.1 * (100.0 - load) / 100.0 - 0.0005 * speed}
    for speed in (0.0, 80.0, 200.0)
    for load in (0.0, 50.0, 100.0)
]
POWERS = [
    {"voltage_v": volts, "power_kw": kw} for volts, kw in ((2000.0, 600.0), (2700.0, 1800.0), (3000.0, 3000.0), (4000.0, 3000.0))
]


class RandomCoupling:
    """One random study, a function of the seed alone: `scenario`."""

    def __init__(self, seed: int, steps: int = STEPS) -> None:
        self.rng = np.random.default_rng((7, seed))
        rng = self.rng
        self.length = round(rng.uniform(6.0, 25.0), 3)
        self.tracks = [str(k + 1) for k in range(rng.integers(1, 4))]
        self.step_s = float(rng.choice(STEPS_S))
        self.start = float(rng.choice([0.0, 0.0, 25200.0, 86300.0]))
        end = self.start + steps * self.step_s
        vehicles = [self._vehicle(k) for k in range(rng.integers(1, 5))]
        runs = [self._run(k, [str(each["id"]) for each in vehicles]) for k in range(rng.integers(2, 7))]
        self.more = np.random.default_rng((8, seed))  # what came later: the other draws stay as they were
        self.plans = np.random.default_rng((9, seed))
        for run in runs:
            self._drive(run)
        used = sorted({str(run["train"]) for run in runs})
        vehicles = [each for each in vehicles if each["id"] in used]
        self.scenario = Scenario.model_validate(
            {
                "line": self._line(),
                "supply": self._supply(),
                "clock": {"start": self.start, "end": end, "step_s": self.step_s},
                "timetable": {"trains": runs},
                "trains": [self._train(each["id"]) for each in vehicles],
                "vehicles": vehicles,
                "limits": shipped_limits(),
                "coast_without_voltage_s": float(self.more.choice([0.0, 7.3, 60.0, 120.0])),
            }
        )

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def among(self, low: float, high: float, digits: int = 3) -> float:
        return round(float(self.rng.uniform(low, high)), digits)

    # -- line and supply

    def _line(self) -> Row:
        rng, length = self.rng, self.length
        ends = {"from_km": -1.0, "to_km": length + 1.0}
        slopes = random_rows(rng, length, int(rng.integers(1, 8)), lambda: self.among(-15.0, 12.0, 2))
        speeds = random_rows(rng, length, int(rng.integers(1, 6)), lambda: self.among(30.0, 150.0, 0))
        low, high = np.sort(np.round(rng.uniform(0.0, length, 2), 3)).tolist()
        line: Row = {
            "tracks": [ends | {"id": track} for track in self.tracks],
            "stations": [{"id": f"s{k}", "km": round(k * length / 4, 3)} for k in range(5)],
            "gradients": [{"from_km": a, "to_km": b, "permille": slope} for a, b, slope in slopes],
            "speed_limits": [{"from_km": a, "to_km": b, "kmh": kmh} for a, b, kmh in speeds],
            "curves": [{"from_km": low, "to_km": high + 0.1, "radius_m": self.among(200.0, 900.0)}],
            "tunnels": [{"from_km": 0.5 * low, "to_km": low + 0.3, "kind": "double_track"}],
        }
        if self.chance(0.3):
            limit = {"max_current_a": self.among(300.0, 900.0), "standstill_current_a": self.among(20.0, 200.0)}
            line["train_current_limits"] = [{"from_km": low, "to_km": high + 0.2} | limit]
        if self.more.random() < 0.4:
            line["power_off"] = random_power_off(self.more, length)
        if self.more.random() < 0.2:  # so low that auxiliaries are cut
            limit = {"max_current_a": 400.0, "standstill_current_a": round(float(self.more.uniform(2.0, 60.0)), 1)}
            line["train_current_limits"] = [*line.get("train_current_limits", []), ends | limit]
        return line

    def _supply(self) -> Row:
        rng, length = self.rng, self.length
        ends = {"from_km": -1.0, "to_km": length + 1.0}
        middle = self.among(0.2, length - 0.2)
        contact = [
            {"from_km": low, "to_km": high, "resistance_ohm_per_km": self.among(0.02, 0.1)}
            for low, high in ((-1.0, middle), (middle, length + 1.0))
        ]
        common = ends | {"resistance_ohm_per_km": self.among(0.0, 0.03)}
        returns = [common] if self.chance(0.6) else [common | {"tracks": [track]} for track in self.tracks]
        supply: Row = {
            "substations": [self._substation(k) for k in range(rng.integers(1, 5))],
            "section_cabins": [],
            "contact_lines": contact,
            "return_circuit": returns,
            "loads": [self._load(k) for k in range(rng.integers(0, 4))] if self.chance(0.4) else [],
        }
        for k, station in enumerate(supply["substations"]):  # two at one place would be a loop without resistance
            if any(abs(station["km"] - other["km"]) < 0.002 for other in supply["substations"][:k]):
                station["feeder_resistance_ohm"] = 0.002
        if self.more.random() < 0.25:  # a stretch of one track that nothing feeds, unless a substation or cabin stands there
            low = round(float(self.more.uniform(0.5, length - 1.0)), 3)
            places = (low, round(low + float(self.more.uniform(0.05, 3.0)), 3))
            track = str(self.more.choice(self.tracks))
            points = [{"id": f"X{n}", "track": track, "km": km, "state": "open"} for n, km in enumerate(places)]
            supply["section_points"] = [point for point in points if point["km"] < length]
        if len(self.tracks) > 1 and self.chance(0.7):
            state = str(rng.choice(["closed", "closed", "bypassed"]))
            supply["section_cabins"] = [{"id": "C", "km": self.among(0.0, length), "state": state}]
        return supply

    def _substation(self, k: int) -> Row:
        rng = self.rng
        return {
            "id": f"S{k}",
            "km": self.among(0.0, self.length),
            "no_load_voltage_v": float(rng.choice([3300.0, 3600.0, self.among(2700.0, 3600.0, 1)])),
            "internal_resistance_ohm": self.among(0.03, 0.4),
            "conducts": "both" if self.chance(0.2) else "forward",
            "state": "in_service" if k == 0 or self.chance(0.75) else str(rng.choice(["rectifiers_out", "bypassed"])),
            "feeder_resistance_ohm": 0.0 if self.chance(0.5) else self.among(0.001, 0.05),
        }

    def _load(self, k: int) -> Row:
        begin = self.start + self.among(0.0, 200.0, 0)
        power = {"power_kw": self.among(-800.0, 1500.0)} if self.chance(0.7) else {"current_a": self.among(-100.0, 300.0)}
        place = {"id": f"L{k}", "track": str(self.rng.choice(self.tracks)), "km": self.among(0.0, self.length)}
        return place | power | ({"from": begin, "to": begin + 100.0} if self.chance(0.5) else {})

    # -- trains

    def _vehicle(self, k: int) -> Row:
        kind = str(self.rng.choice(["inverter", "inverter", "series_motors", "table"]))
        more = {"inverter": self._inverter, "series_motors": self._motors, "table": self._table}[kind]()
        heating = {"heating_kw": self.among(0.0, 300.0), "heating": str(self.rng.choice(["resistive", "constant_power"]))}
        return vehicle(
            f"v{k}",
            kind,
            mass_t=self.among(90.0, 600.0),
            length_m=self.among(20.0, 400.0),
            rotating_mass_factor=self.among(1.0, 1.2),
            max_speed_kmh=self.among(60.0, 160.0, 0),
            auxiliaries={} if self.chance(0.15) else {"power_kw": self.among(0.0, 150.0)} | heating,
            **more,
        )

    def _inverter(self) -> Row:
        drive: Row = INVERTER | {"max_current_a": self.among(400.0, 1500.0)}
        if self.chance(0.2):
            drive = {key: value for key, value in drive.items() if key != "efficiency"} | {"efficiency_map": EFFICIENCIES}
        elif self.chance(0.2):
            drive |= {"power_over_voltage": POWERS}
        if self.chance(0.3):
            drive |= {"pull_out_kmh": 90.0}
        brake = BRAKE | {"rheostat_kw": float(self.rng.choice([0.0, 500.0, 3000.0]))}
        brake |= {"electric_above_kmh": self.among(0.0, 20.0), "regenerates": self.chance(0.8)}
        if self.chance(0.5):
            brake |= {"electric_effort_kn": 180.0, "electric_power_kw": 4000.0}
        return {"drive": drive, "brake": brake}

    def _motors(self) -> Row:
        drive: Row = SERIES_MOTORS | {"notch_time_s": self.among(0.0, 3.0)}
        if self.chance(0.4):
            drive |= {"relay": {"off_v": 2200.0, "on_v": 2400.0, "delay_s": self.among(0.0, 3.0)}}
        if self.chance(0.3):
            drive |= {"max_current_a": self.among(300.0, 700.0), "knee_factor": 0.9}
        return {"drive": drive}

    def _table(self) -> Row:
        return {"drive": TABLE | ({"max_current_a": self.among(500.0, 1100.0)} if self.chance(0.5) else {})}

    def _train(self, name: str) -> Row:
        shape = "point" if self.chance(0.2) else "uniform"
        return {"id": name, "vehicles": [{"id": name}], "mass_distribution": shape}

    def _run(self, k: int, trains: list[str]) -> Row:
        rng = self.rng
        places = [round(n * self.length / 4, 3) for n in range(5)]
        first, last = np.sort(rng.choice(5, 2, replace=False)).tolist()
        order = list(range(first, last + 1))
        if self.chance(0.5):
            order.reverse()
        begins_at_speed = self.chance(0.3)
        calls: list[Row] = []
        for n in order:
            how = rng.random()
            if how < 0.4 and not (n == order[0] and begins_at_speed):
                calls.append({"station": f"s{n}", "min_dwell_s": self.among(0.0, 40.0, 1)})
            elif how < 0.6:
                calls.append({"station": f"s{n}", "stops": False})
        end = str(rng.choice(["leave", "stop", "stay"]))
        begin = self.start + self.among(-100.0, 0.5 * STEPS * self.step_s)
        speed = {"speed_kmh": self.among(0.0, 28.0)} if begins_at_speed else {}
        return {
            "id": f"T{k}",
            "train": str(rng.choice(trains)),
            "route": [{"track": str(rng.choice(self.tracks)), "from_km": places[order[0]], "to_km": places[order[-1]]}],
            "start": {"time": max(begin, 0.0)} | speed,
            "calls": calls,
            "end": end,
        }

    def _drive(self, run: Row) -> None:
        """Let most trains drive by rules, and be late or early at calls with a planned time."""
        rng = self.plans
        if rng.random() < 0.3:
            return
        how: Row = {"kind": "rules", "speed_percent": round(rng.uniform(40.0, 100.0), 1)}
        if rng.random() < 0.5:
            how["coast_before_stops_km"] = round(rng.uniform(0.3, 3.0), 2)
        if rng.random() < 0.4:
            ends = [run["route"][0][end] for end in ("from_km", "to_km")]
            shares = rng.uniform(0.0, 1.0, rng.integers(1, 3)).tolist()
            how["coast_from"] = [{"km": round(ends[0] + share * (ends[1] - ends[0]), 3)} for share in shares]
        if rng.random() < 0.3:
            how["coast_down_to_kmh"] = round(rng.uniform(10.0, 60.0), 1)
        if rng.random() < 0.3:
            how["effort_percent"] = round(rng.uniform(30.0, 100.0), 1)
        run["driving"] = how | {"late_after_s": round(rng.uniform(0.0, 20.0), 1)}
        if rng.random() < 0.3:
            run["max_current_a"] = round(rng.uniform(200.0, 1500.0), 1)
        place = {f"s{n}": round(n * self.length / 4, 3) for n in range(5)}
        pace = rng.uniform(8.0, 30.0)
        for call in run["calls"]:
            if rng.random() < 0.7:
                way = abs(place[call["station"]] - run["route"][0]["from_km"]) * 1e3
                call["arrival"] = round(run["start"]["time"] + 1.0 + way / pace, 1)

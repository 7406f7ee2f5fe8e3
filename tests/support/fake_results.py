"""Results made by hand, as a run would give them: a small case, one with nasty names, and a day of many trains."""

from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.quantity import unit_of
from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.results import Results
from tractionpower.results.tables import make_table

WINDOWS = ("10_s", "15_s", "1_min", "5_min", "15_min", "30_min", "60_min", "120_min", "180_min")
NASTY = ("=cmd()", "<script>alert(1)</script>", "🚆 ekspres", "+48", "-7", "@sum", "#N/A", "x" * 300)

LENGTH_KM = 40.0
STEP_S = 1.0
JOURNEY_S = 1500.0

TRAIN_FIGURES = {
    "length_km": 40.0,
    "running_time_s": 1480.0,
    "journey_time_s": JOURNEY_S,
    "mean_speed_kmh": 96.0,
    "highest_speed_kmh": 118.0,
    "energy_taken_kwh": 350.0,
    "energy_returned_kwh": 50.0,
    "auxiliary_energy_kwh": 20.0,
    "drive_loss_kwh": 40.0,
    "starting_resistor_energy_kwh": 7.0,
    "refused_energy_kwh": 3.0,
    "highest_current_a": 600.0,
    "lowest_pantograph_voltage_v": 2650.0,
    "lowest_10_s_mean_voltage_v": 2700.0,
    "late_at_end_s": 20.0,
    "mean_useful_voltage_current_weighted_v": 2950.0,
    "mean_useful_voltage_time_mean_v": 3010.0,
    "highest_pantograph_voltage_v": 3500.0,
    "mean_pantograph_voltage_v": 3200.0,
    "useful_charge_ah": 110.0,
    "time_of_useful_steps_s": 900.0,
}

SUBSTATION_FIGURES = {
    "highest_current_a": 2500.0,
    "mean_current_a": 400.0,
    "rms_current_a": 700.0,
    "highest_power_kw": 8000.0,
    "energy_kwh": 650.0,
    "highest_clock_15_min_power_kw": 3000.0,
    **{f"highest_mean_power_{window}_kw": 7500.0 / (1 + number) for number, window in enumerate(WINDOWS)},
    **{f"highest_rms_current_{window}_a": 2400.0 / (1 + number) for number, window in enumerate(WINDOWS)},
}

VEHICLE = {
    "id": "railcar",
    "kind": "multiple_unit",
    "mass_t": 100.0,
    "load_t": 20.0,
    "length_m": 60.0,
    "max_speed_kmh": 120.0,
    "rotating_mass_factor": 1.1,
    "resistance": {"a_n": 2000.0, "c_n_per_kmh2": 0.5},
    "drive": {"kind": "inverter", "starting_effort_kn": 100.0, "power_kw": 1000.0, "efficiency": 0.85, "max_current_a": 600.0},
    "auxiliaries": {"power_kw": 50.0},
}


def make_case(trains: int = 4, substations: int = 3, hours: float = 0.5, nasty: bool = False) -> tuple[Results, Scenario]:
    """Return results and scenario of `trains` on a line of 40 km, evenly spread over some hours from 06:00."""
    names = [NASTY[k % len(NASTY)] if nasty else f"{1000 + k}" for k in range(trains)]
    stations = [f"{NASTY[k % len(NASTY)][:280]} {k}" if nasty else f"Substation {k + 1}" for k in range(substations)]
    study = '=HYPERLINK("x") & \x07 <b>' if nasty else "Forty kilometres & more"
    starts = [6 * 3600.0 + k * hours * 3600.0 / trains for k in range(trains)]
    scenario = _scenario(dict(zip(names, starts, strict=True)), stations, hours, study)
    rng = np.random.default_rng(7)
    tables = {
        "trains": _trains(names, np.array(starts)),
        "calls": _calls(names, starts),
        "substations": _substations(stations, hours, rng),
        "profile": _profile(),
        "events": _events(names),
    }
    return Results(_run(scenario, names, starts), _figures(names, stations, rng), tables), scenario


def changed(results: Results, **run: Any) -> Results:
    """Return the results with other entries of ``run.json``."""
    return Results(results.run | run, results.key_figures, results._source)


def _scenario(starts: dict[str, float], stations: list[str], hours: float, study: str) -> Scenario:
    whole = {"from_km": 0.0, "to_km": LENGTH_KM}
    apart = LENGTH_KM / max(len(stations) - 1, 1)
    runs = []
    for k, (name, begin) in enumerate(starts.items()):
        first, last = "AB" if k % 2 == 0 else "BA"
        ends = {"from_km": 0.0, "to_km": LENGTH_KM} if k % 2 == 0 else {"from_km": LENGTH_KM, "to_km": 0.0}
        calls = [{"station": first, "departure": begin}, {"station": last, "arrival": begin + JOURNEY_S}]
        runs.append({"id": name, "train": "local", "route": [ends | {"track": "12"[k % 2]}], "calls": calls})
    line = {
        "name": "Line of forty kilometres",
        "source": "made by hand",
        "tracks": [whole | {"id": track} for track in "12"],
        "stations": [{"id": "A", "name": "Alfa", "km": 0.0}, {"id": "B", "name": "Łódź Bravo", "km": LENGTH_KM}],
        "gradients": [whole | {"permille": 2.5}],
        "speed_limits": [whole | {"kmh": 120.0}],
    }
    feeds = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12}
    supply = {
        "substations": [feeds | {"id": name, "km": k * apart} for k, name in enumerate(stations)],
        "section_cabins": [{"id": "C", "km": 10.0}],
        "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
        "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
        "loads": [{"id": "depot", "track": "1", "km": 4.0, "power_kw": 400.0, "from": 7 * 3600.0}],
    }
    return Scenario.model_validate(
        {
            "name": study,
            "line": line,
            "supply": supply,
            "timetable": {"trains": runs},
            "trains": [{"id": "local", "name": "Local", "vehicles": [{"id": "railcar", "count": 2, "load_percent": 50.0}]}],
            "vehicles": [VEHICLE],
            "clock": {"start": 6 * 3600.0, "end": 6 * 3600.0 + hours * 3600.0, "step_s": STEP_S},
            "limits": shipped_limits(),
        }
    )


def _coded(words: Any) -> tuple[Any, list[str]]:
    known = sorted(set(words))
    place = {word: k for k, word in enumerate(known)}
    return np.array([place[word] for word in words]), known


def _filled(table: str, rows: int, given: dict[str, Any]) -> pa.Table:
    """Return a table in which columns that are not given hold a constant."""
    columns = {}
    for column in TABLES[table]:
        constant = ([0] * rows, [""]) if column.kind == "text" else np.zeros(rows, bool if column.kind == "bool" else float)
        columns[column.name] = given.get(column.name, constant)
    return make_table(table, columns)


def _trains(names: list[str], starts: Any) -> pa.Table:
    seconds = np.arange(0.0, JOURNEY_S, STEP_S)
    code = np.repeat(np.arange(len(names)), len(seconds))
    ran = np.tile(seconds, len(names))
    order = np.argsort(starts[code] + ran, kind="stable")
    code, ran = code[order], ran[order]
    share = ran / JOURNEY_S
    given = {
        "time_s": starts[code] + ran,
        "train": (code, names),
        "track": (code % 2, ["1", "2"]),
        "position_km": np.where(code % 2 == 0, share, 1.0 - share) * LENGTH_KM,
        "speed_kmh": 96.0 + 20.0 * np.sin(9.0 * share),
        "voltage_v": 3100.0 - 400.0 * np.sin(np.pi * share) ** 2,
    }
    return _filled("trains", len(code), given)


def _calls(names: list[str], starts: list[float]) -> pa.Table:
    rows = []
    for k, (name, begin) in enumerate(zip(names, starts, strict=True)):
        end, late = begin + JOURNEY_S, 37.4 * (k % 3) - 20.0
        rows.append((name, "AB"[k % 2], "departure", begin, begin, 0.0, 0.0))
        rows.append((name, "BA"[k % 2], "arrival", end, end + late, np.nan, late))
    columns = ("train", "station", "kind", "planned_s", "actual_s", "dwell_s", "late_s")
    given = dict(zip(columns, zip(*rows, strict=True), strict=True))
    return _filled("calls", len(rows), {k: _coded(v) if isinstance(v[0], str) else np.array(v) for k, v in given.items()})


def _substations(names: list[str], hours: float, rng: np.random.Generator) -> pa.Table:
    time_s = 6 * 3600.0 + np.arange(0.0, hours * 3600.0, STEP_S)
    wandering = np.abs(np.cumsum(rng.normal(0.0, 30.0, (len(time_s), len(names))), axis=0)) + 500.0
    power = np.minimum(wandering, 9000.0)
    given = {
        "time_s": np.repeat(time_s, len(names)),
        "substation": (np.tile(np.arange(len(names)), len(time_s)), names),
        "power_kw": power.ravel(),
    }
    return _filled("substations", power.size, given)


def _profile() -> pa.Table:
    km = np.concatenate([np.linspace(0.0, LENGTH_KM, 9), np.arange(0.25, LENGTH_KM, 0.5)])
    where = np.repeat([0, 1], [9, len(km) - 9])
    both, track = np.tile(km, 2), np.repeat([0, 1], len(km))
    low = 2700.0 + 300.0 * np.abs(np.sin(both / 6.0)) + 20.0 * track
    given = {
        "km": both,
        "track": (track, ["1", "2"]),
        "where": (np.tile(where, 2), ["cross_section", "pantograph"]),
        "lowest_voltage_v": low,
        "mean_voltage_v": low + 250.0,
        "highest_voltage_v": low + 500.0,
        "count": np.full(len(both), 1800),
    }
    return _filled("profile", len(both), given)


def _events(names: list[str]) -> pa.Table:
    kinds = ("train_entered", "low_voltage", "train_left")
    rows = [(6 * 3600.0 + 10.0 * k, kind, name) for k, name in enumerate(names) for kind in kinds]
    given = {
        "time_s": np.array([row[0] for row in rows]),
        "kind": _coded([row[1] for row in rows]),
        "subject": _coded([row[2] for row in rows]),
        "track": ([0] * len(rows), ["1"]),
        "position_km": np.full(len(rows), 12.345),
        "value": np.full(len(rows), 2612.3),
        "limit": np.full(len(rows), 2000.0),
        "message": _coded([f"{kind.replace('_', ' ')}: train {name}" for _, kind, name in rows]),
    }
    return _filled("events", len(rows), given)


def _figures(names: list[str], stations: list[str], rng: np.random.Generator) -> list[dict[str, Any]]:
    figures = [_figure("lowest_voltage_v", 2612.34), _figure("source_energy_kwh", 2000.125)]
    for place in (f"train {name}" for name in names):
        own = {name: value * float(rng.uniform(0.7, 1.2)) for name, value in TRAIN_FIGURES.items()}
        own["useful_energy_kwh"] = own["mean_useful_voltage_current_weighted_v"] * own["useful_charge_ah"] / 1000.0
        own["voltage_of_useful_steps_vs"] = own["mean_useful_voltage_time_mean_v"] * own["time_of_useful_steps_s"]
        figures += [_figure(name, value, place) for name, value in own.items()]
    for place in (f"substation {name}" for name in stations):
        figures += [_figure(name, value * float(rng.uniform(0.7, 1.2)), place) for name, value in SUBSTATION_FIGURES.items()]
    for name in ("mean_useful_voltage_current_weighted_v", "mean_useful_voltage_time_mean_v"):
        figures.append(_figure(name, 2900.5, f"zone {stations[0]}–{stations[1]}"))
    return [*figures, _figure("load_energy_kwh", 100.0, "load depot")]


def _figure(name: str, value: float, place: str = "") -> dict[str, Any]:
    time = "06:20:00" if name.startswith(("highest", "lowest")) else ""
    words = f"what {name} means"
    return {"name": name, "value": value, "unit": unit_of(name), "place": place, "time": time, "definition": words, "status": ""}


LEDGERS = {
    "electric": {
        "closes": True,
        "worst_gap_w": 1.5e-4,
        "source_kwh": 2000.125,
        "regulation_kwh": 100.0,
        "train_kwh": 1600.0,
        "load_kwh": 200.0,
        "conductor_kwh": 100.125,
    },
    "mechanical": {
        "closes": True,
        "worst_gap_share": 2e-5,
        "train": "1000",
        "wheel_kwh": 1300.0,
        "kinetic_kwh": 100.0,
        "potential_kwh": 50.0,
        "resistance_kwh": 850.0,
        "brakes_kwh": 300.0,
    },
    "pantograph_to_wheel": {
        "closes": True,
        "worst_gap_share": 1e-9,
        "train": "1000",
        "line_kwh": 1600.0,
        "wheel_kwh": 1300.0,
        "drive_loss_kwh": 250.0,
        "starting_resistors_kwh": 30.0,
        "auxiliaries_kwh": 120.0,
        "recovered_kwh": 100.0,
    },
}

_FOUND = {"unit": "V", "place": "km 12.3, track 1", "time": "06:12:33", "source": "a page", "status": "secondary"}
VERDICTS = [
    _FOUND | {"name": "lowest voltage", "value": 2612.34, "limit": "u_min2", "limit_value": 2000.0, "met": True},
    _FOUND | {"name": "highest voltage", "value": 3951.0, "limit": "u_max2", "limit_value": 3900.0, "met": False},
    {
        "name": "longest spell above U_max1",
        "value": 12.0,
        "unit": "s",
        "place": "train 1001",
        "time": "06:14:00",
        "limit": "t_max2",
        "limit_value": 300.0,
        "source": "course notes",
        "status": "recalled",
        "met": True,
    },
]


def _run(scenario: Scenario, names: list[str], starts: list[float]) -> dict[str, Any]:
    return {
        "status": "complete",
        "study": "forty",
        "name": scenario.name,
        "input_hash": scenario.input_hash,
        "seed": 1,
        "versions": {"tractionpower": "0.1.0", "numpy": "2.0"},
        "wall_seconds": 12.25,
        "compile_seconds": 0.5,
        "steps": 1800,
        "worst_residual_a": 3.2e-7,
        "residual_limit_a": 1e-3,
        "mean_iterations": 2.7,
        "flagged_steps": 0,
        "coupling": "full",
        "step_s": STEP_S,
        "start_s": scenario.clock.start,
        "end_s": scenario.clock.end,
        "ledgers": LEDGERS,
        "verdicts": VERDICTS,
        "overlaps": {"count": 2, "message": "2 times two trains were on the same place of a track"},
        "notes": ["track 2 has no gradient between km 3 and 4"],
        "trains": [
            {"train": name, "status": "left" if k % 5 else "on_line", "entered_s": start, "finished_s": start + JOURNEY_S}
            for k, (name, start) in enumerate(zip(names, starts, strict=True))
        ],
    }

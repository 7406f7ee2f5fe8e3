"""Tables of ratings and of outages made by hand, on any scenario: values that look as those of a line do."""

import itertools
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.results import Results
from tractionpower.results.tables import make_table

MISSING: dict[str, Any] = {"text": "", "bool": False, "i4": 0}
GRIDS = {"normal": 0.0, "low": -320.0, "high": 180.0}
WINDOWS_S = (10.0, 60.0, 900.0, 7200.0, 0.0)
RECALLED = "IEC 60146-1-1 as recalled; the text of the standard is not at hand"


def table(name: str, rows: list[dict[str, Any]]) -> pa.Table:
    """Return an Arrow table of rows; what a row does not give is missing."""
    columns: dict[str, Any] = {}
    for column in TABLES[name]:
        values = [row.get(column.name, MISSING.get(column.kind, np.nan)) for row in rows]
        if column.kind == "text":
            known = sorted(set(values))
            columns[column.name] = (np.array([known.index(value) for value in values], int), known)
        else:
            columns[column.name] = np.array(values)
    return make_table(name, columns)


def sized(results: Results, scenario: Scenario) -> Results:
    """Return results of a run with the tables of `size`."""
    devices = _devices(scenario)
    tables = {
        "ratings": _ratings(devices),
        "peaks": _peaks(devices, scenario),
        "breakers": _breakers(devices),
        "load_duration": [
            {
                **_named(device),
                "share_percent": share,
                "current_a": device["rated_current_a"] * device["use"] * 1.8 / (1.0 + share / 8.0),
            }
            for device in devices
            for share in (0.0, 0.1, 1.0, 5.0, 20.0, 50.0, 100.0)
        ],
        "demand": _demand(scenario),
        "sharing": _sharing(scenario),
        "useful_voltage": _useful(scenario),
        "voltage_durations": _durations(scenario),
    }
    source = dict(results._source) | {name: table(name, rows) for name, rows in tables.items()}
    failing = [row["device"] for row in tables["ratings"] if row.get("ruling") and row["met"] == "no"]
    said = {"kind": "size", "size": {"verdict": "fail" if failing else "pass", "failing": failing}}
    return Results(results.run | said, results.key_figures, source, scenario)


def _devices(scenario: Scenario) -> list[dict[str, Any]]:
    """Return units, substations, feeders, contact line and rails with a rated current that some of them pass."""
    stations = sorted(scenario.supply.substations, key=lambda each: each.km)
    found = []
    for k, each in enumerate(stations):
        at = {"station": each.id, "from_km": each.km, "to_km": each.km}
        found.append(at | {"device": f"{each.id} unit", "kind": "unit", "rated_current_a": 1200.0, "use": 0.6 + 0.15 * (k % 8)})
        found.append(at | {"device": each.id, "kind": "substation", "rated_current_a": 2400.0, "use": 0.5 + 0.06 * (k % 7)})
        for j, (track, side) in enumerate((track, side) for track in "12" for side in ("low_km", "high_km")):
            use = 0.35 + 0.05 * ((3 * k + j) % 11)
            name = f"{each.id} {track} {side}"
            found.append(at | {"device": name, "kind": "feeder", "track": track, "rated_current_a": 1500.0, "use": use})
    for k, (low, high) in enumerate(itertools.pairwise(stations)):
        ends = {"from_km": low.km, "to_km": high.km}
        for track in "12":
            name = f"track {track} km {low.km:g}-{high.km:g}"
            found.append(
                ends | {"device": name, "kind": "contact_line", "track": track, "rated_current_a": 1900.0, "use": 0.3 + 0.04 * k}
            )
        name = f"rails 1 2 km {low.km:g}-{high.km:g}"
        found.append(ends | {"device": name, "kind": "rails", "track": "1 2", "rated_current_a": np.nan, "use": 0.3})
    return found


def _named(device: dict[str, Any]) -> dict[str, Any]:
    return {"device": device["device"], "kind": device["kind"]}


def _ratings(devices: list[dict[str, Any]]) -> list[dict[str, Any]]:
    rows = []
    for device in devices:
        rated, own = device["rated_current_a"], []
        for number, window in enumerate(WINDOWS_S):
            load = (1800.0 if np.isnan(rated) else rated) * device["use"] * (1.6 - 0.3 * number)
            permitted = rated * {10.0: 3.0, 60.0: 2.0, 900.0: 1.7, 7200.0: 1.5, 0.0: 1.0}[window]
            use = 100.0 * load / permitted
            own.append(
                device | {
                    "window_s": window, "load_a": load, "permitted_a": permitted, "utilisation_percent": use,
                    "from_s": 7.5 * 3600.0 + 60.0 * number, "left_a": permitted - load,
                    "met": "" if np.isnan(use) else "yes" if use <= 100.0 else "no", "duty_class": "VI",
                    "status": "" if np.isnan(use) else "recalled", "source": "" if np.isnan(use) else RECALLED,
                }
            )  # fmt: skip
        if not np.isnan(rated):
            max(own, key=lambda row: row["utilisation_percent"])["ruling"] = True
        rows += own
    return rows


def _peaks(devices: list[dict[str, Any]], scenario: Scenario) -> list[dict[str, Any]]:
    trains = [run.id for run in scenario.runs][:3] or ["1"]
    rows = []
    for device in devices:
        if np.isnan(device["rated_current_a"]):
            continue
        peak = device["rated_current_a"] * device["use"] * 1.8
        for part, train in zip((0.6, 0.3, 0.1), [*trains[:2], ""], strict=False):
            rows.append(
                _named(device) | {
                    "peak_a": peak, "peak_s": 27_000.0, "train": train, "train_current_a": peak * part * 1.2, "track": "1",
                    "position_km": device["from_km"] + 2.0 if train else np.nan, "part_a": peak * part,
                }
            )  # fmt: skip
    return rows


def _breakers(devices: list[dict[str, Any]]) -> list[dict[str, Any]]:
    rows = []
    for device in devices:
        if device["kind"] != "feeder":
            continue
        peak = device["rated_current_a"] * device["use"] * 1.8
        for level in (50.0, 80.0, 100.0):
            longest = max(0.0, peak - 30.0 * level) / 50.0
            rows.append(
                {
                    "device": device["device"], "setting_a": 3000.0, "peak_a": peak, "peak_s": 27_000.0,
                    "share_percent": peak / 30.0, "level_percent": level, "longest_s": longest, "total_s": 3.0 * longest,
                    "met": "yes",
                }
            )  # fmt: skip
    return rows


def _demand(scenario: Scenario) -> list[dict[str, Any]]:
    clock = scenario.clock
    quarters = np.arange(clock.start - clock.start % 900.0, clock.end, 900.0)
    rows = []
    for k, each in enumerate(scenario.supply.substations):
        contract = 2200.0 if k % 2 else np.nan
        for at in quarters:
            power = 800.0 + 100.0 * k + 900.0 * np.sin(at / 86400.0 * np.pi) ** 2
            met = "" if np.isnan(contract) else "yes" if power <= contract else "no"
            rows.append({"supply_point": each.id, "from_s": at, "power_kw": power, "contract_power_kw": contract, "met": met})
    return rows


def _zones(scenario: Scenario) -> list[tuple[str, str, str]]:
    names = [each.id for each in sorted(scenario.supply.substations, key=lambda each: each.km)]
    return [(f"{low} - {high}", low, high) for low, high in itertools.pairwise(names)]


def _sharing(scenario: Scenario) -> list[dict[str, Any]]:
    rows = []
    for k, (zone, *both) in enumerate(_zones(scenario)):
        for number, name in enumerate(both):
            share = 44.0 + k if number == 0 else 56.0 - k
            rows.append(
                {"zone": zone, "substation": name, "mean_current_a": 4.0 * share, "share_percent": share,
                 "highest_current_a": 40.0 * share}
            )  # fmt: skip
    return rows


def _useful(scenario: Scenario) -> list[dict[str, Any]]:
    clock, rows = scenario.clock, []
    hours = np.arange(clock.start - clock.start % 3600.0, clock.end, 3600.0)
    windows = [("run", clock.start, clock.end), *(("hour", at, at + 3600.0) for at in hours)]
    for k, (zone, _, _) in enumerate(_zones(scenario)):
        for window, begin, end in windows:
            weighted = 3150.0 - 90.0 * (k % 6) - 150.0 * np.sin((begin + end) / 2 / 86400.0 * np.pi) ** 2
            empty = window == "hour" and begin < 2 * 3600.0
            rows.append(
                {
                    "kind": "zone", "subject": zone, "window": window, "from_s": begin, "to_s": end,
                    "current_weighted_v": np.nan if empty else weighted, "time_mean_v": np.nan if empty else weighted + 120.0,
                    **({} if empty else _sums(weighted, weighted + 120.0)),
                    "trains": 0 if empty else 12, "left_out": 1, "limit_v": 2700.0,
                    "met": "" if empty else "yes" if weighted >= 2700.0 else "no",
                }
            )  # fmt: skip
    for k, run in enumerate(scenario.runs):
        weighted = 3000.0 - (37.0 * k) % 350.0
        rows.append(
            {
                "kind": "train", "subject": run.id, "window": "run", "from_s": clock.start, "to_s": clock.end,
                "current_weighted_v": weighted, "time_mean_v": weighted + 100.0, "trains": 1, "limit_v": 2700.0,
                **_sums(weighted, weighted + 100.0),
                "met": "yes" if weighted >= 2700.0 else "no",
            }
        )  # fmt: skip
    return rows


def _sums(weighted: float, mean: float) -> dict[str, float]:
    return {"power_sum_kw": 1.2 * weighted, "current_sum_a": 1200.0, "voltage_time_vs": 730.0 * mean, "counted_s": 730.0}


BANDS = (
    ("below U_min2", np.nan, 2000.0, 0.0), ("U_min2 to U_n", 2000.0, 3000.0, np.nan), ("U_n to U_max1", 3000.0, 3600.0, np.nan),
    ("U_max1 to U_max2", 3600.0, 3900.0, 300.0), ("above U_max2", 3900.0, np.nan, 0.0),
)  # fmt: skip


def _durations(scenario: Scenario) -> list[dict[str, Any]]:
    rows = []
    for train in ["", *(run.id for run in scenario.runs)]:
        for band, low, high, permitted in BANDS:
            total = {"U_min2 to U_n": 1200.0, "U_n to U_max1": 3600.0, "U_max1 to U_max2": 90.0}.get(band, 0.0)
            rows.append(
                {
                    "train": train, "band": band, "from_v": low, "to_v": high, "total_s": total, "share_percent": total / 48.9,
                    "longest_s": total / 3.0, "longest_from_s": 28_000.0 if total else np.nan, "permitted_s": permitted,
                    "met": "" if np.isnan(permitted) else "yes",
                }
            )  # fmt: skip
    return rows


def outages(scenario: Scenario, grids: tuple[str, ...] = ("normal", "low", "high"), *, feeders: bool = True) -> Results:
    """Return results of a study of outages: of every unit, substation, cabin and, if wanted, feeder of a scenario."""
    cases = [
        _case(kind, subject, mode, km, depth, grid, number)
        for number, (kind, subject, mode, km, depth) in enumerate(_outages(scenario, feeders))
        for grid in grids
    ]
    computed = [case for case in cases if case["status"] in ("complete", "flagged")]
    tables: dict[str, list[dict[str, Any]]] = {"cases": cases}
    tables["case_profile"] = [
        {"case": case["case"], "track": track, "km": km, "lowest_voltage_v": volts + 15.0 * (track == "2")}
        for case in computed
        for track in "12"
        for km, volts in zip(*_profile(scenario, case), strict=True)
    ]
    tables["case_rails"] = [
        {"case": case["case"], "track": "1 2", "km": km, "lowest_potential_v": -0.03 * (3500.0 - volts),
         "highest_potential_v": 0.02 * (3500.0 - volts)}
        for case in computed
        for km, volts in zip(*_profile(scenario, case), strict=True)
    ]  # fmt: skip
    tables["case_trains"] = [row for case in computed for row in _late(scenario, case)]
    tables["case_devices"] = [row for case in computed for row in _case_devices(scenario, case)]
    tables["envelope"] = _envelope(tables)
    tables["device_envelope"] = _device_envelope(tables)
    counts = [sum(case["status"] == status for case in cases) for status in ("complete", "flagged", "refused", "failed")]
    run = {
        "format": 1, "status": "flagged", "study": "study", "name": scenario.name, "kind": "contingency", "seed": 0,
        "input_hash": scenario.input_hash, "versions": {"tractionpower": "0.0"}, "wall_seconds": 321.0, "workers": 2,
        "cases": dict(zip(("all", "complete", "flagged", "refused", "failed", "reused"), (len(cases), *counts, 0), strict=True)),
        "verdicts": [_verdict(min(case["lowest_voltage_v"] for case in computed))],
    }  # fmt: skip
    return Results(run, [], {name: table(name, rows) for name, rows in tables.items()}, scenario)


def _verdict(lowest: float) -> dict[str, Any]:
    return {
        "name": "lowest voltage", "value": lowest, "unit": "V", "place": "track 1, km 80.2", "time": "07:30:00",
        "limit": "u_min2", "limit_value": 2000.0, "source": "EN 50163 table as quoted", "status": "secondary",
        "met": lowest >= 2000.0,
    }  # fmt: skip


def _outages(scenario: Scenario, feeders: bool) -> list[tuple[str, str, str, float, float]]:
    """Return kind, subject, mode, place [km] and how much voltage each outage costs at its place [V]."""
    stations = sorted(scenario.supply.substations, key=lambda each: each.km)
    found = [("base", "", "", 0.0, 0.0)]
    found += [("unit", f"{each.id} unit", "1 of 2", each.km, 120.0 + 9.0 * k) for k, each in enumerate(stations)]
    found += [("substation", each.id, "bypassed", each.km, 500.0 + 47.0 * k) for k, each in enumerate(stations)]
    cabins = sorted(scenario.supply.section_cabins, key=lambda each: each.km)
    found += [("section_cabin", each.id, "bypassed", each.km, 80.0 + 5.0 * k) for k, each in enumerate(cabins)]
    if feeders:
        sides = [(track, side) for track in "12" for side in ("low_km", "high_km")]
        found += [
            ("feeder", f"{each.id} {track} {side}", "open", each.km, 200.0 + 11.0 * k)
            for k, each in enumerate(stations)
            for track, side in sides
        ]
    return found


def _case(kind: str, subject: str, mode: str, km: float, depth: float, grid: str, number: int) -> dict[str, Any]:
    name = (f"{subject} {mode}" if subject else "base") + (f", grid {grid}" if grid != "normal" else "")
    case: dict[str, Any] = {"case": name, "kind": kind, "subject": subject, "mode": mode, "grid": grid, "status": "complete"}
    if number == 20 and grid == "high":
        return case | {"status": "failed", "reason": "RuntimeError: the worker process died twice"}
    if number == 30 and grid == "high":
        return case | {"status": "refused", "reason": "supply.substations[X]: a contradiction\nanother one"}
    lowest = 2950.0 - depth + GRIDS[grid]
    late = max(0, round((2500.0 - lowest) / 60.0)) if kind in ("substation", "base") else 0
    return case | {
        "lowest_voltage_v": lowest, "lowest_voltage_track": "1", "lowest_voltage_km": km, "lowest_voltage_s": 27_000.0,
        "highest_voltage_v": 3550.0 + GRIDS[grid], "useful_zone_v": lowest + 250.0, "useful_zone": "A - B",
        "useful_train_v": lowest + 180.0, "useful_train": "1", "rail_potential_v": 60.0 + depth / 10.0, "rail_potential_km": km,
        "late_trains": late, "worst_late_s": 40.0 * late if late else 0.2, "worst_late_train": "1", "energy_kwh": 250_000.0,
        "line_loss_kwh": 20_000.0 + depth, "highest_demand_kw": 5000.0 + depth, "utilisation_percent": 70.0 + depth / 12.0,
        "utilisation_device": f"{subject or 'base'} unit", "overloaded": int(70.0 + depth / 12.0 > 100.0),
        "trips": int(depth > 900.0), "flagged_steps": 3 if number == 15 else 0,
        "status": "flagged" if number == 15 else "complete", "reason": "3 steps did not converge" if number == 15 else "",
        "depth": depth,
    }  # fmt: skip


def _profile(scenario: Scenario, case: dict[str, Any]) -> tuple[Any, Any]:
    """Return places and lowest voltages: a sag between substations, and that of the outage around its place."""
    ends = [each.km for each in scenario.supply.substations]
    km = np.arange(min(ends) + 0.25, max(ends), 0.5)
    apart = np.abs(km[:, None] - np.array(ends)).min(axis=1)
    sag = 40.0 * np.minimum(apart, 10.0)
    outage = case["depth"] * np.exp(-(((km - case["lowest_voltage_km"]) / 15.0) ** 2)) if case["kind"] != "base" else 0.0
    volts = 3350.0 - sag - outage + GRIDS[case["grid"]]
    if case["kind"] == "section_cabin":
        volts[np.abs(km - case["lowest_voltage_km"]) < 1.0] = np.nan
    return km, volts


def _late(scenario: Scenario, case: dict[str, Any]) -> list[dict[str, Any]]:
    rows = []
    for k, run in enumerate(scenario.runs):
        late = max(0.0, 40.0 * (case["late_trains"] - k)) if k < case["late_trains"] else 0.2
        rows.append(
            {"case": case["case"], "train": run.id, "late_s": late, "added_late_s": max(0.0, late - 0.2),
             "status": "late" if late > 1.0 else "on time"}
        )  # fmt: skip
    return rows


def _case_devices(scenario: Scenario, case: dict[str, Any]) -> list[dict[str, Any]]:
    rows = []
    for device in _devices(scenario):
        rated = device["rated_current_a"]
        near = np.exp(-(((device["from_km"] - case["lowest_voltage_km"]) / 20.0) ** 2)) * case["depth"] / 1500.0
        load = (1000.0 if np.isnan(rated) else rated) * (device["use"] + near)
        rows.append(
            _named(device) | {
                "case": case["case"], "peak_a": 2.0 * load, "peak_s": 27_000.0, "rms_a": 0.5 * load, "window_s": 900.0,
                "load_a": load, "permitted_a": rated, "utilisation_percent": 100.0 * load / rated, "from_s": 26_000.0,
                "met": "" if np.isnan(rated) else "yes" if load <= rated else "no",
            }
        )  # fmt: skip
    return rows


def _envelope(tables: dict[str, list[dict[str, Any]]]) -> list[dict[str, Any]]:
    found: dict[Any, dict[str, Any]] = {}
    worse = {"voltage": -1.0, "rail_potential": 1.0}
    profile = [(row, "voltage", row["lowest_voltage_v"]) for row in tables["case_profile"]]
    rails = [(row, "rail_potential", max(-row["lowest_potential_v"], row["highest_potential_v"])) for row in tables["case_rails"]]
    for row, quantity, volts in [*profile, *rails]:
        own = found.setdefault(
            (row["track"], row["km"], quantity),
            {"track": row["track"], "km": row["km"], "quantity": quantity, "worst_v": np.nan, "base_v": np.nan, "case": ""},
        )
        if row["case"] == "base":
            own["base_v"] = volts
        if not volts * worse[quantity] <= own["worst_v"] * worse[quantity]:
            own |= {"worst_v": volts, "case": row["case"]} if not np.isnan(volts) else {}
    return list(found.values())


def _device_envelope(tables: dict[str, list[dict[str, Any]]]) -> list[dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    for row in tables["case_devices"]:
        own = found.setdefault(row["device"], row | {"base_percent": row["utilisation_percent"], "peak_case": row["case"]})
        if row["utilisation_percent"] > own["utilisation_percent"]:
            own |= {key: row[key] for key in ("utilisation_percent", "window_s", "load_a", "permitted_a", "met", "case")}
        if row["peak_a"] > own["peak_a"]:
            own |= {"peak_a": row["peak_a"], "peak_case": row["case"]}
    return list(found.values())

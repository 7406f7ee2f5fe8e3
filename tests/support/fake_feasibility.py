"""Verdicts on the timetables of results made by hand: delays, sections and lost seconds that fit their calls."""

from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import DELAY_PARTS, ORIGIN_PARTS, TABLES
from tractionpower.results.results import Results
from tractionpower.results.tables import make_table

TOLERANCE_S = 1.0

REMEDIES: dict[str, Any] = {
    "remedies": [
        {
            "kind": "departure_shift", "subject": "1001", "size": 60.0, "unit": "s", "words": "Train 1001 leaves 60 s later.",
            "changes": ["timetable.trains[1001].calls[0].departure=06:06:00"], "feasible": True, "verified": True,
            "lateness_after_s": 0.2, "lost_before_s": 24.6, "lost_after_s": 12.0, "cost": 60.0,
        },
        {
            "kind": "power_cap", "subject": "=cmd()", "size": 50.0, "unit": "%", "words": "Train =cmd(): power capped.",
            "changes": ["timetable.trains[=cmd()].max_power_kw=700"], "feasible": False, "verified": False,
            "lateness_after_s": 4.9, "lost_before_s": 24.6, "lost_after_s": None, "cost": 50.0,
        },
    ],
    "sensitivities": [
        {"kind": "no_load_voltage", "subject": "Substation 1", "per": "+1 %", "lost_s_change": -6.2, "change": ["x"]},
    ],
    "search": {"tried": 73, "interrupted": False, "notes": ["Smallest means cheapest."]},
}  # fmt: skip


def judged(results: Results, scenario: Scenario, delays_s: dict[str, dict[str, float]], **more: Any) -> Results:
    """Return results with verdicts.

    Parameters
    ----------
    results, scenario
        Results with calls.
    delays_s
        For trains that are late at their last timed call: seconds by where they arose.
    more
        Further entries of ``feasibility`` in ``run.json``.
    """
    calls = results.table("calls")
    rows = [_delay(row, delays_s, calls) for _, row in calls[calls["planned_s"].notna()].iterrows()]
    sections = [_section(name, own, delays_s.get(name, {})) for name, own in _by_train(rows)]
    lost = _lost(sections, scenario)
    tables = {"delays": rows, "sections": sections, "lost_time": lost}
    source = dict(results._source) | {name: _table(name, items) for name, items in tables.items()}
    said = {"feasibility": _verdict(sections, lost, delays_s) | more}
    return Results(results.run | said, results.key_figures, source)


def _delay(row: Any, delays_s: dict[str, dict[str, float]], calls: pd.DataFrame) -> dict[str, Any]:
    train = str(row["train"])
    last = row.name == calls[calls["train"] == row["train"]].index[-1]
    origins = delays_s.get(train, {}) if last else {}
    delay = float(sum(origins.values()))
    parts = {f"{part}_s": origins.get(part, 0.0) for part in DELAY_PARTS}
    return {
        "train": train, "station": str(row["station"]), "kind": str(row["kind"]), "planned_s": float(row["planned_s"]),
        "actual_s": float(row["planned_s"]) + delay, "delay_s": delay, **parts,
        "cause": max(origins, key=lambda name: origins[name]) if delay > TOLERANCE_S else "",
        **{f"origin_{part}_s": origins.get(part, 0.0) for part in ORIGIN_PARTS},
    }  # fmt: skip


def _by_train(rows: list[dict[str, Any]]) -> list[tuple[str, list[dict[str, Any]]]]:
    return [(name, [row for row in rows if row["train"] == name]) for name in dict.fromkeys(row["train"] for row in rows)]


def _section(train: str, rows: list[dict[str, Any]], origins: dict[str, float]) -> dict[str, Any]:
    first, last = rows[0], rows[-1]
    planned, lost = last["planned_s"] - first["planned_s"], origins.get("voltage", 2.0)
    shortest = planned - 15.0 - lost + origins.get("voltage", 0.0)
    return {
        "train": train, "from_station": first["station"], "to_station": last["station"], "from_km": 0.0, "to_km": 10.0,
        "planned_s": planned, "shortest_s": shortest, "limited_s": shortest, "recorded_s": shortest + lost,
        "actual_s": planned + last["delay_s"], "reserve_s": planned - shortest, "reserve_left_s": planned - shortest - lost,
        "lost_voltage_s": lost, "lost_current_s": 0.0, "worst_track": "1", "worst_km": 5.5, "area": "",
        "lowest_voltage_v": 2412.0,
    }  # fmt: skip


def _lost(sections: list[dict[str, Any]], scenario: Scenario) -> list[dict[str, Any]]:
    stations = sorted((station.km, station.id) for station in scenario.supply.substations)
    rows = []
    for section in sections:
        for km, share in ((1.5, 0.3), (5.5, 0.6), (9.5, 0.1)):
            area = min(stations, key=lambda station: abs(station[0] - km))[1]
            rows.append(
                {"train": section["train"], "track": "1", "km": km, "area": area, "lost_s": share * section["lost_voltage_s"]}
            )
    return rows


def _verdict(sections: list[dict[str, Any]], lost: list[dict[str, Any]], delays_s: dict[str, dict[str, float]]) -> dict[str, Any]:
    trains = [_train(section, delays_s.get(section["train"], {})) for section in sections]
    late = sorted((train for train in trains if train["verdict"] == "infeasible"), key=lambda train: -train["late_s"])
    frame = pd.DataFrame(lost)
    areas = frame.groupby("area").agg(lost_s=("lost_s", "sum"), trains=("train", "nunique")).reset_index()
    first = None
    if late:
        first = {"train": late[0]["train"], "station": late[0]["worst_station"], "late_s": late[0]["late_s"]}
        first |= {"cause": late[0]["cause"], "area": late[0]["lost_area"], "why": late[0]["why"]}
    return {
        "verdict": "infeasible" if late else "feasible", "reserve_left_s": min(train["reserve_left_s"] for train in trains),
        "tolerance_s": TOLERANCE_S, "late_trains": len(late), "first": first, "trains": trains,
        "lost_by_area": areas.sort_values("lost_s", ascending=False).to_dict("records"),
    }  # fmt: skip


def _train(section: dict[str, Any], origins: dict[str, float]) -> dict[str, Any]:
    late = float(sum(origins.values()))
    why = f"late {late:.0f} s at {section['to_station']}: {late:.0f} s lost" if late else "on time"
    return {
        "train": section["train"], "verdict": "infeasible" if late > TOLERANCE_S else "feasible",
        "reserve_left_s": section["reserve_left_s"], "reserve_left_at": f"{section['from_station']}–{section['to_station']}",
        "worst_station": section["to_station"], "late_s": late, "why": why,
        "cause": max(origins, key=lambda name: origins[name]) if origins else "",
        "shortest_s": section["shortest_s"], "running_time_ratio": section["recorded_s"] / section["limited_s"],
        "mean_useful_voltage_current_weighted_v": 2900.0, "mean_useful_voltage_time_mean_v": None,
        "lost_voltage_s": section["lost_voltage_s"], "lost_area": "Substation 1",
    }  # fmt: skip


def _table(name: str, rows: list[dict[str, Any]]) -> Any:
    columns: dict[str, Any] = {}
    for column in TABLES[name]:
        values = [row[column.name] for row in rows]
        if column.kind == "text":
            names = sorted(set(values))
            columns[column.name] = (np.array([names.index(value) for value in values]), names)
        else:
            columns[column.name] = np.array(values, float)
    return make_table(name, columns)

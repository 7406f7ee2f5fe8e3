"""What ``run.json`` says of the outages: the N-1 table in short, and the devices that do not hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tractionpower.model.contingency import OUTAGE_KINDS
from tractionpower.model.scenario import Scenario
from tractionpower.results.key_figures import KeyFigure
from tractionpower.studies.cases.judgement import Check, failures
from tractionpower.studies.contingency.envelope import DeviceEnvelope
from tractionpower.studies.contingency.outages import BASE, GRIDS
from tractionpower.studies.runner.case import COMPLETE
from tractionpower.studies.runner.outcomes import CasesRun
from tractionpower.supply.ratings import Rating

Row = Mapping[str, Any]

KINDS = (*OUTAGE_KINDS, "pair")

MOST_TOLD = 30
"""Worst cases, and devices, that are told; the tables have all."""

FIGURES = ("lowest_voltage_v", "lowest_voltage_track", "lowest_voltage_km", "lowest_voltage_s", "useful_zone_v", "useful_zone",
           "rail_potential_v", "rail_potential_km", "utilisation_percent", "utilisation_device", "overloaded", "late_trains",
           "worst_late_s", "worst_late_train", "stuck_trains", "dark_trains", "unfinished_trains", "unserved_loads",
           "unserved_load_s", "blackout_s", "contract_share_percent", "contract_point", "breaker_share_percent",
           "breaker_device", "trips")  # fmt: skip
LABELS = ("case", "kind", "subject", "mode", "grid", "status", "reason")


def summary_of(
    scenario: Scenario,
    checks: Sequence[Check],
    run: CasesRun,
    devices: DeviceEnvelope,
    ratings: Mapping[str, Rating],
    notes: Sequence[str],
) -> dict[str, Any]:
    """Return the summary of a study of outages.

    Parameters
    ----------
    scenario
        The base.
    checks
        What cases are held against.
    run, devices
        What was found.
    ratings
        Ratings by device.
    notes
        Outages that were not looked at, and why.
    """
    rows = [row for row in run.rows if row["lowest_voltage_v"] is not None or row["energy_kwh"] is not None]
    base = {row["grid"]: set(failures(checks, row)) for row in rows if row["kind"] == BASE}
    told = [_told(checks, row, base.get(row["grid"], set())) for row in rows]
    outages = [row for row in told if row["kind"] != BASE]
    outages.sort(key=_severity)
    is_whole = len(run.rows) == len(run.cases) and all(row["status"] == COMPLETE for row in run.rows)
    fails = any(row["fails"] for row in told)
    return {
        "verdict": "fails" if fails else "holds" if is_whole else "not judged",
        "base": [row for row in told if row["kind"] == BASE],
        "worst": outages[:MOST_TOLD],
        "kinds": _by_kind(outages),
        "outages": _counts(outages),
        "failing": sum(bool(row["fails"]) for row in outages),
        "failing_beyond_base": sum(bool(row["added"]) for row in outages),
        "not_computed": [{key: row[key] for key in LABELS} for row in run.rows if row["status"] in ("refused", "failed")],
        "devices": _failing_devices(devices, ratings),
        "unrated": _unrated(devices),
        "notes": list(notes),
        "tolerance_s": scenario.feasibility.tolerance_s,
    }


def _told(checks: Sequence[Check], row: Row, base: set[str]) -> dict[str, Any]:
    """Return what is told of a case: its figures, what it violates, and which of that the base case does not."""
    fails = failures(checks, row)
    added = [word for word in fails if row["kind"] == BASE or word not in base]
    return {key: row[key] for key in (*LABELS, *FIGURES)} | {"fails": list(fails), "added": added}


def _severity(row: Row) -> tuple[Any, ...]:
    """Return by what the worst cases come first: what they add to the base case, what they violate, the voltage."""
    volts = row["lowest_voltage_v"]
    return -len(row["added"]), -len(row["fails"]), volts is None, volts or 0.0, row["case"]


def _counts(cases: Sequence[Row]) -> dict[str, int]:
    """Return how many outages there are, whatever the grid voltage, how many fail, and how many at more than the base."""
    found: dict[tuple[str, ...], tuple[bool, bool]] = {}
    for row in cases:
        key = row["kind"], row["subject"], row["mode"]
        fails, adds = found.get(key, (False, False))
        found[key] = fails or bool(row["fails"]), adds or bool(row["added"])
    failing, beyond = (sum(each[k] for each in found.values()) for k in (0, 1))
    return {"all": len(found), "failing": failing, "beyond_base": beyond}


def _by_kind(outages: Sequence[Row]) -> list[dict[str, Any]]:
    """Return for each kind of outage and grid voltage how many there are, how many fail, and the lowest voltage."""
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for row in outages:
        key = row["kind"], row["grid"]
        group = found.setdefault(
            key, {"kind": key[0], "grid": key[1], "cases": 0, "failing": 0, "lowest_voltage_v": None, "case": ""}
        )
        group["cases"] += 1
        group["failing"] += bool(row["fails"])
        volts = row["lowest_voltage_v"]
        if volts is not None and (group["lowest_voltage_v"] is None or volts < group["lowest_voltage_v"]):
            group |= {"lowest_voltage_v": volts, "case": row["case"]}
    return [found[key] for key in sorted(found, key=lambda key: (GRIDS.index(key[1]), KINDS.index(key[0])))]


def _failing_devices(devices: DeviceEnvelope, ratings: Mapping[str, Rating]) -> list[dict[str, Any]]:
    """Return the devices that do not hold in some case, the most loaded first."""
    rows = [row for row in devices.rows() if row["met"] == "no"]
    rows.sort(key=lambda row: -(row.get("utilisation_percent") or 0.0))
    keys = ("device", "kind", "utilisation_percent", "window_s", "load_a", "permitted_a", "case")
    return [
        {key: row.get(key) for key in keys}
        | {"source": ratings[row["device"]].source, "status": ratings[row["device"]].status}
        | {"cases": len(devices.failing[row["device"]]), "in_base": BASE in devices.failing[row["device"]]}
        for row in rows[:MOST_TOLD]
    ]


def _unrated(devices: DeviceEnvelope) -> dict[str, int]:
    """Return how many devices of each kind have no rating."""
    counts: dict[str, int] = {}
    for row in devices.rows():
        if not row["met"]:
            counts[row["kind"]] = counts.get(row["kind"], 0) + 1
    return counts


def figures_of(checks: Sequence[Check], verdicts: Sequence[Mapping[str, Any]], rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the key figures: the worst of each figure that has a limit, by the verdicts, and the greatest rail potential."""
    names = {check.name: check.figure for check in checks}
    figures = []
    for said in verdicts:
        what = f"{said['name']}, worst of all cases"
        figures.append(KeyFigure(names[said["name"]], said["value"], said["place"], said["time"], what, said["status"]))
    known = [row for row in rows if row.get("rail_potential_v") is not None]
    if known:
        worst = max(known, key=lambda row: row["rail_potential_v"])
        place = f"{worst['case']}: km {worst['rail_potential_km']:.2f}"
        what = "magnitude of the rail potential, greatest of all cases"
        figures.append(KeyFigure("rail_potential_v", worst["rail_potential_v"], place, definition=what))
    return [figure.as_dict() for figure in figures]

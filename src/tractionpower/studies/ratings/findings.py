"""What a study of ratings comes to: the verdict on the devices, which fail, what is left, what nobody has rated."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from tractionpower.model.limits import Limit
from tractionpower.model.scenario import Scenario
from tractionpower.model.sizing import Sizing
from tractionpower.studies.ratings.use import Use
from tractionpower.studies.ratings.useful import DEFINITIONS, LowestUseful
from tractionpower.studies.ratings.words import KINDS, counted, window_words

PASS, FAIL, NOT_RATED = "pass", "fail", "not rated"

Row = dict[str, Any]


class Findings(NamedTuple):
    """What was found of a run.

    Attributes
    ----------
    ruling
        Of each device its use in the window that rules.
    breakers, demand
        Of each feeder with a setting, and of each supply point, the row that is the worst.
    useful, useful_limit
        Lowest mean useful voltages, and what they are held against.
    seconds
        How long the run counts [s].
    """

    ruling: tuple[Use, ...]
    breakers: tuple[Row, ...]
    demand: tuple[Row, ...]
    useful: tuple[LowestUseful, ...]
    useful_limit: Limit | None
    seconds: float

    @property
    def verdict(self) -> str:
        """pass, fail or not rated: devices against ratings, feeders against settings, demand against contracts."""
        met = [use.met for use in self.ruling] + [row["met"] for row in (*self.breakers, *self.demand)]
        if "no" in met:
            return FAIL
        return PASS if any(use.met for use in self.ruling) else NOT_RATED

    @property
    def by_utilisation(self) -> tuple[Use, ...]:
        """The uses of rated devices, the highest utilisation first."""
        rated = (use for use in self.ruling if use.met)
        return tuple(sorted(rated, key=lambda use: (-round(use.utilisation_percent, 6), use.device.id)))

    @property
    def worst(self) -> dict[str, Use]:
        """Of each kind of devices that have a rating the one with the highest utilisation."""
        found: dict[str, Use] = {}
        for use in self.by_utilisation:
            found.setdefault(use.device.kind, use)
        return {kind: found[kind] for kind in KINDS if kind in found}

    @property
    def unrated(self) -> dict[str, list[str]]:
        """Devices without a rating, by kind."""
        found: dict[str, list[str]] = {}
        for use in self.ruling:
            if not use.met:
                found.setdefault(use.device.kind, []).append(use.device.id)
        return {kind: found[kind] for kind in KINDS if kind in found}


def worst_breakers(rows: Sequence[Row]) -> tuple[Row, ...]:
    """Return of each feeder whose breaker trips a row of table ``breakers``, the greatest share of the setting first."""
    first = {row["device"]: row for row in rows if math.isfinite(row["setting_a"])}
    return tuple(sorted(first.values(), key=lambda row: (-round(row["share_percent"], 6), row["device"])))


def worst_demand(rows: Sequence[Row]) -> tuple[Row, ...]:
    """Return of each supply point the row of table ``demand`` with the highest power, by supply point."""
    highest: dict[str, Row] = {}
    for row in rows:
        known = highest.get(row["supply_point"])
        if known is None or row["power_kw"] > known["power_kw"]:
            highest[row["supply_point"]] = row
    return tuple(highest[point] for point in sorted(highest))


def size_notes(scenario: Scenario, found: Findings) -> dict[str, Any]:
    """Return what ``run.json`` says under ``size``."""
    study = scenario.sizing
    return {
        "verdict": found.verdict,
        "permitted_percent": study.utilisation_percent,
        "devices": len(found.ruling),
        "rated": len(found.by_utilisation),
        "failing": [use.device.id for use in found.by_utilisation if use.met == "no"],
        "failing_breakers": [row["device"] for row in found.breakers if row["met"] == "no"],
        "failing_contracts": [row["supply_point"] for row in found.demand if row["met"] == "no"],
        "worst": [_told(use) for use in found.worst.values()],
        "breakers": {
            "permitted_percent": study.breaker_percent,
            "set": len(found.breakers),
            "worst": _breaker(found.breakers[0]) if found.breakers else None,
        },
        "demand": [_known(row) for row in found.demand],
        "useful_voltage": _useful(study, found),
        "unrated": found.unrated,
        "notes": list(_notes(found)),
    }


def _told(use: Use) -> Row:
    return _known(
        {
            "kind": use.device.kind, "device": use.device.id, "utilisation_percent": use.utilisation_percent,
            "window_s": use.window_s, "load_a": use.load_a, "permitted_a": use.permitted_a, "left_a": use.left_a,
            "from_s": use.from_s, "met": use.met, "status": use.rating.status,
        }
    )  # fmt: skip


def _breaker(row: Row) -> Row:
    return _known({name: row[name] for name in ("device", "peak_a", "setting_a", "share_percent", "peak_s", "trips", "met")})


def _useful(study: Sizing, found: Findings) -> Row:
    limit = found.useful_limit
    return {
        "line_class": study.useful_voltage.line_class,
        "limit_v": None if limit is None else limit.value,
        "status": "" if limit is None else limit.status,
        "shortest_stay_s": study.useful_voltage.shortest_stay_s,
        "lowest": [each._asdict() | {"definition": DEFINITIONS[each.definition]} for each in found.useful],
    }


def _known(row: Mapping[str, Any]) -> Row:
    """Return a row as JSON has it: no number is null."""
    return {name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in row.items()}


def _notes(found: Findings) -> Iterator[str]:
    """Yield what a reader of the ratings has to know."""
    windows = {window_s for use in found.by_utilisation for window_s, _ in use.rating.windows}
    longer = sorted(window_s for window_s in windows if window_s > found.seconds * (1.0 + 1e-9))
    if longer:
        words = ", ".join(map(window_words, longer))
        yield f"windows longer than what counts of the run, {found.seconds:g} s, are held against the whole of it: {words}"
    if found.unrated:
        yield "without a rating, not judged: " + ", ".join(counted(len(ids), kind) for kind, ids in found.unrated.items())
    recalled = {use.device.kind for use in found.by_utilisation if use.rating.status == "recalled"}
    if recalled:
        words = ", ".join(KINDS[kind] for kind in KINDS if kind in recalled)
        yield f"held against recalled values, which the user may replace: {words}"

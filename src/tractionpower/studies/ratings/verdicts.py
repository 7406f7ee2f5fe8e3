"""Verdicts and key figures of a study of ratings, each with the status of what it is held against."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from tractionpower.model.base import format_time
from tractionpower.model.scenario import Scenario
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import sense_of_limit
from tractionpower.results.words import yes_or_no
from tractionpower.studies.ratings.findings import Findings, Row
from tractionpower.studies.ratings.use import Use
from tractionpower.studies.ratings.useful import DEFINITIONS, useful_figures
from tractionpower.studies.ratings.words import KINDS, window_words

ZONES = "mean useful voltage of zones"
"""How the verdicts on zones begin, those of a run and those here."""


class _Limit(NamedTuple):
    name: str
    value: float
    status: str
    source: str


def size_verdicts(scenario: Scenario, found: Findings) -> Iterator[Row]:
    """Yield the verdicts: of each kind of devices that with the highest utilisation, feeders, contracts, zones."""
    study = scenario.sizing
    for kind, use in found.worst.items():
        limit = _Limit("utilisation_percent", study.utilisation_percent, use.rating.status, use.rating.source)
        place = f"{use.device.id}, {window_words(use.window_s)}"
        yield _verdict(f"utilisation of {KINDS[kind]}", (use.utilisation_percent, "%"), (place, _begin(use)), limit, use.met)
    for row in found.breakers[:1]:
        limit = _Limit("breaker_percent", study.breaker_percent, "user", "settings of the inputs")
        name = "peak of feeders, of the setting of the breaker"
        yield _verdict(name, (row["share_percent"], "%"), (row["device"], format_time(row["peak_s"])), limit, row["met"])
    for row in found.demand:
        if row["met"]:
            limit = _Limit("contract_power_kw", row["contract_power_kw"], "user", "contract of the inputs")
            where = (f"supply point {row['supply_point']}", format_time(row["from_s"]))
            yield _verdict("highest demand of a quarter of an hour", (row["power_kw"], "kW"), where, limit, row["met"])
    yield from _zones(scenario, found)


def _zones(scenario: Scenario, found: Findings) -> Iterator[Row]:
    if found.useful_limit is None:
        return
    given, shortest_s = found.useful_limit, scenario.sizing.useful_voltage.shortest_stay_s
    limit = _Limit(given.name, given.value, given.status, given.source)
    words = {"run": "", "hour": ", worst hour", "given": ", worst given part of the day"}
    for each in found.useful:
        if each.kind == "zone":
            name = f"{ZONES}, {DEFINITIONS[each.definition]}{words[each.window]} (of trains there for {shortest_s:g} s or more)"
            met = yes_or_no(each.value_v >= limit.value - TOLERANCE_V)
            yield _verdict(name, (each.value_v, "V"), (f"zone {each.subject}", each.when), limit, met)


def _verdict(name: str, value: tuple[float, str], where: tuple[str, str], limit: _Limit, met: str) -> Row:
    return {
        "name": name, "value": value[0], "unit": value[1], "place": where[0], "time": where[1], "limit": limit.name,
        "limit_value": limit.value, "source": limit.source, "status": limit.status,
        "sense": sense_of_limit(limit.name), "met": met == "yes",
    }  # fmt: skip


def _begin(use: Use) -> str:
    """Return when the window of a use begins; empty for the whole run."""
    return "" if use.window_s == 0.0 else format_time(use.from_s)


def size_figures(found: Findings) -> Iterator[KeyFigure]:
    """Yield the key figures of the study."""
    for kind, use in found.worst.items():
        told = f"highest of all {KINDS[kind]}: RMS current over {window_words(use.window_s)}, of what the rating permits"
        yield KeyFigure("utilisation_percent", use.utilisation_percent, use.device.id, _begin(use), told, use.rating.status)
    for row in found.breakers[:1]:
        told = "highest of all feeders: highest mean of a step, of the setting of the breaker"
        yield KeyFigure("breaker_share_percent", row["share_percent"], row["device"], format_time(row["peak_s"]), told, "user")
    for row in found.demand:
        place, told = f"supply point {row['supply_point']}", "highest mean of a quarter of an hour by the clock, from the grid"
        yield KeyFigure("highest_demand_kw", row["power_kw"], place, format_time(row["from_s"]), told)
    yield from useful_figures(found.useful, found.useful_limit)

"""Kinds of devices in words, and zones and supply points in their order along the line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.studies.ratings.words import window_words

KINDS = {
    "unit": mark("Rectifier units"),
    "substation": mark("Substations"),
    "feeder": mark("Feeders"),
    "return_feeder": mark("Return feeders"),
    "cabin_feeder": mark("Feeders of section cabins"),
    "switch": mark("Switches"),
    "contact_line": mark("Sections of contact line"),
    "rails": mark("Sections of rails"),
    "supply_point": mark("Supply points"),
}
"""Kinds of devices in words, in the order of sheets and figures."""


_NAMED = {
    "unit": mark("{device} unit"),
    "return": mark("{device} return"),
    "low_km": mark("{device} low_km"),
    "high_km": mark("{device} high_km"),
    "bypassed": mark("{device} bypassed"),
    "blocked": mark("{device} blocked"),
}
"""How the program names devices of a station, and outages of it."""
_NAME = re.compile(rf"([^,;:()]*[^,;:() ]) ({'|'.join(_NAMED)})(?=$|[,;:)])")


def counted_devices(number: int, kind: str) -> str:
    """Return how many devices of a kind there are, in words.

    >>> counted_devices(1, "return_feeder"), counted_devices(2, "switch"), counted_devices(1, "rails")
    ('1 return feeder', '2 switches', '1 section of rails')
    """
    words = KINDS.get(kind, f"{kind.replace('_', ' ')}s").lower()
    if number == 1:
        head, blank, tail = words.partition(" of ")
        words = f"{head.removesuffix('es' if head.endswith('ches') else 's')}{blank}{tail}"
    return f"{number} {words}"


def device_told(name: object) -> str:
    """Return the name that the program gives a device, or a place that names one, in the language of the report.

    >>> device_told("Psary 1 low_km"), device_told("track 1 km 0-9.5, whole run")
    ('Psary 1 low_km', 'track 1 km 0-9.5, whole run')
    """
    return _NAME.sub(lambda found: tr(_NAMED[found[2]], device=found[1]), recorded(str(name)))


def kind_told(kind: str) -> str:
    """Return a kind of devices in the language of the report.

    >>> kind_told("rails")
    'Rail sections'
    """
    return tr(KINDS.get(kind, kind))


def window_told(seconds: float) -> str:
    """Return the length of a window in the language of the report; 0 is the whole run.

    >>> window_told(900.0), window_told(0.0)
    ('15 min', 'whole run')
    """
    return window_words(seconds) if seconds > 0.0 else tr("whole run")


def kind_order(kind: str) -> int:
    """Return the place of a kind of devices among all kinds."""
    return list(KINDS).index(kind) if kind in KINDS else len(KINDS)


def supply_points_along_line(scenario: Scenario, names: Iterable[str]) -> list[str]:
    """Return supply points in the order of the first substation that each feeds."""
    first: dict[str, float] = {}
    for station in sorted(scenario.supply.substations, key=lambda station: (station.km, station.id)):
        for name in (station.supply_point or station.id, station.id):
            first.setdefault(name, station.km)
    return sorted(dict.fromkeys(names), key=lambda name: (first.get(name, float("inf")), name))


def zones_along_line(scenario: Scenario, substations: Mapping[str, Iterable[str]]) -> list[str]:
    """Return zones, each given with its substations, in the order of the kilometres of these."""
    km = {station.id: station.km for station in scenario.supply.substations}
    return sorted(substations, key=lambda zone: (sorted(km.get(name, float("inf")) for name in substations[zone]), zone))

"""The train consist: number, position, lading weight and type of the vehicles. The paper omits its format; this one is ours.

The locomotive and the cars become vehicles as everywhere in this program. Running resistance is the Canadian National
form as train-propulsion-simulator (lnaz01) has it, 1.5 + 18 n/w + 0.03 V + C A V²/(10000 w) [lb/ton], with n axles, w
short tons, V [mile/h] and A [ft²].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.arshad.columns import Cells, Column, number, read_sheet
from tractionpower.io.arshad.settings import Settings
from tractionpower.io.arshad.units import FOOT_M, LB_PER_TON, MILE_KM, POUND_N
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import Source
from tractionpower.io.wording import did_you_mean, shown

LOCOMOTIVE = "locomotive"

_TYPES = {
    "locomotive": LOCOMOTIVE, "loco": LOCOMOTIVE, "car": "wagon", "wagon": "wagon", "gondola": "wagon", "hopper": "wagon",
    "boxcar": "wagon", "box car": "wagon", "flatcar": "wagon", "flat car": "wagon", "tank car": "wagon", "coach": "coach",
}  # fmt: skip
_POSITION = Column("position", ("Position",), "count", unit="")
_NUMBER = Column("number", ("Number",), "count", unit="")
_TYPE = Column("type", ("Type",))
_LADING = Column("lading", ("Lading Weight",), "mass")
_TARE = Column("tare", ("Tare Weight",), "mass")
_LENGTH = Column("length", ("Length",), "length")
_AXLES = Column("axles", ("Axles",), "count", unit="")
_EFFORT = Column("effort", ("Tractive Effort",), "force", False)
_POWER = Column("power", ("Power",), "power", False)
_ELECTRIC = Column("electric", ("Dynamic Brake Effort",), "force", False)
_ELECTRIC_POWER = Column("electric_power", ("Dynamic Brake Power",), "power", False)
_AREA = Column("area", ("Frontal Area",), "area", False)
_DRAG = Column("drag", ("Drag Coefficient",), "number", False, "")
_SPEED = Column("max_speed", ("Greatest Speed",), "speed", False)
COLUMNS = (
    _POSITION, _NUMBER, _TYPE, _LADING, _TARE, _LENGTH, _AXLES, _EFFORT, _POWER, _ELECTRIC, _ELECTRIC_POWER, _AREA, _DRAG,
    _SPEED,
)  # fmt: skip

_CONSTANT_LB_PER_TON, _AXLE_LB = 1.5, 18.0
_DRAG_LOCOMOTIVE, _DRAG_LOADED, _DRAG_EMPTY = 24.0, 4.2, 12.0
_AREA_LOCOMOTIVE_M2, _AREA_CAR_M2 = 160.0 * FOOT_M**2, 105.0 * FOOT_M**2
_LEAST, _MOST = 1e-6, 1e6
"""Bounds of all figures in the units of the declarations; only what no vehicle has lies beyond."""

_SPEED_MPS = 70.0 * MILE_KM / 3.6
"""Greatest speed where nothing is said: 70 mile/h, assumed; nothing depends on it."""


@dataclass(frozen=True, slots=True)
class Consist:
    """A consist as read.

    Attributes
    ----------
    vehicles
        Plain data of the vehicles, one for each row.
    parts
        Plain data of the parts of the train, likewise.
    mark
        Lines of the rows.
    length_m
        Length of the train.
    cars, locomotives
        How many there are.
    has_electric
        Whether a locomotive has a dynamic brake.
    """

    vehicles: list[dict[str, Any]]
    parts: list[dict[str, Any]]
    mark: Mark
    length_m: float
    cars: int
    locomotives: int
    has_electric: bool


def read_consist(reader: Reader, source: Source, settings: Settings) -> Consist | None:
    """Read a consist; None if it has errors, which `reader` collects.

    A row is `Number` equal vehicles from the place `Position` of the train on, the front of which is 1.
    """
    sheet = read_sheet(reader, source, COLUMNS)
    if sheet is None:
        return None
    problems: list[Problem] = []
    values = [_values(cells, problems) for cells in sheet.rows]
    if not problems:
        _check_places(list(zip(sheet.rows, values, strict=True)), problems)
    reader.problems += problems
    if problems:
        return None
    rows = sorted(zip(sheet.rows, values, strict=True), key=lambda row: row[1]["position"])
    mark = Mark(source.label, 0, {k: Mark(source.label, cells.line) for k, (cells, _) in enumerate(rows)})
    kinds = [_kind(cells) for cells, _ in rows]
    counts = [int(value["number"]) for _, value in rows]
    names = _names(rows)
    return Consist(
        [_vehicle(name, cells, value, settings) for name, (cells, value) in zip(names, rows, strict=True)],
        [_part(name, cells, value, settings) for name, (cells, value) in zip(names, rows, strict=True)],
        mark,
        sum(value["length"] * value["number"] for _, value in rows),
        sum(count for kind, count in zip(kinds, counts, strict=True) if kind != LOCOMOTIVE),
        sum(count for kind, count in zip(kinds, counts, strict=True) if kind == LOCOMOTIVE),
        any("electric" in value for _, value in rows),
    )


def _values(cells: Cells, problems: list[Problem]) -> dict[str, float]:
    values = {}
    for column in COLUMNS:
        value = number(cells, column, problems)
        at_least_0 = column in (_LADING, _DRAG)
        if value is not None and not (0.0 if at_least_0 else _LEAST) <= value <= _MOST:
            allowed = f"{'at least 0' if at_least_0 else 'above 0'}, at most {_MOST:g}"
            problems.append(cells.problem(column.name, "out_of_bounds", shown(cells.texts[column.name]), allowed))
        elif value is not None:
            values[column.name] = value
        elif column.required and column.name not in cells.texts:
            problems.append(cells.problem(column.name, "missing_value", "nothing", column.spellings[0], "fill the cell"))
    word = cells.texts.get("type", "")
    if word and word.lower() not in _TYPES:
        allowed = ", ".join(dict.fromkeys(name.capitalize() for name in _TYPES))
        problems.append(cells.problem("type", "unknown_word", shown(word), allowed, did_you_mean(word, _TYPES)))
    elif word and _kind(cells) == LOCOMOTIVE:
        for column in (_EFFORT, _POWER):
            if column.name not in cells.texts:
                told = f"no {column.spellings[0]} of a locomotive"
                problems.append(cells.problem(column.name, "missing_value", told, remedy=f"add {column.spellings[0]} (UNIT)"))
    if ("electric" in values) != ("electric_power" in values):
        found = "the effort or the power of a dynamic brake alone"
        problems.append(cells.problem("electric", "missing_value", found, "both, or neither"))
    return values


def _check_places(rows: list[tuple[Cells, dict[str, float]]], problems: list[Problem]) -> None:
    expected = 1
    for cells, values in sorted(rows, key=lambda row: row[1]["position"]):
        place = int(values["position"])
        if place != expected:
            found = f"the position {place}"
            allowed = f"{expected}, behind the vehicles before it"
            remedy = "a row takes Number places from Position on"
            problems.append(cells.problem("position", "bad_position", found, allowed, remedy))
        expected = place + int(values["number"])


def _kind(cells: Cells) -> str:
    return _TYPES[cells.texts["type"].lower()]


def _names(rows: list[tuple[Cells, dict[str, float]]]) -> list[str]:
    """Return what the vehicles of the rows are called: their type, with a letter where several rows have it.

    A number would be taken for the place of the vehicle in the train, which stands before its name in all results.
    """
    words = [cells.texts["type"].lower().replace(" ", "-") for cells, _ in rows]
    names = []
    for k, word in enumerate(words):
        names.append(f"{word}-{_letters(words[:k].count(word))}" if words.count(word) > 1 else word)
    return names


def _letters(place: int) -> str:
    """Return a letter for a place, counted from 0; two behind the 26th.

    >>> _letters(0), _letters(25), _letters(26)
    ('a', 'z', 'aa')
    """
    return (_letters(place // 26 - 1) if place >= 26 else "") + chr(ord("a") + place % 26)


def _vehicle(name: str, cells: Cells, values: dict[str, float], settings: Settings) -> dict[str, Any]:
    is_locomotive = _kind(cells) == LOCOMOTIVE
    vehicle: dict[str, Any] = {
        "id": name,
        "name": cells.texts["type"],
        "kind": _kind(cells),
        "mass_t": values["tare"],
        "load_t": values["lading"],
        "length_m": values["length"],
        "max_speed_kmh": 3.6 * values.get("max_speed", _SPEED_MPS),
        "axles": int(values["axles"]),
        "rotating_mass_factor": 1.0 + settings.number("rotating"),
        "resistance": _resistance(values, settings, is_locomotive=is_locomotive),
    }
    return vehicle | ({"adhesive_mass_t": values["tare"]} if is_locomotive else {})


def _resistance(values: dict[str, float], settings: Settings, *, is_locomotive: bool) -> dict[str, float]:
    rolling = settings.optional("rolling")
    car_drag = _DRAG_LOADED if values["lading"] > 0.0 else _DRAG_EMPTY
    common = settings.optional("drag")
    drag = values.get("drag", common if common is not None else _DRAG_LOCOMOTIVE if is_locomotive else car_drag)
    area_ft2 = values.get("area", _AREA_LOCOMOTIVE_M2 if is_locomotive else _AREA_CAR_M2) / FOOT_M**2
    return {
        # The part by axles is a force for each axle, whatever the weight.
        "a_n": _AXLE_LB * POUND_N * values["axles"] if rolling is None else 0.0,
        "specific_a_n_per_kn": _CONSTANT_LB_PER_TON * LB_PER_TON if rolling is None else rolling,
        "specific_b_n_per_kn_per_kmh": settings.number("speed_resistance"),
        "c_n_per_kmh2": drag * area_ft2 / 10_000.0 * POUND_N / MILE_KM**2,
    }


def _part(name: str, cells: Cells, values: dict[str, float], settings: Settings) -> dict[str, Any]:
    part: dict[str, Any] = {"id": name, "count": int(values["number"]), "load_percent": 100.0}
    if _kind(cells) == LOCOMOTIVE:
        part["traction"] = {
            "levels": int(settings.number("notches")),
            "starting_effort_kn": values["effort"],
            "power_kw": values["power"],
            "law": "quadratic_power",
            "time_constant_s": 0.0,
        }
        if "electric" in values:
            part["electric_brake"] = {"effort_kn": values["electric"], "power_kw": values["electric_power"]}
    return part

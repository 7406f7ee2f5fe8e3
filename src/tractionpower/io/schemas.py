"""JSON schemas of the input files, for editors and other programs; made from the declarations."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from tractionpower.errors import UsageError
from tractionpower.io.wording import did_you_mean, shown
from tractionpower.model.conductors import Conductor
from tractionpower.model.dynamics.case import Case
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.measured import MeasuredMap
from tractionpower.model.ratings import DutyRow, RectifierUnit
from tractionpower.model.report import Report
from tractionpower.model.scenario import StudyFile
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle

_MODELS: dict[str, type[BaseModel]] = {
    "study": StudyFile,
    "line": Line,
    "supply": Supply,
    "timetable": Timetable,
    "train": Train,
    "vehicle": Vehicle,
    "limits": Limit,
    "conductors": Conductor,
    "duty_classes": DutyRow,
    "rectifier_units": RectifierUnit,
    "measured": MeasuredMap,
    "report": Report,
    "case": Case,
    "stations": StationsCase,
    "coupling": Coupling,
}

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_CSV_NAME = {"type": "string", "pattern": r"\.[cC][sS][vV]$", "description": "Name of a CSV file that holds the list."}


def schema_names() -> tuple[str, ...]:
    """Return the kinds of input files."""
    return tuple(_MODELS)


def schema(name: str) -> dict[str, Any]:
    """Return the JSON schema of a kind of input file; those of tables such as ``limits`` are one row of the CSV file.

    Raises
    ------
    UsageError
        If there is no such kind.
    """
    if name not in _MODELS:
        hint = did_you_mean(name, _MODELS)
        known = f"known are {', '.join(_MODELS)}"
        raise UsageError("; ".join(part for part in (f"there is no schema {shown(name)}", hint, known) if part))
    made = _MODELS[name].model_json_schema(by_alias=True)
    for node in (made, *made.get("$defs", {}).values()):
        if "properties" in node:
            node["properties"] = {key: _or_csv(child) for key, child in node["properties"].items()}
    return {"$schema": _DIALECT, **made}


def _or_csv(node: dict[str, Any]) -> dict[str, Any]:
    # A list of declarations may stand in a CSV file; a list of names may not.
    if node.get("type") != "array" or "$ref" not in node.get("items", {}):
        return node
    outer: dict[str, Any] = {key: node[key] for key in ("title", "description", "default") if key in node}
    inner = {key: value for key, value in node.items() if key not in outer}
    return {"anyOf": [inner, _CSV_NAME], **outer}

"""What was computed, kept with its results: a scenario, or a case of train dynamics, as canonical JSON."""

from __future__ import annotations

import hashlib
import importlib
import json
from pathlib import Path
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.model.base import Declaration

SCENARIO_FILE = "scenario.json"
SCENARIOS = {"dynamics": ("dynamics.case", "DynamicsScenario"), "stations": ("dynamics.stations", "StationsCase")}
"""Module and name of what was computed, by the kind that ``run.json`` says; of all other kinds it is a `Scenario`."""


def read_scenario_file(path: Path, kind: str = "") -> Any:
    """Return the scenario that was kept with results of that kind.

    Raises
    ------
    UsageError
        If this version does not understand it.
    """
    module, name = SCENARIOS.get(kind, ("scenario", "Scenario"))
    try:
        model: type[Declaration] = getattr(importlib.import_module(f"tractionpower.model.{module}"), name)
        return model.model_validate_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # also what pydantic raises
        raise UsageError(f"{path}: not a scenario of this version of tractionpower; run the study again") from error


def input_hash_of(scenario: Declaration) -> str:
    """Return the SHA-256 of the canonical JSON of what is computed, whatever its files were called."""
    return hashlib.sha256(canonical_json(scenario).encode()).hexdigest()


def canonical_json(scenario: Declaration) -> str:
    """Return the text whose SHA-256 is the input hash of what is computed."""
    return json.dumps(scenario.model_dump(mode="json", by_alias=True), sort_keys=True, separators=(",", ":"), ensure_ascii=False)

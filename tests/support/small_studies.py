"""Small scenarios made in two lines, and their runs."""

from typing import Any

from tractionpower.cosimulation.run import Run
from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Outcome
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter

STATION = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12}
LENGTH_KM = 20.0


def station(name: str, km: float, **more: Any) -> dict[str, Any]:
    return {"id": name, "km": km, **STATION, **more}


def load(name: str, km: float = 5.0, track: str = "1", **more: Any) -> dict[str, Any]:
    demand = {} if "current_a" in more else {"power_kw": 3000.0}
    return {"id": name, "track": track, "km": km, **demand, **more}


def make_scenario(*loads: dict[str, Any], clock: dict[str, Any] | None = None, **more: Any) -> Scenario:
    """Return two tracks of 20 km with substations A and B at the ends and the cabin C in the middle; all can be replaced."""
    tracks = more.pop("tracks", ("1", "2"))
    whole = {"from_km": 0.0, "to_km": LENGTH_KM}
    supply = {
        "substations": [station("A", 0.0), station("B", LENGTH_KM)],
        "section_cabins": [{"id": "C", "km": 10.0}] if len(tracks) > 1 else [],
        "contact_lines": [whole | {"resistance_ohm_per_km": 0.05}],
        "return_circuit": [whole | {"resistance_ohm_per_km": 0.01}],
        "loads": list(loads),
    }
    outer = {key: more.pop(key) for key in ("output", "seed", "name") if key in more}
    return Scenario.model_validate(
        {
            "line": {"tracks": [whole | {"id": track} for track in tracks]},
            "supply": supply | more,
            "clock": {"start": 0.0, "end": 10.0, "step_s": 1.0} | (clock or {}),
            "limits": shipped_limits(),
            **outer,
        }
    )


def run_in_memory(scenario: Scenario) -> tuple[Results, Outcome, Run]:
    """Run a scenario and return its results, its outcome and the run itself."""
    writer = MemoryWriter()
    run = Run(scenario, writer, "test")
    outcome = run.execute()
    return Results(outcome.run, outcome.key_figures, writer.tables()), outcome, run

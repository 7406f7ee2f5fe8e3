"""Co-simulation of electric-traction power supply and train movement.

The names below are what notebooks and scripts need; all other modules may change. They are loaded when first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tractionpower.cosimulation.check import check_scenario as check
    from tractionpower.cosimulation.simulate import simulate
    from tractionpower.dynamics.simulate import simulate_case
    from tractionpower.dynamics.traindyn.core import TrainDynamics
    from tractionpower.dynamics.traindyn.polyline import Polyline
    from tractionpower.dynamics.traindyn.train import DynTrain
    from tractionpower.errors import InputError, OutputError, Problem, TractionPowerError, UsageError
    from tractionpower.io.dynamics_files import load_case
    from tractionpower.io.library import change
    from tractionpower.io.scenario_files import load
    from tractionpower.io.scenario_files import save_scenario as save
    from tractionpower.model.dynamics.point_mass import TrainCharacteristics
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.results import Results
    from tractionpower.results.selection.select import select
    from tractionpower.results.selection.selection import Selection
    from tractionpower.studies.compare.study import compare
    from tractionpower.studies.contingency.study import contingency
    from tractionpower.studies.feasibility.study import feasibility
    from tractionpower.studies.journeys import journeys
    from tractionpower.studies.ratings.study import size
    from tractionpower.studies.sweep.study import sweep

_HOMES = {
    "DynTrain": ("dynamics.traindyn.train", "DynTrain"),
    "InputError": ("errors", "InputError"),
    "OutputError": ("errors", "OutputError"),
    "Polyline": ("dynamics.traindyn.polyline", "Polyline"),
    "Problem": ("errors", "Problem"),
    "Results": ("results.results", "Results"),
    "Scenario": ("model.scenario", "Scenario"),
    "Selection": ("results.selection.selection", "Selection"),
    "TractionPowerError": ("errors", "TractionPowerError"),
    "TrainCharacteristics": ("model.dynamics.point_mass", "TrainCharacteristics"),
    "TrainDynamics": ("dynamics.traindyn.core", "TrainDynamics"),
    "UsageError": ("errors", "UsageError"),
    "change": ("io.library", "change"),
    "check": ("cosimulation.check", "check_scenario"),
    "compare": ("studies.compare.study", "compare"),
    "contingency": ("studies.contingency.study", "contingency"),
    "feasibility": ("studies.feasibility.study", "feasibility"),
    "journeys": ("studies.journeys", "journeys"),
    "load": ("io.scenario_files", "load"),
    "load_case": ("io.dynamics_files", "load_case"),
    "save": ("io.scenario_files", "save_scenario"),
    "select": ("results.selection.select", "select"),
    "simulate": ("cosimulation.simulate", "simulate"),
    "simulate_case": ("dynamics.simulate", "simulate_case"),
    "size": ("studies.ratings.study", "size"),
    "sweep": ("studies.sweep.study", "sweep"),
}

__all__ = [
    "DynTrain",
    "InputError",
    "OutputError",
    "Polyline",
    "Problem",
    "Results",
    "Scenario",
    "Selection",
    "TractionPowerError",
    "TrainCharacteristics",
    "TrainDynamics",
    "UsageError",
    "change",
    "check",
    "compare",
    "contingency",
    "feasibility",
    "journeys",
    "load",
    "load_case",
    "save",
    "select",
    "simulate",
    "simulate_case",
    "size",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    return getattr(import_module(f"{__name__}.{module}"), attribute)


def __dir__() -> list[str]:
    return sorted(__all__)

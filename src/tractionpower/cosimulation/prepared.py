"""Checks and tables of trains kept from one scenario to the next: of many variants of a supply the trains are the same."""

from __future__ import annotations

import hashlib
import json
from collections import OrderedDict
from typing import NamedTuple

from tractionpower.cosimulation.check import check_all_but_movement
from tractionpower.cosimulation.tables import CompiledScenario, assemble
from tractionpower.errors import Problem, raise_errors
from tractionpower.model.scenario import Scenario
from tractionpower.movement.checks import check_movement
from tractionpower.movement.compile import Movement
from tractionpower.movement.driving.driven import compile_driven

MOST_KEPT = 4
"""Sets of trains that are kept."""

_OF_NO_TRAIN = {"coupling", "coupling_voltage_v", "output", "remedies", "seed", "sizing", "contingency", "duty_classes",
                "rectifier_units", "conductors", "name"}  # fmt: skip
_OF_TRAINS = ("system", "contact_lines", "return_circuit", "bonds")


class _Kept(NamedTuple):
    problems: list[Problem]
    movement: Movement


_kept: OrderedDict[str, _Kept] = OrderedDict()


def prepare(scenario: Scenario) -> tuple[CompiledScenario, list[Problem]]:
    """Return the tables of a scenario and the warnings of its checks, as `check_scenario` and `compile_scenario` do.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """
    others = check_all_but_movement(scenario)
    key = _key(scenario)
    kept = _kept.get(key)
    if kept is None:
        raise_errors([*others, *(problems := check_movement(scenario))])
        kept = _kept[key] = _Kept(problems, compile_driven(scenario))
        if len(_kept) > MOST_KEPT:
            _kept.popitem(last=False)
    _kept.move_to_end(key)
    raise_errors([*others, *kept.problems])
    return assemble(scenario, kept.movement, scenario.supply), [*others, *kept.problems]


def _key(scenario: Scenario) -> str:
    """Return a hash of all that trains depend on: of the supply its conductors, and which tracks its stations name together."""
    plain = scenario.model_dump(mode="json", by_alias=True, exclude=_OF_NO_TRAIN)
    supply = plain.pop("supply")
    plain["supply"] = {name: supply[name] for name in _OF_TRAINS}
    plain["stations"] = [[station["tracks"] for station in supply[name]] for name in ("substations", "section_cabins")]
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()

"""All checks of a scenario, gathered."""

from __future__ import annotations

from tractionpower.alignment.checks import check_line
from tractionpower.errors import Problem
from tractionpower.model.scenario import Scenario
from tractionpower.supply.checks import check_supply


def check_scenario(scenario: Scenario) -> list[Problem]:
    """Return every problem of a scenario whose parts are well formed; an empty list if there is none."""
    return [
        *check_line(scenario.line),
        *check_supply(scenario.supply, scenario.line, scenario.limits),
        *_check_clock(scenario),
    ]


def _check_clock(scenario: Scenario) -> list[Problem]:
    every, step = scenario.output.every_s, scenario.clock.step_s
    if every is None or (abs(every / step - round(every / step)) < 1e-9 and every >= step):
        return []
    return [
        Problem(
            "output_interval",
            "output.every_s",
            f"{every:g} s",
            f"a whole multiple of clock.step_s, {step:g} s",
            f"write {max(1, round(every / step)) * step:g}, or leave it out",
        )
    ]

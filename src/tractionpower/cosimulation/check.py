"""All checks of a scenario, gathered."""

from __future__ import annotations

import numpy as np

from tractionpower.alignment.checks import check_line
from tractionpower.cosimulation.useful_voltage_checks import check_useful_voltage
from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.model.scenario import ROUNDING_S, Clock, Scenario
from tractionpower.movement.checks import check_movement
from tractionpower.results.columns import TABLES
from tractionpower.results.touch import check_touch
from tractionpower.supply.checks import check_supply
from tractionpower.supply.conductor_checks import check_conductors
from tractionpower.supply.rating_checks import check_ratings


def check_scenario(scenario: Scenario) -> list[Problem]:
    """Return every problem of a scenario whose parts are well formed; an empty list if there is none."""
    return [*check_all_but_movement(scenario), *check_movement(scenario)]


def check_all_but_movement(scenario: Scenario) -> list[Problem]:
    """Return the problems of all but vehicles, trains and the timetable."""
    return [
        *check_line(scenario.line),
        *check_supply(scenario.supply, scenario.line, scenario.limits),
        *check_conductors(scenario.supply, scenario.conductors),
        *check_ratings(scenario),
        *_check_clock(scenario),
        *_check_output(scenario),
        *check_touch(scenario.limits, scenario.supply.system),
        *_check_events(scenario),
        *check_useful_voltage(scenario),
    ]


def step_count(clock: Clock) -> int:
    """Return the number of steps of a run; the last one may reach beyond the end of the clock."""
    return int(np.ceil((clock.end - clock.start) / clock.step_s - 1e-9))


def counted_steps(clock: Clock) -> int:
    """Return the number of steps of a run that begin behind its warm-up."""
    left_out = np.ceil((clock.counts_from_s - clock.start - ROUNDING_S) / clock.step_s)
    return step_count(clock) - max(0, int(left_out))


def _check_clock(scenario: Scenario) -> list[Problem]:
    clock = scenario.clock
    last = (step_count(clock) - 1) * clock.step_s
    if clock.warm_up is None or clock.warm_up <= last:
        return []
    allowed = f"at most {format_time(last)}, the start of the last step"
    return [Problem("warm_up", "clock.warm_up", format_time(clock.warm_up), allowed, "shorten it, or the step")]


def _check_output(scenario: Scenario) -> list[Problem]:
    every, step = scenario.output.every_s, scenario.clock.step_s
    problems = [
        Problem("unknown_table", f"output.tables[{k}]", repr(name), ", ".join(TABLES), "name one of these")
        for k, name in enumerate(scenario.output.tables or ())
        if name not in TABLES
    ]
    if every is not None and not (abs(every / step - round(every / step)) < 1e-9 and every >= step):
        problems.append(
            Problem(
                "output_interval",
                "output.every_s",
                f"{every:g} s",
                f"a whole multiple of clock.step_s, {step:g} s",
                f"write {max(1, round(every / step)) * step:g}, or leave it out",
            )
        )
    return problems


def _check_events(scenario: Scenario) -> list[Problem]:
    """Return a warning for each switch event outside the simulated time."""
    clock, problems = scenario.clock, []
    allowed = f"{format_time(clock.start)} to {format_time(clock.end)}, the clock of the study"
    for index, event in enumerate(scenario.supply.switch_events):
        if clock.start <= event.time < clock.end:
            continue
        what = f"{event.device} is switched at {format_time(event.time)}"
        found, remedy = f"{what}, after the run", "it never happens in this run"
        if event.time < clock.start:
            found, remedy = f"{what}, before the run", "it holds from the start on; make it the normal state, or correct the time"
        path = f"supply.switch_events[{index}].time"
        problems.append(Problem("event_outside_clock", path, found, allowed, remedy, "warning"))
    return problems

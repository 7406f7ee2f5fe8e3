"""What the files of Arshad et al. say, as plain data of our declarations, with the line of each value."""

from __future__ import annotations

import math
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.arshad.settings import Settings
from tractionpower.io.provenance import Mark

COUPLING = "wagon-connection"
"""Id of the coupling of such a train."""

_SECOND_POINT_MM = 100.0
"""Length of the second stage as points; beyond them its slope holds."""


def coupling_data(settings: Settings, problems: list[Problem]) -> tuple[dict[str, Any], Mark]:
    """Return the wagon connection (section 4): slack, wedge gears by stages, locked stiffness, hard limit.

    The stages are those of the spring, F_s of eq. 6 to 9. The hard limit is a displacement of the coupler, with the half of the
    slack on its side.
    """
    knee_mm = 1000.0 * settings.number("knee")
    first, second = settings.number("first_stage"), settings.number("second_stage")
    points = [(0.0, 0.0), (knee_mm, first * knee_mm), (knee_mm + _SECOND_POINT_MM, first * knee_mm + second * _SECOND_POINT_MM)]
    draw: dict[str, Any] = {
        "loading": [{"deflection_mm": x, "force_kn": force} for x, force in points],
        "wedge": {
            "angle_deg": settings.number("wedge"),
            "static_friction": settings.number("static"),
            "kinetic_friction": settings.number("kinetic"),
            "blending_mps": settings.number("blending"),
        },
        "locked_stiffness_kn_per_mm": settings.number("locked"),
        "relaxing_stiffness_kn_per_mm": settings.number("relaxing"),
        "in_series": int(settings.number("gears")),
        "locked_damping_kns_per_m": settings.number("locked_damping"),
    }
    limit_m, half_slack_m = settings.optional("hard_limit"), 0.5 * settings.number("slack")
    if limit_m is not None:
        draw["stroke_mm"] = 1000.0 * (limit_m - half_slack_m) / draw["in_series"]
        if limit_m <= half_slack_m:
            found, allowed = f"{limit_m:g} m", f"above {half_slack_m:g} m, half the slack region"
            problems.append(settings.problem("hard_limit", "out_of_bounds", found, allowed, "raise it, or lower the slack"))
    data = {
        "id": COUPLING,
        "name": "Wagon connection of Arshad et al.",
        "source": "Arshad et al., section 4 and 7.2, and the configuration",
        "slack_mm": 1000.0 * settings.number("slack"),
        "draw": draw,
    }
    return data, _coupling_mark(settings)


def _coupling_mark(settings: Settings) -> Mark:
    at = settings.mark
    stages = at("second_stage" if settings.is_given("second_stage") else "first_stage")
    wedge = Mark(settings.label, at("wedge").line, {
        "angle_deg": at("wedge"), "static_friction": at("static"), "kinetic_friction": at("kinetic"),
        "blending_mps": at("blending"),
    })  # fmt: skip
    draw = Mark(settings.label, stages.line, {
        "loading": stages, "wedge": wedge, "locked_stiffness_kn_per_mm": at("locked"),
        "relaxing_stiffness_kn_per_mm": at("relaxing"), "stroke_mm": at("hard_limit"),
        "in_series": at("gears"), "locked_damping_kns_per_m": at("locked_damping"),
    })  # fmt: skip
    return Mark(settings.label, 0, {"slack_mm": at("slack"), "draw": draw})


def brake_data(settings: Settings, problems: list[Problem]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return brake gear and air brake: F = ratio x weight x mu x p / p_greatest, p = ratio x reduction of the pipe.

    The gross braking ratio is that of the blocks without the losses of the rigging; times its efficiency it is the net one.
    """
    rigging, net = settings.number("rigging"), settings.number("net_ratio")
    gross = settings.optional("gross_ratio")
    if gross is not None and settings.is_given("net_ratio") and not math.isclose(net, gross * rigging, rel_tol=0.01):
        found = f"gross {gross:g} times rigging {rigging:g} is {gross * rigging:.4g}, and the net one {net:g}"
        problems.append(settings.problem("net_ratio", "contradiction", found, "one of the two", "delete one"))
    gear = {
        "brake_ratio": net if gross is None else gross * rigging,
        "rigging_efficiency": rigging,
        "friction": {"law": "constant", "friction": settings.number("mu")},
    }
    air = {
        "pipe_pressure_bar": settings.number("pipe"),
        "full_service_reduction_bar": settings.number("full_service"),
        "application_time_constant_s": settings.number("application"),
        "release_time_constant_s": settings.number("release"),
        "propagation_mps": settings.number("propagation"),
        "gain": settings.number("cylinder_ratio"),
        "cylinder_pressure_bar": settings.number("cylinder"),
        "cylinder_emergency_bar": max(settings.number("cylinder_emergency"), settings.number("cylinder")),
    }
    return gear, air


def air_mark(settings: Settings) -> Mark:
    """Return the lines of the air brake."""
    keys = {
        "pipe_pressure_bar": "pipe", "full_service_reduction_bar": "full_service", "application_time_constant_s": "application",
        "release_time_constant_s": "release", "propagation_mps": "propagation", "gain": "cylinder_ratio",
        "cylinder_pressure_bar": "cylinder", "cylinder_emergency_bar": "cylinder_emergency",
    }  # fmt: skip
    return Mark(settings.label, 0, {name: settings.mark(key) for name, key in keys.items()})


def run_data(settings: Settings, problems: list[Problem]) -> tuple[dict[str, Any], Mark]:
    """Return how the case is computed; a record at every step where the state vector is long enough.

    The paper simulates 150 s by 0.005 s, which is 30 000 steps, with a state vector of 20 000. Nothing is cut off at its
    end: every k-th step is recorded, the least k that fits, and a warning says so. A distance of records that the user fixes
    and that does not fit is an error.
    """
    duration, step = settings.number("duration"), settings.number("step")
    rows, record = settings.optional("rows"), settings.optional("record")
    run: dict[str, Any] = {"duration_s": duration, "step_s": step, "method": settings.text("method")}
    steps = math.ceil(duration / step - 1e-9)
    if rows is not None:
        least = -(-steps // (int(rows) - 1))  # one row more than distances
        fits = least * step
        run["rows_limit"] = int(rows)
        needed = f"{steps} steps of {step:g} s in {duration:g} s"
        if record is None:
            record = fits
            if least > 1:
                found = f"{needed} are more than a state vector of {int(rows)} holds"
                allowed = f"record every {fits:g} s, every {_ordinal(least)} step: {-(-steps // least) + 1} rows"
                told = settings.problem("rows", "state_vector", found, "", f"{allowed}; all steps are computed, none is cut off")
                problems.append(_warning(told))
        elif (recorded := math.ceil(duration / record - 1e-9) + 1) > rows:
            found = f"{recorded} rows of {record:g} s in a state vector of {int(rows)}"
            remedy = f"Record every = {fits:g} s fits, and so does State vector size = {recorded}"
            problems.append(settings.problem("record", "state_vector", found, f"at most {int(rows)} rows", remedy))
    if record is not None:
        run["record_every_s"] = record
    limit = settings.optional("distance_limit")
    if limit is not None:
        run["distance_limit_m"] = limit
    keys = {
        "duration_s": "duration", "step_s": "step", "rows_limit": "rows", "distance_limit_m": "distance_limit",
        "record_every_s": "record" if settings.is_given("record") else "rows", "method": "method",
    }  # fmt: skip
    return run, Mark(settings.label, 0, {name: settings.mark(key) for name, key in keys.items()})


def _warning(problem: Problem) -> Problem:
    return Problem(
        problem.code, problem.path, problem.found, problem.allowed, problem.remedy, severity="warning", place=problem.place
    )


def _ordinal(number: int) -> str:
    tail = "th" if 10 <= number % 100 <= 20 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{tail}"

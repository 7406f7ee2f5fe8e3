"""Problems of a case from a configuration of Arshad et al., told by the keys and columns of its files."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from tractionpower.errors import Problem
from tractionpower.io.arshad.conversion import COUPLING
from tractionpower.io.arshad.settings import spelling_of
from tractionpower.io.provenance import Provenance

_WORDS = {
    "angle_deg": "wedge",
    "static_friction": "static",
    "kinetic_friction": "kinetic",
    "blending_mps": "blending",
    "locked_stiffness_kn_per_mm": "locked",
    "relaxing_stiffness_kn_per_mm": "relaxing",
    "locked_damping_kns_per_m": "locked_damping",
    "in_series": "gears",
    "stroke_mm": "hard_limit",
    "slack_mm": "slack",
    "brake_ratio": "net_ratio",
    "rigging_efficiency": "rigging",
    "pipe_pressure_bar": "pipe",
    "full_service_reduction_bar": "full_service",
    "application_time_constant_s": "application",
    "release_time_constant_s": "release",
    "propagation_mps": "propagation",
    "gain": "cylinder_ratio",
    "cylinder_pressure_bar": "cylinder",
    "cylinder_emergency_bar": "cylinder_emergency",
    "duration_s": "duration",
    "step_s": "step",
    "record_every_s": "record",
    "rows_limit": "rows",
    "distance_limit_m": "distance_limit",
}
"""Key of the configuration by the name in our declarations."""

_OTHERS = {"loading": "First stage loading, Second stage loading", "friction": spelling_of("mu")}
"""What stands in paths as well, but is a word of its own in sentences."""

_COLUMNS = {
    "time_s": "Time",
    "drive": "Notch",
    "brake": "Brake Pipe Pressure",
    "reduction_bar": "Brake Pipe Pressure",
    "electric": "Dynamic Brake",
    "independent_bar": "Independent Brake",
}
"""Column of the commands by the name in our declarations."""

_OF_CONFIGURATION = re.compile(rf"(couplings\[{re.escape(COUPLING)}\]|case\.(run|air_brake|brake))(\..*)?")
_OF_COMMANDS = re.compile(r"case\.commands\[\d+\]\.(?P<name>\w+)")
_NAME = re.compile(rf"\b(?:[a-z]+\.)*({'|'.join(_WORDS)})\b")


class IniProvenance(Provenance):
    """The files and lines of a case from a configuration; its problems speak as the configuration does."""

    def place(self, problems: Iterable[Problem]) -> list[Problem]:
        """Return `problems` with file and line, by the keys and columns of the files."""
        return [in_own_words(problem) for problem in super().place(problems)]


def in_own_words(problem: Problem) -> Problem:
    """Return a problem with the keys of the configuration in place of our names.

    >>> in_own_words(Problem("step", "case.run.step_s", "0.1 s", "at most 0.05 s", "shorten step_s")).remedy
    'shorten Step size'
    """
    found, allowed, remedy = (_NAME.sub(_spelling, text) for text in (problem.found, problem.allowed, problem.remedy))
    return replace(problem, path=_path(problem.path), found=found, allowed=allowed, remedy=remedy)


def _path(path: str) -> str:
    command = _OF_COMMANDS.fullmatch(path)
    if command is not None:
        return _COLUMNS.get(command["name"], path)
    if _OF_CONFIGURATION.fullmatch(path) is None:
        return path
    names = [name for name in re.findall(r"\w+", path) if name in _WORDS or name in _OTHERS]
    if not names:
        return path
    last = names[-1]
    return _OTHERS.get(last) or spelling_of(_WORDS[last])


def _spelling(match: re.Match[str]) -> str:
    # "gain" alone is a word of English, but no sentence about this brake means anything else by it.
    return spelling_of(_WORDS[match[1]])

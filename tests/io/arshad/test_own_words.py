"""Problems of a case by the keys and columns of the files of Arshad et al."""

import pytest

from tractionpower.errors import Problem
from tractionpower.io.arshad.keys import KEYS
from tractionpower.io.arshad.own_words import _WORDS, in_own_words


@pytest.mark.parametrize(
    ("path", "own"),
    [
        ("couplings[wagon-connection].draw.wedge.static_friction", "Static fric coff"),
        ("couplings[wagon-connection].draw.loading[1].force_kn", "First stage loading, Second stage loading"),
        ("couplings[wagon-connection].slack_mm", "Slack region width"),
        ("case.run.step_s", "Step size"),
        ("case.air_brake.full_service_reduction_bar", "Full service reduction"),
        ("case.brake.friction", "Mu"),
        ("case.commands[3].reduction_bar", "Brake Pipe Pressure"),
        ("vehicles[car-2].mass_t", "vehicles[car-2].mass_t"),
        ("couplings[other].slack_mm", "couplings[other].slack_mm"),
    ],
)
def test_paths_become_keys(path, own):
    assert in_own_words(Problem("c", path, "f")).path == own


def test_texts_name_keys():
    problem = Problem("c", "case.run.step_s", "0.1 s", "at most 9 s, run.duration_s", "lengthen record_every_s, or soften it")
    told = in_own_words(problem)
    assert (told.found, told.allowed) == ("0.1 s", "at most 9 s, Simulation time")
    assert told.remedy == "lengthen Record every, or soften it"


def test_every_key_that_is_named_exists():
    assert set(_WORDS.values()) <= {key.name for key in KEYS}

"""Characteristics of a train as a point mass."""

import pytest
from point_trains import RUNNING, characteristics
from pydantic import ValidationError

from tractionpower.model.dynamics.point_mass import TrainCharacteristics


def test_rotating_parts_by_their_geometry():
    parts = [{"mass_t": 1.2, "radius_of_gyration_m": 0.35, "ratio": 1.0, "wheel_radius_m": 0.46, "count": 10}]
    given = characteristics(rotating_mass_factor=None, rotating_parts=parts)
    assert given.inertia_factor == pytest.approx(1 + 10 * 1.2 * 0.35**2 / (480.0 * 0.46**2))
    assert characteristics(rotating_mass_factor=None).inertia_factor == 1.0


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"power_kw": None}, "either effort, or"),
        ({"effort": [{"speed_kmh": 0.0, "effort_kn": 5.0}], "starting_effort_kn": 1.0, "power_kw": 2.0}, "either effort, or"),
        ({"effort": []}, "either effort, or"),
        ({"effort": [{"speed_kmh": 10.0, "effort_kn": 5.0}] * 2}, "not sorted"),
        (
            {"rotating_parts": [{"mass_t": 1.0, "radius_of_gyration_m": 0.3, "wheel_radius_m": 0.5}]},
            "either rotating_mass_factor",
        ),
        ({"braking_mps2": 0.0}, "greater than 0"),
        ({"resistance": {"a": 1.6}}, "Extra inputs"),
    ],
)
def test_what_is_contradictory_is_refused(more, told):
    with pytest.raises(ValidationError, match=told):
        characteristics(**more)


def test_it_is_frozen_and_saves():
    given = TrainCharacteristics(
        locomotive_mass_t=80.0,
        braking_mps2=0.5,
        max_speed_kmh=100.0,
        starting_effort_kn=200.0,
        power_kw=2000.0,
        resistance=RUNNING,
    )
    with pytest.raises(ValidationError, match="frozen"):
        given.braking_mps2 = 1.0
    assert TrainCharacteristics.model_validate(given.model_dump(mode="json")) == given

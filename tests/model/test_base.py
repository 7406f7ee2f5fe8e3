"""Declarations keep one zero, so that what is equal has one hash."""

import json

import pytest

from tractionpower.model.drive import StartingResistors
from tractionpower.model.line import Gradient, Station
from tractionpower.model.loads import Load
from tractionpower.model.vehicle import Resistance, Vehicle


@pytest.mark.parametrize(
    ("negative", "positive"),
    [
        (Gradient(from_km=-0.0, to_km=1.0, permille=-0.0), Gradient(from_km=0.0, to_km=1.0, permille=0.0)),
        (Resistance(a_n=-0.0), Resistance()),
        (Load(id="x", track="1", km=1.0, current_a=-0.0), Load(id="x", track="1", km=1.0, current_a=0.0)),
        (Station(id="A", km=0.0, stop_km={"1": -0.0}), Station(id="A", km=0.0, stop_km={"1": 0.0})),
        (StartingResistors(series=(2.0, -0.0)), StartingResistors(series=(2.0, 0.0))),
    ],
)
def test_minus_zero_is_zero(negative, positive):
    assert negative.model_dump_json() == positive.model_dump_json()
    assert "-0" not in negative.model_dump_json()
    assert json.loads(negative.model_dump_json(exclude_defaults=True)) == json.loads(
        positive.model_dump_json(exclude_defaults=True)
    )


def test_the_bounds_of_optional_fields_stay_in_the_schema():
    choices = Vehicle.model_json_schema()["properties"]["adhesive_mass_t"]["anyOf"]
    assert {"exclusiveMinimum": 0, "type": "number"} in choices

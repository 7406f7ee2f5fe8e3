"""Rules of drives that no bound of a single value can tell."""

import pytest
from pydantic import ValidationError

from tractionpower.model.drive import InverterDrive, SeriesMotorDrive

INVERTER = {"kind": "inverter", "starting_effort_kn": 300.0, "power_kw": 5000.0, "efficiency": 0.9}
SERIES = {
    "kind": "series_motors",
    "motors": 4,
    "groupings": [{"series": 4, "parallel": 1}],
    "starting_current_a": 400.0,
    "motor_resistance_ohm": 0.1,
    "magnetisation": [{"current_a": 100.0, "emf_vs_per_rev": 10.0}, {"current_a": 200.0, "emf_vs_per_rev": 20.0}],
    "gear_ratio": 2.0,
    "wheel_diameter_m": 1.25,
    "gear_efficiency": 0.97,
}
MAP = [{"speed_kmh": 0.0, "load_percent": 100.0, "efficiency": 0.9}]


def test_sound_drives():
    assert InverterDrive(**INVERTER).efficiency == 0.9
    assert SeriesMotorDrive(**SERIES, field_steps_percent=[100.0, 70.0, 40.0]).field_steps_percent == (100.0, 70.0, 40.0)


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"efficiency": None}, "either efficiency or efficiency_map"),
        ({"efficiency_map": MAP}, "either efficiency or efficiency_map"),
        ({"power_over_voltage": [{"voltage_v": v, "power_kw": 9.0} for v in (3000.0, 2800.0)]}, "2800 V behind 3000 V"),
    ],
)
def test_inverter_drives_that_are_refused(more, told):
    with pytest.raises(ValidationError, match=told):
        InverterDrive(**{**INVERTER, **more})


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (
            {"magnetisation": [*SERIES["magnetisation"], SERIES["magnetisation"][0]]},
            r"magnetisation\[2\] does not rise .* 100 A behind 200 A",
        ),
        ({"magnetisation": SERIES["magnetisation"][:1]}, "at least 2"),
        ({"field_steps_percent": [100.0, 70.0, 70.0]}, r"percent\[2\] does not fall .* 70 % behind 70 %"),
        ({"field_steps_percent": [100.0, 0.0]}, "greater than 0"),
        ({"field_steps_percent": [120.0]}, "less than or equal to 100"),
        ({"starting_resistors_ohm": {"series": [3.0, -1.0]}}, "greater than or equal to 0"),
        ({"relay": {"off_v": 2000.0, "on_v": 2000.0}}, "off_v is not below on_v: 2000 V and 2000 V"),
    ],
)
def test_series_motor_drives_that_are_refused(more, told):
    with pytest.raises(ValidationError, match=told):
        SeriesMotorDrive(**{**SERIES, **more})

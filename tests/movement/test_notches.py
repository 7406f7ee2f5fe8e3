"""Single notches of series motors against the circuit of one branch."""

import numpy as np
import pytest
from small_trains import SERIES_MOTORS

from tractionpower.model.drive import SeriesMotorDrive
from tractionpower.movement.notches import notch_curves

RESISTORS = {"series": [9.0, 4.0, 0.0], "parallel": [4.5, 2.0, 0.0]}
DRIVE = SeriesMotorDrive.model_validate(SERIES_MOTORS | {"starting_resistors_ohm": RESISTORS})


def test_each_notch_is_there_once():
    curves = notch_curves(DRIVE, 1, 3000.0, 100.0)
    found = [(curve.grouping.series, curve.field_percent, curve.resistor_ohm) for curve in curves]
    series = [(4, 100.0, 9.0), (4, 100.0, 4.0), (4, 100.0, 0.0), (4, 70.0, 0.0), (4, 50.0, 0.0)]
    parallel = [(2, 100.0, 4.5), (2, 100.0, 2.0), (2, 100.0, 0.0), (2, 70.0, 0.0), (2, 50.0, 0.0)]
    assert found == series + parallel


def test_the_voltages_of_a_branch_add_up():
    for curve in notch_curves(DRIVE, 2, 2700.0, 60.0):
        assert curve.speed_mps.min() >= 0.0
        assert curve.speed_mps.max() <= 60.0
        for v, effort in zip(curve.speed_mps[::40], curve.effort_n[::40], strict=True):
            # The current that gives this effort, found from the effort alone.
            amps = np.linspace(1.0, 300.0, 30_000)
            field = [(0.0, 0.0), *((point.current_a, point.emf_vs_per_rev) for point in DRIVE.magnetisation)]
            emf = np.interp(curve.field_percent / 100.0 * amps, *zip(*field, strict=True)) * 3.0 / (np.pi * 1.25)
            i = np.interp(effort / 2.0, 4 * 0.97 * emf * amps, amps)
            e = np.interp(i, amps, emf)
            k = curve.grouping.series
            assert i * (curve.resistor_ohm + k * 0.1) + k * e * v == pytest.approx(2700.0, rel=1e-4)


def test_without_resistors_only_field_steps_remain():
    curves = notch_curves(SeriesMotorDrive.model_validate(SERIES_MOTORS), 1, 3000.0, 100.0)
    assert [curve.resistor_ohm for curve in curves] == [0.0] * 6

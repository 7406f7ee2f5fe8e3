"""Air brakes of a train as rows: delays, forces, friction."""

import numpy as np
import pytest
from small_controls import GEAR, LENGTH_M, compiled, scenario

from tractionpower.dynamics.brakes import friction_row, newton_per_pascal
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.dynamics.gear import AirBrake, BlockFriction, BrakeGear


def test_delays_begin_at_the_drivers_valve():
    chain, _ = compiled(scenario(wagons=3, air_brake={"propagation_mps": 250.0}))
    np.testing.assert_allclose(chain.brakes["delay_s"], np.arange(4) * LENGTH_M / 250.0, rtol=1e-12)
    assert chain.brakes["independent"].tolist() == [True, False, False, False]


def test_vehicles_without_a_brake_in_use_have_no_row():
    parts = [{"id": "loco"}, {"id": "wagon", "brake": GEAR | {"in_use": False}}, {"id": "wagon", "count": 2}]
    chain, _ = compiled(scenario(vehicles=parts))
    assert chain.vehicles["brake"].tolist() == [0, -1, 1, 2]
    assert chain.brakes["friction"].tolist() == [0, 0, 0]  # one law for all
    np.testing.assert_allclose(chain.brakes["delay_s"], np.array([0.0, 2.0, 3.0]) * LENGTH_M / 250.0, rtol=1e-12)
    assert compiled(scenario(brake=None))[0].vehicles["brake"].tolist() == [-1, -1, -1]


def test_block_force_by_cylinder_or_by_ratio():
    air = AirBrake(cylinder_pressure_bar=3.8)
    rigging = BrakeGear(cylinder_area_cm2=962.0, rigging_ratio=6.0, rigging_efficiency=0.83)
    assert newton_per_pascal(rigging, 1.0, air) * 3.8e5 == pytest.approx(3.8e5 * 0.0962 * 6.0 * 0.83)
    weight = 80e3 * GRAVITY
    assert newton_per_pascal(BrakeGear(brake_ratio=0.12), weight, air) * 3.8e5 == pytest.approx(0.12 * weight)


def test_a_grid_lies_behind_what_is_there():
    grid = [9.0]
    points = [{"speed_kmh": v, "block_force_kn": f, "friction": 0.1 + v / 1e3 + f / 1e2} for v in (36, 0) for f in (5, 1)]
    row = friction_row(BlockFriction.model_validate({"law": "table", "points": points}), grid)
    assert row[5:] == (1, 2, 2)
    np.testing.assert_allclose(grid[1:], [0.0, 10.0, 1e3, 5e3, 0.11, 0.15, 0.146, 0.186])


def test_common_figures_of_the_cylinders():
    chain, _ = compiled(scenario(air_brake={"cylinder_fill_s": 3.0, "cylinder_emergency_bar": 4.2}))
    air = chain.air[0]
    assert air["gain"] == pytest.approx(3.8 / 1.5)
    assert (air["cylinder_pa"], air["cylinder_emergency_pa"], air["pipe_pa"]) == pytest.approx((3.8e5, 4.2e5, 5e5))
    assert (air["fill_s"], air["release_s"], air["emergency_fill_s"], air["independent_s"]) == (3.0, 0.0, 3.0, 1.0)

"""The train of many vehicles tends to the one-mass train of the co-simulation as its couplings become stiff."""

import numpy as np
import pytest
from chains import Chained, make_chain, spring
from small_trains import journey, make_trains

LOCO = {
    "id": "loco",
    "kind": "locomotive",
    "mass_t": 80.0,
    "length_m": 18.0,
    "max_speed_kmh": 160.0,
    "rotating_mass_factor": 1.15,
    "resistance": {"a_n": 1500.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.5},
    "drive": {"kind": "inverter", "starting_effort_kn": 250.0, "power_kw": 3000.0, "efficiency": 0.85},
}
WAGON = {
    "id": "wagon",
    "kind": "wagon",
    "mass_t": 20.0,
    "load_t": 60.0,
    "length_m": 14.0,
    "max_speed_kmh": 120.0,
    "rotating_mass_factor": 1.08,
    "resistance": {"specific_a_n_per_kn": 1.2, "a_n": 300.0, "c_n_per_kmh2": 0.1},
}
PARTS = [{"id": "loco"}, {"id": "wagon", "count": 12, "load_percent": 50.0}]
SLOPES_M = [(1500.0, 2500.0, 6.0), (2500.0, 3300.0, -4.0)]


def one_mass(slopes):
    """Return time, place and speed of the journey of the co-simulation at a given voltage, in steps of 0.05 s."""
    scenario = make_trains(
        10.0, all_vehicles=[LOCO, WAGON], vehicles=PARTS, slopes=[(low / 1e3, high / 1e3, slope) for low, high, slope in slopes]
    )
    rows = journey(scenario, voltage_v=3000.0, step_s=0.05).rows
    return rows["time_s"], rows["s_m"], rows["v_mps"]


def many(stiffness, slopes, damping_share=0.3):
    """Return the chain with all that the drive gives, and couplings of this stiffness [kN/mm]."""
    damping = damping_share * 2.0 * (stiffness * 1e6 * 25e3) ** 0.5 / 1e3
    gradients = [{"from_m": low, "to_m": high, "permille": slope} for low, high, slope in slopes]
    return make_chain(
        PARTS, spring(stiffness, damping_kns_per_m=damping), (LOCO, WAGON),
        traction={"levels": 1, "time_constant_s": 0.0}, commands=[{"time_s": 0.0, "drive": 1}],
        track={"gradients": gradients, "rounding_radius_m": 0.0},
        run={"step_s": 0.001, "method": "rk4", "record_every_s": 0.1, "duration_s": 140.0},
    )  # fmt: skip


@pytest.mark.parametrize("slopes", [[], SLOPES_M], ids=["level", "hill"])
def test_stiff_couplings_tend_to_the_one_mass_train(slopes):
    time, place, speed = one_mass(slopes)
    errors, speeds = [], []
    for stiffness in (2.0, 20.0, 200.0):
        chained = Chained(many(stiffness, slopes))
        chained.advance(140.0)
        t = chained.rows["time_s"]
        front = chained.vehicle_rows["s_m"][:, 0] - float(chained.movers["start_m"][0])
        # the first vehicle of a springy train swings about the one mass
        errors.append(np.abs(chained.vehicle_rows["v_mps"][:, 0] - np.interp(t, time, speed)).max())
        speeds.append(np.abs(front - np.interp(t, time, place - place[0])).max())
        assert front[-1] > 2000.0
    assert errors[0] > 1.8 * errors[1] > 3.2 * errors[2]
    assert errors[2] < 0.05  # m/s
    assert speeds[0] > speeds[2]
    assert speeds[2] < 0.5  # m after more than two kilometres

"""A train that is driven: what its driver is told of forces."""

import numpy as np
import pytest
from chains import WEDGE, free, pulled

from tractionpower.dynamics.driven import DrivenSession
from tractionpower.dynamics.session import Session

RUN = {"step_s": 0.01, "duration_s": 60.0, "record_every_s": 0.01}
BRAKED = {"traction": {}, "brake": {"brake_ratio": 0.6}, "commands": [{"time_s": 0.0, "drive": 9}], "run": RUN}


def braked(**more):
    return pulled(4, WEDGE, **{**BRAKED, **more})


def test_peaks_are_the_extremes_of_all_steps_since_the_last_call():
    driven, stepped = DrivenSession(braked()), Session(braked(), live=True)
    begin, peaks = 0, []
    for steps, setting in ((30, {}), (140, {}), (230, {}), (200, {"drive": 0, "brake": "emergency"}), (800, {"brake": 0})):
        forces = []
        driven.set(**setting)
        stepped.set(**setting)
        for step in range(begin + 1, begin + steps + 1):
            stepped.advance(0.01 * step)
            forces.append(stepped.state.links["force_n"][0] / 1e3)
        begin += steps
        driven.advance(0.01 * begin)
        peaks.append(driven.take_peaks())
        assert peaks[-1] == (min(forces), max(forces))
    assert len({*peaks}) == len(peaks)
    now = driven.state.links["force_n"][0] / 1e3
    assert driven.take_peaks() == (now, now)  # nothing was computed since


def test_looking_at_peaks_changes_no_extreme_of_the_whole_drive():
    driven, whole = DrivenSession(braked()), Session(braked())
    whole.advance(20.0)
    for tick in range(1, 2001):
        driven.advance(0.01 * tick)
    names = ["greatest_n", "greatest_at_s", "least_n", "least_at_s"]
    assert np.array_equal(driven.state.links[names], whole.state.links[names])
    assert driven.snapshot()["greatest_kn"] == pytest.approx(whole.state.links["greatest_n"] / 1e3)


def test_one_vehicle_alone_has_no_peaks():
    driven = DrivenSession(free([80.0], WEDGE, start={"speed_kmh": 36.0}))
    driven.advance(1.0)
    assert driven.take_peaks() == (0.0, 0.0)
    assert driven.snapshot()["greatest_kn"] == []


@pytest.mark.parametrize("permille", [0.0, 12.0])
@pytest.mark.parametrize("until_s", [3.0, 8.0, 60.0])
def test_the_forces_told_add_up_to_mass_times_acceleration_also_at_rest(until_s, permille):
    track = {"gradients": [{"from_m": -1e4, "to_m": 1e5, "permille": permille}]}
    driven = DrivenSession(braked(track=track))
    driven.advance(min(until_s, 5.0))
    if until_s > 5.0:
        driven.set(drive=0, brake="full_service")
        driven.advance(until_s)
    now, vehicles = driven.snapshot(), driven.compiled.chain.vehicles
    movers = driven.state.movers
    inertial_kn = float((vehicles["inertia_kg"] * movers["a_mps2"]).sum()) / 1e3
    gravity_kn = float(movers["grade_n"].sum()) / 1e3
    left_kn = now["tractive_force_kn"] - now["brake_force_kn"] - now["resistance_kn"] - gravity_kn
    assert left_kn == pytest.approx(inertial_kn, abs=1e-6)
    if until_s == 60.0:
        assert now["speed_kmh"] == 0.0
        assert now["brake_force_kn"] + now["resistance_kn"] == pytest.approx(-gravity_kn, abs=1e-6)

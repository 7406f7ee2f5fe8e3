import numpy as np
import pytest
from chains import WEDGE, Chained, free, pulled, spring

STEP_S = 0.002
COMMANDS = [
    {"time_s": 0.0, "drive": 1},
    {"time_s": 3.0, "drive": 0, "brake": 9},
    {"time_s": 12.0, "drive": 1, "brake": 0},
    {"time_s": 20.0, "drive": 0, "brake": "emergency"},
]


@pytest.fixture(scope="module")
def every_step():
    """A ride of which each step is recorded."""
    run = {"duration_s": 30.0, "step_s": STEP_S, "record_every_s": STEP_S}
    chained = Chained(pulled(5, WEDGE, commands=COMMANDS, brake={"brake_ratio": 0.7}, run=run))
    chained.advance(1e9)
    return chained


def test_extremes_are_those_of_all_rows(every_step):
    force = every_step.link_rows["force_n"]
    # forces of rows are those at the end of a step, those of extremes in its middle
    assert every_step.links["greatest_n"] == pytest.approx(force.max(axis=0), rel=0.03)
    assert every_step.links["least_n"] == pytest.approx(force.min(axis=0), rel=0.03)
    times = every_step.rows["time_s"]
    assert every_step.links["greatest_at_s"] == pytest.approx(times[force.argmax(axis=0)], abs=2.1 * STEP_S)


def test_times_in_bins_are_those_of_all_steps(every_step):
    rows, speed = every_step.rows, every_step.vehicle_rows["v_mps"][:, 0]
    state, bins = every_step.state, every_step.chain.bins
    edges = bins[0]["from_"] + bins[0]["width"] * np.arange(bins[0]["bins"] + 1)
    places = np.digitize(speed[1:], edges)
    for name, control in (("drive_speed", "drive"), ("brake_speed", "brake")):
        counted = np.zeros_like(getattr(state, name))
        np.add.at(counted, (rows[control][:-1], places), STEP_S)
        assert getattr(state, name) == pytest.approx(counted, abs=1e-9)
    gained = np.diff(speed) / STEP_S
    edges = bins[2]["from_"] + bins[2]["width"] * np.arange(bins[2]["bins"] + 1)
    counted = np.bincount(np.digitize(gained, edges), minlength=len(state.acceleration)) * STEP_S
    assert np.abs(state.acceleration - counted).max() <= 1.01 * STEP_S  # one on an edge may fall to either side
    assert state.acceleration.sum() == pytest.approx(30.0)


def test_forces_beyond_all_bins_are_counted_at_the_ends():
    chained = Chained(free([80.0] * 2, spring(100.0), run={"duration_s": 1.0, "record_every_s": 1.0}))
    chained.movers["v_mps"] = [-1.0, 1.0]
    chained.advance(1e9)
    assert chained.links["least_n"][0] < -1e6 and chained.state.force[0] > 0.0
    assert chained.state.force.sum() == pytest.approx(1.0)


def test_turns_are_the_peaks_and_valleys_of_the_force():
    """Two equal masses on a spring swing with a force that is a sine."""
    run = {"duration_s": 2.0, "step_s": 1e-3, "record_every_s": 1.0}
    chained = Chained(free([80.0] * 2, spring(20.0), run=run))
    chained.movers["v_mps"] = [0.1, -0.1]
    turns = []
    for until in (0.7, 1.3, 2.0):  # wherever blocks end
        chained.advance(until)
        turns.append(chained.turns)
    forces = np.concatenate(turns)["force_n"]
    omega = (2.0 * 20e6 / 80e3) ** 0.5
    peak = 20e6 * 0.2 / omega
    assert forces[0] == 0.0
    assert forces[1:] == pytest.approx([peak * (-1.0) ** k for k in range(len(forces) - 1)], rel=2e-3)
    assert len(forces) - 1 == int(omega * 2.0 / np.pi + 0.5)


def test_small_swings_are_no_turns():
    chained = Chained(free([80.0] * 2, spring(20.0), run={"duration_s": 2.0, "record_every_s": 1.0}))
    chained.movers["v_mps"] = [1e-5, -1e-5]
    chained.advance(1e9)
    assert chained.links["greatest_n"][0] > 0.0 and len(chained.turns) == 0


def test_friction_at_rest_is_recorded_as_it_acts():
    vehicle_rows = Chained(
        free([80.0], spring(1.0), brake={"brake_ratio": 0.5}, start={"brake": "full_service"}, run={"duration_s": 1.0},
             track={"gradients": [{"from_m": -500.0, "to_m": 500.0, "permille": 5.0}], "rounding_radius_m": 0.0})
    )  # fmt: skip
    vehicle_rows.advance(1e9)
    row = vehicle_rows.vehicle_rows[-1, 0]
    assert row["v_mps"] == 0.0 and row["a_mps2"] == 0.0
    assert row["brake_n"] + row["resistance_n"] == pytest.approx(80e3 * 9.80665 * 0.005)
    assert row["grade_n"] == pytest.approx(80e3 * 9.80665 * 0.005)


def test_extremes_of_vehicles_are_those_of_all_steps(every_step):
    rows, movers = every_step.vehicle_rows, every_step.movers
    speed = rows["v_mps"]
    assert movers["greatest_mps"] == pytest.approx(speed.max(axis=0))
    gained = np.diff(speed, axis=0) / STEP_S
    assert np.abs(movers["sharpest_mps2"]) == pytest.approx(np.abs(gained).max(axis=0))
    moved = rows["s_m"] - rows["s_m"][0]
    against = moved - moved[:, :1]
    assert np.abs(movers["furthest_m"]) == pytest.approx(np.abs(against).max(axis=0))
    assert np.sign(movers["furthest_m"][1:]) == pytest.approx(-1.0)  # drawn out behind the locomotive


def test_marks_tell_where_controls_changed_and_where_the_train_stood(every_step):
    marks, rows = every_step.marks, every_step.rows
    taken = marks[marks["control"] >= 0]
    assert taken["control"].tolist() == [1, 2, 3, 4] and taken["time_s"].tolist() == [0.0, 3.0, 12.0, 20.0]
    at = np.searchsorted(rows["time_s"], marks["time_s"] - 1e-9)
    assert marks["s_m"] == pytest.approx(every_step.vehicle_rows["s_m"][at, 0])
    assert marks["v_mps"] == pytest.approx(every_step.vehicle_rows["v_mps"][at, 0])
    standing = (every_step.vehicle_rows["v_mps"] == 0.0).all(axis=1)
    came = rows["time_s"][1:][standing[1:] & ~standing[:-1]]
    assert marks["time_s"][marks["control"] < 0] == pytest.approx(came)


def test_a_train_that_rolls_back_has_its_greatest_speed_backwards():
    gradients = [{"from_m": -5000.0, "to_m": 5000.0, "permille": 10.0}]
    chained = Chained(free([80.0] * 3, spring(10.0), track={"gradients": gradients, "rounding_radius_m": 0.0},
                           run={"duration_s": 10.0}))  # fmt: skip
    chained.advance(1e9)
    assert chained.movers["greatest_mps"] == pytest.approx(-0.0980665 * 10.0)


def test_many_commands_find_room_in_the_next_block():
    commands = [{"time_s": 0.001 * k, "drive": k % 2} for k in range(2500)]
    chained = Chained(pulled(1, spring(10.0), commands=commands, run={"duration_s": 4.0}))
    chained.advance(1e9)
    assert chained.marks["control"].tolist() == list(range(1, 2501))

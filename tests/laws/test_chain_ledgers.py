"""Laws of a chain of vehicles: works add up, errors fall by the order of the method, what must not matter does not."""

import numpy as np
import pytest
from chains import AT_ONCE, FULL, LOCOMOTIVE, WAGON, WEDGE, Chained, G, advanced, free, make_chain, pulled, spring
from scipy.integrate import solve_ivp

DRAG = {"specific_a_n_per_kn": 1.6, "specific_c_n_per_kn_per_kmh2": 5.7045e-4}
HILL = {
    "gradients": [{"from_m": 100.0, "to_m": 400.0, "permille": 8.0}, {"from_m": 500.0, "to_m": 900.0, "permille": -12.0}],
    "curves": [{"from_m": 150.0, "to_m": 300.0, "radius_m": 400.0}],
    "rounding_radius_m": 4000.0,
}
BRAKE = {"brake_ratio": 0.4, "rigging_efficiency": 1.0, "friction": {"law": "karwatzki"}}
DRIVEN = [{"time_s": 1.0, "drive": 1}, {"time_s": 60.0, "drive": 0}, {"time_s": 70.0, "brake": 10}]


def over_the_hill(coupling, **run):
    return pulled(
        9, coupling, vehicles=(LOCOMOTIVE | {"resistance": DRAG}, WAGON | {"resistance": DRAG}),
        track=HILL, brake=BRAKE, commands=DRIVEN, run={"duration_s": 200.0, "record_every_s": 1.0} | run,
        traction={"levels": 1, "time_constant_s": 0.5, "power_kw": 2000.0},
    )  # fmt: skip


@pytest.mark.parametrize("gear", [WEDGE, spring(10.0, damping_kns_per_m=40.0)], ids=["wedge", "spring"])
@pytest.mark.parametrize(
    ("method", "step_s"), [("rk4", 0.002), ("variable", 0.05), ("symplectic", 0.005)], ids=["rk4", "variable", "symplectic"]
)
def test_the_ledger_of_works_closes(gear, method, step_s):
    chained = Chained(over_the_hill(gear, method=method, step_s=step_s, tolerance=1e-8))
    before = chained.kinetic_j()
    chained.advance(110.0)
    assert (chained.movers["v_mps"] == 0.0).all()  # it has come to a stand: all work is told
    gap, whole = chained.ledger_gap(before)
    assert abs(gap) <= 1e-6 * whole
    ledger = chained.ledger
    assert min(ledger[name] for name in ("traction_j", "brake_j", "resistance_j", "coupling_j")) > 1e3
    assert float(chained.links["absorbed_j"].sum()) == pytest.approx(float(ledger["coupling_j"]), rel=1e-9)


def height(s):
    """Return the height of the sharp profile of HILL [m]."""
    return np.interp(s, [0.0, 100.0, 400.0, 500.0, 900.0, 5000.0], [0.0, 0.0, 2.4, 2.4, -2.4, -2.4])


def test_work_against_gravity_is_the_height_times_the_weight_whatever_the_rounding():
    works = []
    for rounding in (4000.0, 10_000.0, 0.0):
        scenario = over_the_hill(spring(10.0), method="rk4", step_s=0.005)
        track = HILL | {"rounding_radius_m": rounding}
        case = scenario.case.model_validate(scenario.case.model_dump() | {"track": track, "commands": DRIVEN[:2]})
        chained = Chained(scenario.model_copy(update={"case": case}))
        start = chained.movers["s_m"].copy()
        chained.advance(140.0)
        assert chained.movers["s_m"].min() > 1000.0  # all are far behind the last break
        expected = (chained.chain.vehicles["weight_n"] * (height(chained.movers["s_m"]) - height(start))).sum()
        assert float(chained.ledger["grade_j"]) == pytest.approx(expected, rel=1e-4 if rounding == 0.0 else 1e-6)
        works.append(float(chained.ledger["grade_j"]))
    assert np.ptp(works) <= 1e-4 * abs(works[0])


def test_what_springs_hold_and_dampers_burn_is_what_couplings_take():
    chained = advanced(pulled(9, spring(10.0, damping_kns_per_m=40.0), run={"method": "rk4", "step_s": 0.002}), 7.3)
    stretch = chained.link_rows["stretch_m"][-1]
    moved = (chained.movers["s_m"][:-1] - chained.movers["s_m"][1:]) - np.diff(chained.chain.vehicles["behind_m"])
    held = 0.5 * 10e6 * moved**2
    np.testing.assert_allclose(chained.links["absorbed_j"] - chained.links["damper_j"], held, rtol=1e-6, atol=0.1)
    assert chained.links["damper_j"].min() > 0.0
    assert np.abs(stretch).max() > 1e-3


def gap_of_states(method, step_s, tolerance=1e-9, spring_kn_per_mm=10.0):
    """Return by how much work and energy of a train on a rounded slope differ, of the work; from places and speeds alone.

    The pull is constant, so its work is force times way; springs and heights have closed forms; nothing rubs.
    """
    run = {"method": method, "step_s": step_s, "tolerance": tolerance, "record_every_s": 100.0, "duration_s": 100.0}
    rising = {"gradients": [{"from_m": 50.0, "to_m": 5000.0, "permille": 8.0}], "rounding_radius_m": 20_000.0}
    chained = Chained(pulled(9, spring(spring_kn_per_mm), track=rising, run=run))
    start = chained.movers["s_m"].copy()
    chained.advance(23.7)
    movers = chained.movers
    stretch = (movers["s_m"][:-1] - movers["s_m"][1:]) - np.diff(chained.chain.vehicles["behind_m"])
    held = 0.5 * spring_kn_per_mm * 1e6 * stretch**2
    along = np.clip(np.stack((start, movers["s_m"])) - (50.0 - 80.0), 0.0, None)  # the rounding is 160 m long, half before
    low, high = np.where(along < 160.0, 0.5 * 0.008 / 160.0 * along**2, 0.008 * (along - 80.0))
    work = 200e3 * (movers["s_m"][0] - start[0])
    return (work - chained.kinetic_j() - held.sum() - (chained.chain.vehicles["weight_n"] * (high - low)).sum()) / work


@pytest.mark.parametrize(("method", "steps", "order"), [("symplectic", (0.02, 0.01), 2), ("rk4", (0.04, 0.02), 4)])
def test_energy_by_states_closes_by_the_order_of_the_method(method, steps, order):
    coarse, fine = (abs(gap_of_states(method, step_s)) for step_s in steps)
    assert fine < 1e-5
    assert np.log2(coarse / fine) > order - 0.4


def test_energy_by_states_closes_to_a_millionth():
    assert abs(gap_of_states("symplectic", 0.002)) < 1e-6
    assert abs(gap_of_states("rk4", 0.01)) < 1e-6
    assert abs(gap_of_states("variable", 0.1, tolerance=1e-9)) < 1e-6


def test_friction_gears_never_give_back_more_than_they_took():
    chained = advanced(over_the_hill(WEDGE, method="rk4", step_s=0.002), 110.0)
    assert (chained.links["absorbed_j"] > 0.0).all()


# A smooth problem: linear springs with dampers, resistance with v and v2, effort by constant power
N, K, D, M = 6, 5e6, 60e3, 80e3
POWER = 1.5e6
SMOOTH_S = 4.0


def smooth(lag_s=0.0, **run):
    wagon = WAGON | {"resistance": {"a_n": 2000.0, "b_n_per_kmh": 100.0, "c_n_per_kmh2": 5.0}}
    traction = {"levels": 1, "time_constant_s": lag_s, "starting_effort_kn": 5000.0, "power_kw": POWER / 1000.0}
    return pulled(
        N - 1, spring(5.0, damping_kns_per_m=60.0), vehicles=(LOCOMOTIVE, wagon), traction=traction,
        start={"speed_kmh": 36.0}, run=run,
    )  # fmt: skip


def smooth_reference(lag_s=0.0):
    """Return places against the start, and speeds, by scipy and equations of our own; the effort lags if `lag_s` is given."""

    def slope(_, y):
        x, v, effort = y[:N], y[N : 2 * N], y[2 * N]
        force = K * (x[:-1] - x[1:]) + D * (v[:-1] - v[1:])
        kmh = 3.6 * v[1:]
        a = np.zeros(N)
        steady = POWER / v[0]
        a[0] = (effort if lag_s else steady) - force[0]
        a[1:] = force - np.append(force[1:], 0.0) - (2000.0 + 100.0 * kmh + 5.0 * kmh**2)
        return np.concatenate([v, a / M, [(steady - effort) / lag_s if lag_s else 0.0]])

    start = np.concatenate([np.zeros(N), np.full(N, 10.0), [0.0]])
    found = solve_ivp(slope, (0.0, SMOOTH_S), start, method="DOP853", rtol=1e-12, atol=1e-12)
    return found.y[: 2 * N, -1]


def smooth_errors(runs, lag_s=0.0):
    """Return the greatest error of places [m] and speeds [m/s] of each run."""
    reference = smooth_reference(lag_s)
    errors = []
    for run in runs:
        chained = Chained(smooth(lag_s, **{"record_every_s": SMOOTH_S} | run))
        start = chained.movers["s_m"].copy()
        chained.advance(SMOOTH_S)
        assert float(chained.ledger["time_s"]) == pytest.approx(SMOOTH_S, abs=1e-9)
        found = np.concatenate([chained.movers["s_m"] - start, chained.movers["v_mps"]])
        errors.append(np.abs(found - reference).max())
    return np.array(errors)


@pytest.mark.parametrize(
    ("method", "lag_s", "steps", "order"),
    [
        ("euler", 0.0, (0.002, 0.001, 0.0005), 1),
        ("euler", 0.3, (0.002, 0.001, 0.0005), 1),
        ("symplectic", 0.0, (0.02, 0.01, 0.005), 1),
        ("symplectic", 0.3, (0.02, 0.01, 0.005), 1),
        ("rk4", 0.0, (0.08, 0.04, 0.02), 4),
        ("rk4", 0.3, (0.08, 0.04, 0.02), 2),  # the lag is exact for an aim that is linear in time
    ],
)
def test_halving_the_step_shrinks_the_error_by_the_order(method, lag_s, steps, order):
    errors = smooth_errors([{"method": method, "step_s": step} for step in steps], lag_s)
    found = np.log2(errors[:-1] / errors[1:])
    assert found.min() > order - 0.25, errors
    if method == "euler" or (lag_s == 0.0 and method == "rk4"):  # the others do better where speeds matter little
        assert found.max() < order + 0.6, errors


def test_a_smaller_tolerance_gives_a_smaller_error():
    runs = [{"method": "variable", "step_s": 0.5, "tolerance": tolerance} for tolerance in (1e-4, 1e-6, 1e-8)]
    errors = smooth_errors(runs)
    assert errors[0] > 10.0 * errors[1] > 100.0 * errors[2]
    assert errors[2] < 1e-6


@pytest.mark.parametrize("method", ["symplectic", "rk4", "euler", "variable"])
def test_the_result_does_not_depend_on_where_blocks_end(method):
    scenario = over_the_hill(WEDGE, method=method, step_s=0.002)
    whole, parts = Chained(scenario), Chained(scenario, rows=3)
    whole.advance(75.0)
    for until_s in (0.0011, 0.3, 7.77, 33.0, 33.0, 61.2345, 75.0):
        parts.advance(until_s)
    assert whole.state.movers.tobytes() == parts.state.movers.tobytes()
    assert whole.state.links.tobytes() == parts.state.links.tobytes()
    assert whole.state.ledger.tobytes() == parts.state.ledger.tobytes()
    assert whole.rows.tobytes() == parts.rows.tobytes()
    assert whole.link_rows.tobytes() == parts.link_rows.tobytes()
    assert whole.state.drive_speed.tobytes() == parts.state.drive_speed.tobytes()


def test_a_train_pushed_is_the_mirror_of_the_train_pulled():
    # Tension ahead of the mass pulled becomes compression behind the mass pushed
    wagon = WAGON | {"resistance": DRAG}
    loco = LOCOMOTIVE | {"resistance": DRAG}
    parts = [{"id": "loco"}, {"id": "wagon", "count": 8}]
    shared = {"vehicles": (loco, wagon), "traction": AT_ONCE, "commands": FULL, "run": {"step_s": 0.002}}
    pulled_, pushed = (advanced(make_chain(each, WEDGE, **shared), 20.0) for each in (parts, parts[::-1]))
    np.testing.assert_allclose(pushed.movers["v_mps"][::-1], pulled_.movers["v_mps"], rtol=1e-9)
    np.testing.assert_allclose(pushed.link_rows["force_n"][:, ::-1], -pulled_.link_rows["force_n"], rtol=1e-6, atol=50.0)


def test_order_and_names_of_what_is_declared_do_not_matter():
    scenario = over_the_hill(WEDGE)
    renamed = [each.model_copy(update={"id": {"loco": "zz", "wagon": "aa"}[each.id]}) for each in scenario.vehicles]
    parts = [part.model_copy(update={"id": {"loco": "zz", "wagon": "aa"}[part.id]}) for part in scenario.case.vehicles]
    case = scenario.case.model_copy(update={"vehicles": tuple(parts)})
    other = scenario.model_copy(update={"vehicles": tuple(reversed(renamed)), "case": case})
    assert advanced(scenario, 30.0).vehicle_rows.tobytes() == advanced(other, 30.0).vehicle_rows.tobytes()


def test_a_copied_state_goes_on_as_the_first():
    scenario = over_the_hill(WEDGE)
    first = Chained(scenario)
    first.advance(20.0)
    second = Chained(scenario)
    for mine, theirs in zip(second.state, first.state, strict=True):
        mine[...] = theirs
    first.advance(40.0)
    second.advance(40.0)
    assert first.state.movers.tobytes() == second.state.movers.tobytes()


def test_grade_under_the_train_or_under_each_vehicle_is_one_for_equal_masses_on_a_linear_slope():
    # Arshad et al., eq. 11: exact for uniform mass; the slope grows linearly here, within one vertical rounding
    track = {"gradients": [{"from_m": 250.0, "to_m": 20_000.0, "permille": 25.0}], "rounding_radius_m": 80_000.0}
    found = []
    for grade in ("vehicle", "train"):
        scenario = free([80.0] * 12, spring(1000.0, damping_kns_per_m=500.0), track=track, grade=grade,
                        start={"speed_kmh": 50.0}, run={"method": "rk4", "step_s": 0.001})  # fmt: skip
        chained = Chained(scenario)
        assert chained.movers["s_m"].min() > -750.0
        chained.advance(20.0)
        found.append(chained)
    vehicle, train = found
    whole = [each.vehicle_rows["grade_n"].sum(axis=1) for each in found]
    np.testing.assert_allclose(whole[0], whole[1], rtol=1e-6)
    assert np.ptp(vehicle.vehicle_rows["grade_n"][-1]) > 1e3  # they differ from vehicle to vehicle
    assert np.ptp(train.vehicle_rows["grade_n"][-1]) < 1e-6
    assert vehicle.movers["v_mps"].mean() == pytest.approx(train.movers["v_mps"].mean(), rel=1e-9)
    assert whole[0][-1] == pytest.approx(12 * 80e3 * G * 0.0125, rel=0.9)

"""Plans that save energy against an independent dynamic programme on the TTOBench tracks, closed forms, and their times."""

import numpy as np
import pytest
from dp_reference import Reference
from small_trains import BRAKE, DRIVES, call, make_run, make_trains, passing
from ttobench_cases import TRACKS, Driven, scenario_of

from tractionpower.model.driving import Eco, Reserve, ToTime
from tractionpower.movement.compile import compile_trains
from tractionpower.movement.driving.optimal import optimal_plans

CASES = [(track, "subway" if track.startswith("CN") else ("flirt", "virm")[n % 2]) for n, track in enumerate(TRACKS)]
RESERVES = (1.03, 1.08, 1.2)
LEVEL = {"stations": {"A": 0.0, "B": 15.0, "P": 28.0, "C": 40.0}, "limits": [(-1.0, 12.0, 120.0), (12.0, 41.0, 90.0)]}
HILLS = LEVEL | {"slopes": [(-1.0, 10.0, 0.0), (10.0, 20.0, 8.0), (20.0, 30.0, -6.0), (30.0, 41.0, 2.0)]}
CAR = {
    "brake": BRAKE,
    "resistance": {"a_n": 2500.0, "c_n_per_kmh2": 0.7},
    "rotating_mass_factor": 1.08,
    "auxiliaries": {"power_kw": 100.0, "heating_kw": 50.0, "heating": "resistive"},
}


def reserve(percent, **more):
    return Reserve(kind="reserve", percent=percent, **more)


def to_time(**more):
    return ToTime(kind="to_time", **more)


def plan(movement, saving, voltage=3000.0):
    return optimal_plans(movement, [(0, saving)], voltage)[0]


def driven(scenario, saving, voltage=3000.0):
    """Return the run flat out, and by its plan."""
    movement = compile_trains(scenario)
    return Driven(movement, voltage=voltage), Driven(movement, plan(movement, saving, voltage), voltage=voltage)


def timed(drive, factor, *, passes=None, **more):
    """Return a run from A over B to C whose timetable is the shortest times, times a factor; P is passed at `passes` [s]."""
    calls = [call("A"), call("B", min_dwell_s=30.0), call("C")]
    free = make_trains(40.0, calls=calls, drive=DRIVES[drive], **HILLS, **CAR)
    _, b, c = Driven(compile_trains(free)).arrived_s
    at_b = b * factor
    at_c = at_b + 45.0 + (c - b - 30.0) * factor
    calls = [call("A", departure=0.0), call("B", arrival=at_b, departure=at_b + 45.0, min_dwell_s=30.0), call("C", arrival=at_c)]
    if passes is not None:
        calls.insert(2, passing("P", arrival=at_b + 45.0 + passes * (at_c - at_b - 45.0)))
    return make_trains(40.0, calls=calls, drive=DRIVES[drive], **HILLS, **CAR, **more)


def late(scenario, found):
    """Return by how much a run is late at its calls [s], 0 where none is planned; it comes to all of them."""
    planned = [one.arrival for one in scenario.timetable.trains[0].calls]
    assert np.isfinite(found.arrived_s).all()
    return np.array([0.0 if due is None else came - due for came, due in zip(found.arrived_s, planned, strict=True)])


@pytest.mark.parametrize(("track", "train"), CASES)
def test_energy_is_that_of_the_dynamic_programme(track, train):
    scenario = scenario_of(track, train)
    reference, movement = Reference(scenario), compile_trains(scenario)
    flat = Driven(movement)
    for factor in RESERVES:
        time_s = factor * flat.finished_s
        found = Driven(movement, plan(movement, Eco(kind="eco", running_time=time_s)))
        assert found.finished_s == pytest.approx(time_s, abs=0.5)
        assert found.net_j == pytest.approx(reference.in_time(time_s), rel=0.01)
        assert found.net_j < flat.net_j


def steep(seed):
    """Return a track of 6 km with four stops, slopes of -38 to 28 permille every 10 to 430 m, and limits of 80 to 125 km/h."""
    rng = np.random.default_rng(seed)
    ends = np.cumsum(rng.uniform(10.0, 430.0, 60))
    ends = [0.0, *ends[ends < 5900.0].tolist(), 6000.0]
    slopes = rng.uniform(-38.0, 28.0, len(ends)).round(1)
    return {
        "stops": {"values": [0.0, 1400.0, 3100.0, 6000.0]},
        "speed limits": {"values": [[0.0, 80], [900.0, 100], [2100.0, 125], [4300.0, 90]]},
        "gradients": {"values": [[at, float(slope)] for at, slope in zip(ends[:-1], slopes, strict=False)]},
    }


@pytest.mark.parametrize(("seed", "mass", "rate"), [(1, "uniform", 0.5), (2, "point", 0.8), (3, "uniform", 1.1)])
def test_energy_on_steep_tracks(seed, mass, rate):
    scenario = scenario_of(steep(seed), "flirt", mass=mass, rate_mps2=rate)
    reference, movement = Reference(scenario), compile_trains(scenario)
    flat = Driven(movement)
    for factor in RESERVES:
        time_s = factor * flat.finished_s
        found = Driven(movement, plan(movement, Eco(kind="eco", running_time=time_s)))
        assert found.finished_s == pytest.approx(time_s, abs=0.5)
        least, gross = reference.in_time(time_s), found.energy_j(returned=0.0)
        assert found.net_j == pytest.approx(least, abs=0.01 * max(abs(least), 0.2 * gross))  # downhill it is nearly nothing


def test_a_long_level_run_holds_one_speed_coasts_and_brakes_at_the_speed_of_the_theory():
    """Without regeneration braking begins at U = psi(V) / phi'(V), phi = v r(v), psi = v2 r'(v) (Howlett and Pudney 1995)."""
    a, c = 4000.0, 0.9 * 3.6**2
    line = {"stations": {"A": 0.0, "B": 60.0}, "limits": [(-1.0, 61.0, 160.0)]}
    more = {"resistance": {"a_n": a, "c_n_per_kmh2": 0.9}, "calls": [call("A"), call("B")]}
    _, found = driven(make_trains(60.0, **line, **more), reserve(10.0))
    v, s = found.rows["v_mps"], found.rows["s_m"]
    held = v[(s > 10_000.0) & (s < 45_000.0)]
    speed = held.mean()
    assert np.ptp(held) < 0.02 * speed
    braked = found.rows[(found.rows["friction_brake_n"] > 1000.0)]
    assert braked["v_mps"][0] == pytest.approx(2.0 * c * speed**3 / (a + 3.0 * c * speed**2), rel=0.03)
    coasting = found.rows[(s > 45_000.0) & (s < braked["s_m"][0] - 100.0)]
    assert (coasting["traction_n"][-60:] == 0.0).all()


def test_no_other_constant_speed_needs_less():
    """Power at the wheel over the speed is least resistance: of all plans with one ceiling the optimum holds none worse."""
    line = {"stations": {"A": 0.0, "B": 60.0}, "limits": [(-1.0, 61.0, 160.0)]}
    scenario = make_trains(60.0, **line, resistance={"a_n": 4000.0, "c_n_per_kmh2": 0.9}, calls=[call("A"), call("B")])
    flat, best = driven(scenario, reserve(10.0))
    _, cruise = driven(scenario, reserve(10.0, method="cruise"))
    assert cruise.finished_s == pytest.approx(best.finished_s, abs=1.0)
    assert best.net_j < cruise.net_j < flat.net_j


@pytest.mark.parametrize("drive", ["inverter", "table", "series_motors"])
@pytest.mark.parametrize("factor", [1.03, 1.1, 1.3])
def test_a_plan_arrives_on_time_and_saves(drive, factor):
    scenario = timed(drive, factor)
    flat, found = driven(scenario, to_time())
    assert late(scenario, found) == pytest.approx(0.0, abs=0.5)
    assert found.net_j < 0.97 * flat.net_j


@pytest.mark.parametrize("drive", ["inverter", "series_motors"])
def test_a_pass_is_on_time_as_well(drive):
    scenario = timed(drive, 1.2, passes=0.57)
    _, found = driven(scenario, to_time())
    assert late(scenario, found) == pytest.approx(0.0, abs=0.5)


def test_what_a_part_cannot_keep_the_next_makes_up_for():
    scenario = timed("inverter", 1.1, passes=0.45)
    _, found = driven(scenario, to_time())
    lateness = late(scenario, found)
    assert lateness[2] > 10.0
    assert lateness[3] == pytest.approx(0.0, abs=0.5)


def test_a_timetable_faster_than_the_train_is_driven_flat_out():
    scenario = timed("inverter", 0.9)
    movement = compile_trains(scenario)
    pieces, caps = plan(movement, to_time())
    assert (caps["y"] == 1.0).all()
    flat, found = Driven(movement), Driven(movement, (pieces, caps))
    assert found.arrived_s == pytest.approx(flat.arrived_s, abs=1e-6)


def test_with_far_too_much_time_a_train_waits_rather_than_crawl():
    scenario = timed("inverter", 4.0)
    _, found = driven(scenario, to_time(slowest_kmh=40.0))
    assert late(scenario, found)[1:].max() < -60.0
    cruising = found.rows["v_mps"][(found.rows["s_m"] > 2000.0) & (found.rows["s_m"] < 12_000.0)]
    assert cruising.min() > 40.0 / 3.6 - 0.2


def test_minutes_without_dwells_leave_room_for_the_dwell():
    stations = {"A": 0.0, "B": 2.0, "C": 4.0}
    calls = [call("A", departure=0.0), call("B", arrival=240.0, departure=240.0, min_dwell_s=20.0), call("C", arrival=480.0)]
    _, found = driven(make_trains(4.0, stations=stations, calls=calls, **CAR), to_time())
    assert found.arrived_s[1] == pytest.approx(220.0, abs=0.5)
    assert found.left_s[1] == pytest.approx(240.0, abs=0.5)
    assert found.arrived_s[2] == pytest.approx(480.0, abs=0.5)


def test_a_profile_of_the_voltage_is_met():
    scenario = timed("inverter", 1.1)
    profile = [(0.0, 3300.0), (12_000.0, 2300.0), (26_000.0, 3100.0), (40_000.0, 2700.0)]
    flat, found = driven(scenario, to_time(), profile)
    assert flat.arrived_s[2] < 0.97 * scenario.timetable.trains[0].calls[2].arrival
    assert late(scenario, found) == pytest.approx(0.0, abs=0.5)
    assert found.net_j < flat.net_j


def test_a_reserve_is_spread_in_proportion():
    calls = [call("A"), call("B", min_dwell_s=30.0), call("C")]
    scenario = make_trains(40.0, calls=calls, **HILLS, **CAR)
    flat, found = driven(scenario, reserve(8.0))
    legs = [np.array([one.arrived_s[1], one.arrived_s[2] - one.left_s[1]]) for one in (flat, found)]
    assert legs[1] == pytest.approx(1.08 * legs[0], abs=0.5)
    _, found = driven(scenario, Reserve(kind="reserve", seconds=60.0))
    legs[1] = np.array([found.arrived_s[1], found.arrived_s[2] - found.left_s[1]])
    assert legs[1] / legs[0] == pytest.approx(1.0 + 60.0 / legs[0].sum(), rel=1e-3)


def test_energy_that_nobody_takes_makes_a_train_coast_more():
    scenario = timed("inverter", 1.1)
    movement = compile_trains(scenario)
    kept, lost = (Driven(movement, plan(movement, to_time(returned_percent=share))) for share in (100.0, 0.0))
    assert lost.energy_j(returned=0.0) < kept.energy_j(returned=0.0)
    assert kept.net_j < lost.net_j


@pytest.mark.parametrize("method", ["optimal", "cruise"])
def test_a_plan_stays_below_the_ceiling_of_the_train(method):
    movement = compile_trains(scenario_of("CH_Fribourg_Bern", "flirt"))
    pieces, _ = plan(movement, reserve(8.0, method=method))
    own = movement.tables.pieces
    at = np.union1d(pieces["from_m"], own["from_m"])
    middles = 0.5 * (at[1:] + at[:-1])

    def square(rows):
        n = np.searchsorted(rows["from_m"], middles, side="right") - 1
        return rows["w"][n] + rows["dw"][n] * (middles - rows["from_m"][n])

    assert (square(pieces) <= square(own) + 1e-5).all()
    assert (np.diff(pieces["from_m"]) > 0.0).all()
    ends = pieces["w"][:-2] + pieces["dw"][:-2] * np.diff(pieces["from_m"][:-1])
    assert (pieces["w"][1:-1] >= ends - 1e-6).all()  # jumps upwards only


def test_cruise_reduces_all_limits_by_one_share():
    scenario = timed("inverter", 1.2)
    _, found = driven(scenario, to_time(method="cruise"))
    assert late(scenario, found) == pytest.approx(0.0, abs=1.0)
    s, v = found.rows["s_m"], found.rows["v_mps"]
    first, second = v[(s > 8000.0) & (s < 11_000.0)].max(), v[(s > 12_500.0) & (s < 13_500.0)].max()
    assert second / first == pytest.approx(90.0 / 120.0, rel=0.01)


def test_runs_that_are_alike_are_planned_once():
    calls = [call("A", departure=0.0), call("C", arrival=2200.0)]
    later = [call("A", departure=600.0), call("C", arrival=2800.0)]
    runs = [make_run("x", 40.0, calls=calls), make_run("y", 40.0, calls=later, time=600.0)]
    movement = compile_trains(make_trains(40.0, runs=runs, **LEVEL, **CAR))
    found = optimal_plans(movement, [(0, to_time()), (1, to_time())], 3000.0)
    assert found[0] is found[1]


def flirt_plan(track, factor, **more):
    """Return a FLIRT flat out and by its plan, which takes longer by a factor, and that time [s]."""
    movement = compile_trains(scenario_of(track, "flirt"))
    flat = Driven(movement)
    time_s = factor * flat.finished_s
    return flat, Driven(movement, plan(movement, Eco(kind="eco", running_time=time_s, **more))), time_s


@pytest.mark.parametrize(("permille", "factor"), [(-25.0, 1.4), (-25.0, 2.0), (-35.0, 1.4), (-10.0, 2.0)])
def test_where_braking_costs_nothing_a_train_is_slow_enough_to_be_on_time(permille, factor):
    """With prices of time above 0 alone it arrived up to 41 s early, though its speed was above `slowest_kmh`."""
    track = {"stops": {"values": [0.0, 20_000.0]}, "speed limits": {"values": [[0.0, 100]]}}
    _, found, time_s = flirt_plan(track | {"gradients": {"values": [[0.0, permille]]}}, factor, returned_percent=0.0)
    assert found.finished_s == pytest.approx(time_s, abs=0.5)


def test_a_train_coasts_to_a_stop_below_its_lowest_cruising_speed():
    """With 20 km/h it needed 12 % more than with 2 km/h: it held 20 km/h, then braked."""
    short = {"stops": {"values": [0.0, 500.0, 1000.0, 1600.0, 2100.0]}, "speed limits": {"values": [[0.0, 80]]}}
    short |= {"gradients": {"values": [[0.0, 10.0], [900.0, -15.0]]}}
    (_, slow, _), (_, free, time_s) = (flirt_plan(short, 1.4, slowest_kmh=kmh) for kmh in (20.0, 2.0))
    assert slow.finished_s == pytest.approx(time_s, abs=0.5)
    assert slow.net_j == pytest.approx(free.net_j, rel=0.02)


def test_what_is_fed_back_is_folded_back_by_place():
    """The voltage is high on the last hundred metres only; the mean over the points of the profile is not."""
    movement = compile_trains(scenario_of("CH_Fribourg_Bern", "flirt"))
    flat = Driven(movement)
    end = float(movement.tables.trains[0]["route_m"])
    saving = Eco(kind="eco", running_time=1.1 * flat.finished_s)
    points = [(0.0, 3000.0), (end - 100.0, 3000.0), *((end - 99.0 + n, 3900.0) for n in range(20))]
    (_, caps), (_, same) = plan(movement, saving), plan(movement, saving, points)
    coasting, other = ((np.diff(rows["x"], append=end) * (rows["y"] == 0.0)).sum() for rows in (caps, same))
    assert other == pytest.approx(coasting, rel=0.05)

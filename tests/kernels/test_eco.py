"""Tables of drives for the planner, and its dynamic programme, against closed forms and brute force."""

import itertools

import numpy as np
import pytest
from small_trains import BRAKE, DRIVES, make_trains

from tractionpower.kernels.eco import (
    CONTROLS,
    ECO,
    MODES,
    STAGE,
    cost_of,
    follow,
    lay_choices,
    lay_floors,
    lay_slopes,
    sweep,
)
from tractionpower.kernels.eco_drive import BRAKE_N, COLUMNS, FIRST_POWER, FULL_N, SHARES, tabulate_drive
from tractionpower.kernels.train_tables import MOVER
from tractionpower.movement.compile import compile_trains

LINES = (3000.0, 1e300)


def table(dv=0.1, lines=LINES, **more):
    movement = compile_trains(make_trains(5.0, **more))
    drive = np.zeros((450, COLUMNS))
    tabulate_drive(movement.tables, 0, np.zeros(1, MOVER), lines, dv, drive)
    return np.arange(450) * dv, drive


def test_table_of_an_inverter():
    v, drive = table(brake=BRAKE)
    v, drive = v[1:], drive[1:]
    effort = np.minimum(200e3, 3e6 / v)
    assert drive[:, FULL_N] == pytest.approx(effort)
    assert drive[:, BRAKE_N] == pytest.approx(np.minimum(100e3, 2e6 / v))
    for share in range(SHARES + 1):
        assert drive[:, FIRST_POWER + share] == pytest.approx(share / SHARES * effort * v / 0.85)


def test_an_efficiency_map_is_taken_at_the_share_of_the_effort():
    rows = [
        {"speed_kmh": v, "load_percent": load, "efficiency": eta} for v in (0.0, 200.0) for load, eta in ((50, 0.7), (100, 0.9))
    ]
    given = {"kind": "inverter", "starting_effort_kn": 200.0, "power_kw": 3000.0, "efficiency_map": rows, "max_current_a": 5000.0}
    v, drive = table(drive=given)
    assert drive[1:, FIRST_POWER + SHARES // 2] == pytest.approx(0.5 * np.minimum(200e3, 3e6 / v[1:]) * v[1:] / 0.7)


@pytest.mark.parametrize("kind", ["series_motors", "table"])
def test_a_drive_takes_more_than_it_gives_at_every_share(kind):
    v, drive = table(drive=DRIVES[kind], resistance={"a_n": 2000.0})
    given = (drive[:, FULL_N] * v)[10:400, np.newaxis] * np.arange(SHARES + 1) / SHARES
    power = drive[10:400, FIRST_POWER:]
    assert (power >= given * (1.0 - 1e-9)).all()
    assert (power[:, 1:] > 0.0).all()
    assert (power[:, 1:-1] <= power[:, -1:] * (1.0 + 1e-9)).all()


def test_without_voltage_there_is_no_effort_and_at_a_current_limit_less():
    assert (table(lines=(0.0, 1e300))[1] == 0.0).all()
    v, drive = table(lines=(3000.0, 500.0))
    assert drive[200, FULL_N] * v[200] / 0.85 == pytest.approx(3000.0 * 500.0)


def small_way(count=5, length_m=200.0):
    """Return stages, ceilings, drives, train of a short way between two speeds, with its slopes."""
    movement = compile_trains(make_trains(5.0, brake=BRAKE, resistance={"a_n": 3000.0, "c_n_per_kmh2": 1.0}))
    drives = np.zeros((1, 600, COLUMNS))
    tabulate_drive(movement.tables, 0, np.zeros(1, MOVER), LINES, 0.1, drives[0])
    stages = np.zeros(count, STAGE)
    stages["from_m"], stages["length_m"], stages["back"] = np.arange(count) * length_m, length_m, 1.0
    lay_slopes(movement.tables, 0, np.zeros(1, MOVER), stages)
    stages["constant_n"] = np.array([0.0, 8000.0, -6000.0, 0.0, 9000.0])[:count]
    train, eco = movement.tables.trains[0], np.zeros(1, ECO)
    for name in ("inertia_kg", "a_n", "b_ns_per_m", "c_ns2_per_m2"):
        eco[name] = train[name]
    eco["gain"], eco["back"], eco["dv"], eco["level_v"], eco["slow_w"] = 0.8, 1.0, 0.1, 0.25, 25.0
    ceilings = np.full(count + 1, 900.0)
    lay_floors(stages, ceilings, drives, eco)
    return stages, ceilings, drives, eco


def best_way(price, switch_s=0.0):
    stages, ceilings, drives, eco = small_way()
    levels = int(np.sqrt(ceilings.max()) / 0.25) + 3
    choices, value = np.zeros((5, levels, CONTROLS, 3)), np.zeros((6, MODES, levels))
    squares, prices = np.zeros(6), np.array([price])
    squares[0] = 400.0
    lay_choices(stages, ceilings, drives, eco, choices)
    sweep(stages, ceilings, eco, choices, prices, switch_s, value)
    energy = follow(stages, ceilings, drives, eco, prices, value, switch_s, squares)
    return energy, squares


def seconds(squares, length_m=200.0):
    return (2.0 * length_m / (np.sqrt(squares[1:]) + np.sqrt(squares[:-1]))).sum()


@pytest.mark.parametrize("price", [2e5, 1e6, 4e6])
def test_the_best_of_five_stages_is_that_of_all_ways_on_a_grid(price):
    stages, _, drives, eco = small_way()
    efforts, shares = np.zeros(5), np.zeros(5)
    energy, squares = best_way(price)
    found = energy + price * seconds(squares)
    least = np.inf
    steps = np.arange(-60.0, 61.0, 12.0)
    for changes in itertools.product(steps, repeat=5):
        way = 400.0 + np.concatenate(([0.0], np.cumsum(changes)))
        if way.max() > 900.0 or way.min() < 25.0 or np.diff(way).min() < -200.0:
            continue
        cost = cost_of(stages, drives, eco, way, efforts, shares)
        if shares.max() <= 1.0:
            least = min(least, cost + price * seconds(way))
    assert found <= least * (1.0 + 2e-3)
    assert cost_of(stages, drives, eco, squares, efforts, shares) == pytest.approx(energy)


def test_without_a_value_the_train_runs_with_its_greatest_effort():
    stages, ceilings, drives, eco = small_way(length_m=40.0)
    squares = np.zeros(6)
    squares[0] = 400.0
    follow(stages, ceilings, drives, eco, np.array([np.inf]), np.zeros((0, MODES, 200)), 0.0, squares)
    efforts, shares = np.zeros(5), np.zeros(5)
    cost_of(stages, drives, eco, squares, efforts, shares)
    assert squares[-1] < 900.0
    assert shares == pytest.approx(1.0, abs=0.01)


def test_changes_of_the_control_cost_something_so_that_it_does_not_chatter():
    free, dear = best_way(1e6)[1], best_way(1e6, switch_s=100.0)[1]
    assert np.count_nonzero(np.diff(np.sign(np.diff(dear)))) <= np.count_nonzero(np.diff(np.sign(np.diff(free))))
    assert best_way(1e6)[0] + 1e6 * seconds(free) <= best_way(1e6, 100.0)[0] + 1e6 * seconds(dear) + 1e3

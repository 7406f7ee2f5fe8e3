"""The calculation core: trains that come and go, samples, singletons, SimPy."""

import gc
import weakref

import pytest
import simpy
from point_trains import add, characteristics, constant_effort, line, run_to

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.errors import UsageError


def state_of(train):
    return (train.place_m, train.speed_mps, train.state, train.tractive_force_kn, train.resistance_kn)


def three(names, leaves=None):
    """Return the states of trains added in an order of names; each has a speed and a place to stop of its own."""
    core, way = TrainDynamics(), line()
    core.add_inclination(way, 6.0, between_m=(800.0, 2500.0))
    trains = {name: add(core, characteristics(), name, route=(way,)) for name in names}
    for name, train in trains.items():
        train.accelerate(speed_kmh=50.0 + 10.0 * ord(name) - 10.0 * ord("a"))
        train.stop(at_m=2000.0 + 100.0 * ord(name))
    run_to(core, 60.0)
    if leaves:
        core.remove_train(trains[leaves])
    run_to(core, 100.0)
    return {name: state_of(train) for name, train in trains.items()}


def test_the_order_of_trains_does_not_matter():
    assert three("abc") == three("cab")


def test_a_removed_train_stays_as_it_was_and_the_others_go_on():
    all_run, one_left = three("abc"), three("abc", leaves="b")
    assert {name: one_left[name] for name in "ac"} == {name: all_run[name] for name in "ac"}
    assert one_left["b"] != all_run["b"]


def test_trains_come_at_their_time_and_may_come_again():
    core = TrainDynamics()
    core.calculate_speeds(100.0)
    train = add(core, constant_effort(100.0))
    assert train.calculated_s == 100.0
    train.accelerate(20.0)
    run_to(core, 110.0)
    assert train.place_m == pytest.approx(0.2 * 10.0**2 / 2)
    core.remove_train(train)
    run_to(core, 200.0)
    assert train.place_m == pytest.approx(10.0)
    core.add_train(train)
    run_to(core, 210.0)
    assert train.place_m == pytest.approx(0.2 * 20.0**2 / 2)


def test_process_trains_visits_all_and_may_remove_them():
    core = TrainDynamics()
    for name in ("b", "a"):
        add(core, characteristics(), name)
    seen = []
    core.process_trains(lambda train: (seen.append(train.name), core.remove_train(train)))
    assert seen == ["b", "a"]
    assert core.trains == ()


def test_one_core_of_the_process_and_one_of_each_environment():
    env, other = simpy.Environment(), simpy.Environment()
    assert TrainDynamics.get_instance(env) is TrainDynamics.get_instance(env)
    assert TrainDynamics.get_instance(env) is not TrainDynamics.get_instance(other)
    mine = TrainDynamics.get_instance()
    try:
        assert TrainDynamics.get_instance() is mine
        assert TrainDynamics() is not mine
        TrainDynamics.forget_instance()
        assert TrainDynamics.get_instance() is not mine
    finally:
        TrainDynamics.forget_instance()


def test_the_core_of_an_environment_goes_with_it():
    env = simpy.Environment()
    core = weakref.ref(TrainDynamics.get_instance(env))
    del env
    gc.collect()
    assert core() is None


@pytest.mark.parametrize("period_s", [0.1, 1.0, 2.5])
def test_a_simpy_process_scans_and_commands_hold_from_their_moment_on(period_s):
    env = simpy.Environment()
    core = TrainDynamics(env)
    core.run(env, period_s)
    train = add(core, constant_effort(100.0))
    calculated = []

    def driver():
        train.accelerate(30.0)
        yield env.timeout(10.3)
        calculated.append((env.now, train.calculated_s))
        train.stop()
        yield core.when(lambda: train.is_standing)
        calculated.append(env.now)

    env.process(driver())
    env.run(100.0)
    v = 0.2 * 10.3
    assert train.place_m == pytest.approx(v * 10.3 / 2 + v * v / (2 * 0.5), rel=1e-12)
    assert train.stood_since_s == pytest.approx(10.3 + v / 0.5, rel=1e-12)
    assert calculated[0][0] - period_s <= calculated[0][1] <= 10.3  # the scan before
    assert 0.0 <= calculated[1] - train.stood_since_s <= period_s + 1e-9  # the scan behind


def test_without_a_clock_commands_hold_from_the_last_sample_on():
    core = TrainDynamics()
    train = add(core, constant_effort(100.0), speed_mps=10.0)
    core.calculate_speeds(5.0)
    train.stop()
    core.calculate_speeds(6.0)
    assert (train.speed_mps, train.required_speed_mps) == (9.5, 0.0)


@pytest.mark.parametrize("method", ["euler", "fine"])
def test_places_between_samples(method):
    core, way = TrainDynamics(method=method), line()
    core.add_inclination(way, 8.0, between_m=(300.0, 900.0))
    train = add(core, characteristics(), route=(way,))
    train.accelerate(speed_kmh=70.0)
    train.stop(at_m=1500.0)
    known = []
    for k in range(0, 160, 2):
        core.calculate_speeds(float(k))
        ahead = train.position_at(k + 1.3)
        core.calculate_speeds(float(k + 2))
        assert train.position_at(k + 1.3) == pytest.approx(ahead, abs=1e-9)
        assert train.position_at(float(k)) == pytest.approx(known[-1] if known else 0.0, abs=1e-9)
        known.append(train.place_m)
    assert train.place_m == pytest.approx(1500.0)
    with pytest.raises(UsageError, match="known from"):
        train.position_at(100.0)


def test_what_is_asked_wrongly():
    core, way = TrainDynamics(), line(1000.0)
    train = add(core, characteristics(), route=(way,), speed_kmh=100.0)
    for call, told in (
        (train.accelerate, "either as speed_mps or as speed_kmh"),
        (lambda: train.accelerate(1.0, speed_kmh=3.6), "either as speed_mps or as speed_kmh"),
        (lambda: train.accelerate(-1.0), "-1.0 is no speed"),
        (lambda: train.accelerate(float("nan")), "nan is no speed"),
        (lambda: train.stop(at_m=700.0), "needs 771.605 m and has 700 m"),
        (lambda: train.accelerate(speed_kmh=50.0, at_m=500.0), "cannot brake to 50 km/h"),
        (lambda: DynTrain("x").accelerate(5.0), "no characteristics"),
        (lambda: core.add_train(DynTrain("x")), "no characteristics"),
        (lambda: core.add_train(train), "already"),
        (lambda: core.add_train(DynTrain("train", characteristics())), "already"),
        (lambda: TrainDynamics().add_train(train), "already"),
        (lambda: core.remove_train(DynTrain("train", characteristics())), "was not added"),
        (lambda: core.add_arc(way, 25.0), "above 30 m"),
        (lambda: TrainDynamics(arc_law=(700.0, 0.0)).add_arc(way, -5.0), "above 0 m"),
        (lambda: core.add_inclination(way, 300.0), "-200 to 200"),
        (lambda: core.add_tunnel(way, 3), "1 and 2"),
        (lambda: core.add_arc(way, 400.0, between_m=(500.0, 1500.0)), "not on 'line', which is 1000 m long"),
        (lambda: TrainDynamics(method="exact"), "euler, held_speed, fine"),
        (core.run, "name the SimPy environment"),
        (lambda: TrainDynamics(simpy.Environment()).run(simpy.Environment()), "another SimPy environment"),
        (lambda: core.run(simpy.Environment(), 0.0), "above 0"),
        (lambda: core.when(lambda: True), "SimPy environment"),
    ):
        with pytest.raises(UsageError, match=told):
            call()
    core.calculate_speeds(5.0)
    for time_s in (4.0, float("nan")):
        with pytest.raises(UsageError, match="5 s already"):
            core.calculate_speeds(time_s)


def test_the_greatest_speed_caps_what_is_asked():
    core = TrainDynamics()
    train = add(core, characteristics())
    train.accelerate(speed_kmh=400.0)
    assert train.required_speed_mps == pytest.approx(120.0 / 3.6)


def test_a_train_may_be_subclassed_and_get_other_characteristics():
    class Freight(DynTrain):
        load = "coal"

    core = TrainDynamics()
    train = Freight("f", constant_effort(100.0), (line(),))
    core.add_train(train)
    train.accelerate(30.0)
    core.calculate_speeds(10.0)
    train.set_train_characteristics(constant_effort(300.0))
    core.calculate_speeds(20.0)
    assert train.speed_mps == pytest.approx(0.2 * 10 + 0.6 * 10)
    assert train.characteristics == constant_effort(300.0)

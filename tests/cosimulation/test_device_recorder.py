"""What the recorder of devices keeps of a run: its columns, its warm-up, the time until a reserve feeds."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling
from small_studies import load, make_scenario

from tractionpower.cosimulation import quiet
from tractionpower.cosimulation.check import counted_steps
from tractionpower.cosimulation.device_recorder import DeviceRecorder, Wait, find_waits
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.io.rating_files import DUTY_CLASSES
from tractionpower.studies.ratings.use import uses_of
from tractionpower.supply.devices import DeviceCurrents

UNITS = {"no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1, "units": 2}
RESERVE = UNITS | {"reserve_units": 1, "reserve_after_s": 60.0, "reserve_overload_percent": 25.0}


RESERVED = {name: value for name, value in RESERVE.items() if name.startswith("reserve")}


def watched(scenario):
    """Return the recorder of a run, and the currents of all its columns."""
    each = QuietRun(scenario)
    recorder, currents, kept = DeviceRecorder(scenario, each.compiled.supply), DeviceCurrents(each.compiled.supply), []
    each.watches += [recorder, lambda time_s, rows, supply: kept.append(currents(rows, supply))]
    each.execute()
    return recorder, np.concatenate(kept)


def station(name, km, **more):
    return {"id": name, "km": km, **UNITS, **more}


@pytest.mark.parametrize("block", [1, 37])
def test_the_results_do_not_depend_on_the_blocks(block, monkeypatch):
    scenario = RandomCoupling(3, 100).scenario
    whole, amps = watched(scenario)
    monkeypatch.setattr(quiet, "STEPS", block)
    pieces, _ = watched(scenario)
    for name in ("peak_a", "peak_s", "rms_a", "mean_a", "best_rms", "from_s", "best_mean", "mean_from_s"):
        np.testing.assert_array_equal(getattr(pieces.loads, name), getattr(whole.loads, name))
    np.testing.assert_allclose(whole.loads.rms_a, np.sqrt((amps**2).mean(axis=0)), rtol=1e-12)
    np.testing.assert_array_equal(whole.loads.peak_a, np.abs(amps).max(axis=0))


def test_the_warm_up_does_not_count():
    scenario = couple(run("x"), end_s=60.0)
    clock = scenario.clock.model_copy(update={"warm_up": 40.0})
    recorder, amps = watched(scenario.model_copy(update={"clock": clock}))
    assert recorder.from_s == 40.0
    assert recorder.loads.count == 20
    np.testing.assert_array_equal(recorder.loads.peak_a, np.abs(amps[40:]).max(axis=0))


@pytest.mark.parametrize(("end_s", "full"), [(9.0, []), (15.0, [10.0, 15.0]), (60.0, [10.0, 15.0, 60.0])])
def test_windows_longer_than_the_run_take_no_memory(end_s, full):
    recorder, _ = watched(couple(run("x"), end_s=end_s))
    assert list(recorder.loads.windows_s) == full
    assert np.isfinite(recorder.loads.best_rms).all()


def test_of_a_section_the_greater_end_counts():
    recorder, amps = watched(couple(run("x"), end_s=120.0))
    number = [device.id for device in recorder.devices].index("track 1 km 0-10")
    ends = np.flatnonzero(recorder.columns == number)
    rms = np.sqrt((amps[:, ends] ** 2).mean(axis=0))
    assert recorder.of(number) == ends[rms.argmax()]
    assert recorder.peak_of(number) == ends[np.abs(amps[:, ends]).max(axis=0).argmax()]


def test_until_the_reserve_feeds_the_units_are_held_to_less():
    """Worked by hand: held against the ratings the unit currents of 20 s to 80 s count 1/1.25; as loads they count whole."""
    stations = [station("A", 0.0, rated_current_a=300.0, **RESERVED), station("B", 20.0, rated_current_a=300.0)]
    events = [{"device": "A", "time": time, "units_in_service": k} for time, k in ((20.0, 1), (80.0, 2))]
    recorder, amps = watched(couple(run("x"), end_s=120.0, substations=stations, switch_events=events))
    np.testing.assert_allclose(recorder.loads.rms_a, np.sqrt((amps**2).mean(axis=0)), rtol=1e-12)
    names = [device.id for device in recorder.devices]
    a = recorder.of(names.index("A unit"))
    plant = recorder.of(names.index("A"))
    assert recorder.eased_columns == {a: 0, plant: 1}
    held = amps[:, [a]].copy()
    held[20:80] /= 1.25
    brute = max(np.sqrt((held[k : k + 60, 0] ** 2).mean()) for k in range(61))
    assert recorder.eased.rms_a[0] == pytest.approx(np.sqrt((held**2).mean()), rel=1e-12)
    assert recorder.eased.best_rms[recorder.eased.windows_s.index(60.0), 0] == pytest.approx(brute, rel=1e-12)
    assert recorder.loads.peak_a[a] == np.abs(amps[:, a]).max()
    assert 20.0 <= recorder.loads.peak_s[a] < 80.0

    found = {(use.device.id, use.window_s): use for use in uses_of(recorder, 100.0)}
    use = found["A unit", 60.0]
    assert use.load_a == recorder.loads.best_rms[recorder.loads.windows_s.index(60.0), a]
    assert use.utilisation_percent == pytest.approx(100.0 * brute / 300.0, rel=1e-12)
    assert use.load_a / use.permitted_a == pytest.approx(brute / 300.0, rel=1e-12)
    assert 300.0 < use.permitted_a <= 1.25 * 300.0
    assert found["B unit", 60.0].permitted_a == 300.0
    whole = found["A", 60.0]  # rated by the two units in service from the start: as much used as they are
    assert whole.load_a == pytest.approx(max(np.sqrt((amps[k : k + 60, plant] ** 2).mean()) for k in range(61)), rel=1e-12)
    assert whole.utilisation_percent == pytest.approx(use.utilisation_percent, rel=1e-12)


def test_waits_that_overlap_permit_the_overload_once():
    """A second unit goes while the first is still awaited: 20 s to 80 s is one time."""
    stations = [station("A", 0.0, **RESERVED) | {"units": 3, "reserve_units": 2}, station("B", 20.0)]
    events = [{"device": "A", "time": time, "units_in_service": k} for time, k in ((20.0, 2), (40.0, 1), (80.0, 3))]
    scenario = couple(run("x"), end_s=120.0, substations=stations, switch_events=events)
    assert find_waits(scenario) == (Wait("A", 20.0, 80.0, 1.25),)
    recorder, amps = watched(scenario)
    held = amps[:, 0].copy()
    held[20:80] /= 1.25
    assert recorder.eased.rms_a[0] == pytest.approx(np.sqrt((held**2).mean()), rel=1e-12)


@pytest.mark.parametrize(("end_s", "warm_up_s", "rows"), [(7196.0, None, 1440), (7200.0, 3.0, 1439), (7195.0, None, 1439)])
def test_a_last_step_beyond_the_end_counts_for_the_windows(end_s, warm_up_s, rows):
    """A window of 7200 s is as long as 1440 steps of 5 s, whatever the clock says of the last one."""
    units = [{"id": "A", "km": 0.0, **UNITS, "rated_current_a": 300.0, "duty_class": "VI"}, station("B", 20.0)]
    made = make_scenario(load("x", 5.0), substations=units, clock={"end": end_s, "step_s": 5.0, "warm_up": warm_up_s})
    scenario = made.model_copy(update={"duty_classes": DUTY_CLASSES.shipped})
    recorder, amps = watched(scenario)
    assert (recorder.loads.count, counted_steps(scenario.clock)) == (rows, rows)
    assert (7200.0 in recorder.loads.windows_s) == (rows == 1440)
    use = next(use for use in uses_of(recorder, 100.0) if use.device.id == "A unit" and use.window_s == 7200.0)
    assert use.load_a == pytest.approx(np.sqrt((amps[-rows:, 0] ** 2).mean()), rel=1e-12)


def test_of_a_case_only_the_windows_of_ratings_take_memory():
    stations = [station("A", 0.0, rated_current_a=300.0), station("B", 20.0)]
    scenario = couple(substations=stations, end_s=3600.0)
    supply = QuietRun(scenario).compiled.supply
    assert DeviceRecorder(scenario, supply, windows_s=()).loads.windows_s == (60.0,)
    assert len(DeviceRecorder(scenario, supply).loads.windows_s) == 7


@pytest.mark.parametrize(
    ("more", "events", "expected"),
    [
        (RESERVE, [(20.0, 1), (80.0, 2)], [(20.0, 80.0)]),
        (RESERVE, [(20.0, 1), (90.0, 2)], []),  # the reserve would have had to feed before
        (RESERVE, [(20.0, 1)], []),  # nothing comes back
        (UNITS, [(20.0, 1), (80.0, 2)], []),  # no reserve
        (RESERVE | {"units_in_service": 1}, [(50.0, 2)], [(0.0, 50.0)]),  # out when the clock starts
        (RESERVE, [(20.0, 1), (40.0, 2), (60.0, 0), (70.0, 1)], [(20.0, 40.0), (60.0, 70.0)]),
        (RESERVE | {"units": 3}, [(20.0, 2), (30.0, 1), (50.0, 2), (75.0, 3)], [(20.0, 75.0)]),  # nested: once, not twice
    ],
)
def test_when_a_reserve_is_awaited(more, events, expected):
    switch = [{"device": "A", "time": time, "units_in_service": k} for time, k in events]
    scenario = couple(substations=[{"id": "A", "km": 0.0, **more}, station("B", 20.0)], switch_events=switch)
    assert find_waits(scenario) == tuple(Wait("A", low, high, 1.25) for low, high in expected)

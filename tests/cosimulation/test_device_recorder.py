"""What the recorder of devices keeps of a run: its columns, its warm-up, the time until a reserve feeds."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling

from tractionpower.cosimulation import quiet
from tractionpower.cosimulation.device_recorder import DeviceRecorder, Wait, find_waits
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.supply.devices import DeviceCurrents

UNITS = {"no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1, "units": 2}
RESERVE = UNITS | {"reserve_units": 1, "reserve_after_s": 60.0, "reserve_overload_percent": 25.0}


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


def test_until_the_reserve_feeds_the_units_count_less():
    """Worked by hand: the unit currents of 20 s to 80 s count 1/1.25; as peaks they count whole."""
    stations = [station("A", 0.0, **{k: v for k, v in RESERVE.items() if k.startswith("reserve")}), station("B", 20.0)]
    events = [{"device": "A", "time": time, "units_in_service": k} for time, k in ((20.0, 1), (80.0, 2))]
    recorder, amps = watched(couple(run("x"), end_s=120.0, substations=stations, switch_events=events))
    names = [device.id for device in recorder.devices]
    a, b = (recorder.of(names.index(name)) for name in ("A unit", "B unit"))
    counted = amps[:, a].copy()
    counted[20:80] /= 1.25
    assert recorder.loads.rms_a[a] == pytest.approx(np.sqrt((counted**2).mean()), rel=1e-12)
    assert recorder.loads.peak_a[a] == np.abs(amps[:, a]).max()
    assert 20.0 <= recorder.loads.peak_s[a] < 80.0
    assert recorder.loads.rms_a[b] == pytest.approx(np.sqrt((amps[:, b] ** 2).mean()), rel=1e-12)


@pytest.mark.parametrize(
    ("more", "events", "expected"),
    [
        (RESERVE, [(20.0, 1), (80.0, 2)], [(20.0, 80.0)]),
        (RESERVE, [(20.0, 1), (90.0, 2)], []),  # the reserve would have had to feed before
        (RESERVE, [(20.0, 1)], []),  # nothing comes back
        (UNITS, [(20.0, 1), (80.0, 2)], []),  # no reserve
        (RESERVE | {"units_in_service": 1}, [(50.0, 2)], [(0.0, 50.0)]),  # out when the clock starts
        (RESERVE, [(20.0, 1), (40.0, 2), (60.0, 0), (70.0, 1)], [(20.0, 40.0), (60.0, 70.0)]),
    ],
)
def test_when_a_reserve_is_awaited(more, events, expected):
    switch = [{"device": "A", "time": time, "units_in_service": k} for time, k in events]
    scenario = couple(substations=[{"id": "A", "km": 0.0, **more}, station("B", 20.0)], switch_events=switch)
    assert find_waits(scenario) == tuple(Wait("A", low, high, 1.25) for low, high in expected)

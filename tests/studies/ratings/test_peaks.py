"""Parts of trains in peaks: they add up, and each is what falls away when the train is taken out of a real network."""

import math
from collections import defaultdict

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling

from tractionpower.cosimulation.places import Places
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.model.loads import Load
from tractionpower.model.timetable import Timetable
from tractionpower.supply.devices import DeviceCurrents


def by_device(rows):
    found = defaultdict(list)
    for row in rows:
        found[row["device"]].append(row)
    return found


def check_sums(rows):
    for own in by_device(rows).values():
        if math.isnan(own[0]["peak_s"]):
            assert own[0]["peak_a"] == 0.0
            continue
        total = sum(row["part_a"] for row in own) + own[0]["remainder_a"]
        assert total == pytest.approx(own[0]["peak_a"], abs=1e-3 * (1 + len(own)) + 1e-6)


@pytest.mark.parametrize("seed", [1, 3, 4, 6, 8])
def test_parts_add_up(seed, rated):
    """Whatever conducts, regenerates, is off or fed by unequal substations."""
    check_sums(rated(RandomCoupling(seed, 120).scenario).tables["peaks"])


def test_parts_add_up_over_switching(rated):
    events = [{"device": "A", "time": 40.0, "state": "rectifiers_out"}, {"device": "C", "time": 60.0, "state": "open"}]
    found = rated(couple(run("x"), run("y", track="2", low=20.0, high=0.0), end_s=120.0, switch_events=events))
    check_sums(found.tables["peaks"])
    assert by_device(found.tables["peaks"])["B"][0]["peak_s"] >= 40.0


def source(name, km, volts):
    return {"id": name, "km": km, "no_load_voltage_v": volts, "internal_resistance_ohm": 0.12, "conducts": "both"}


def test_each_part_is_what_falls_away_without_the_train(rated):
    """A network calculation with the currents of the peak as loads, with and without each of them."""
    substations = [source("A", 0.0, 3500.0), source("B", 20.0, 3450.0)]
    depot = {"id": "depot", "track": "2", "km": 4.0, "power_kw": 900.0}
    more = {"substations": substations, "loads": [depot]}
    scenario = couple(run("x"), run("y", "series_motors", "2", 20.0, 3.0, time=20.0), run("z", low=6.0), end_s=150.0, **more)
    found = rated(scenario)
    recorder, own = found.watch.recorder, by_device(found.tables["peaks"])
    names = [device.id for device in recorder.devices]
    for device in ("A", "B unit", "A 1 high_km", "C 2 high_km", "track 1 km 0-10", "rails 1 2 km 0-20"):
        rows = {row["train"]: row for row in own[device]}
        column = recorder.peak_of(names.index(device))
        sign = np.sign(recorder.loads.signed_peak_a[column])
        loads = loads_at(found, scenario, own[device][0]["peak_s"])
        assert set(loads) == {"depot", "x", "y", "z"}
        whole = sign * calculated(scenario, loads)[column]
        assert whole == pytest.approx(own[device][0]["peak_a"], abs=1e-4)
        for name in loads:
            rest = {each: load for each, load in loads.items() if each != name}
            part = rows["" if name == "depot" else name]["part_a"]
            assert part == pytest.approx(whole - sign * calculated(scenario, rest)[column], abs=1e-4), (device, name)
        assert own[device][0]["remainder_a"] == pytest.approx(sign * calculated(scenario, {})[column], abs=1e-4)


def loads_at(found, scenario, peak_s):
    """Return all that takes a current in the step at `peak_s` [s] as loads of that current."""
    time_s, rows, _ = next(each for each in found.seen if each[0][0] <= peak_s <= each[0][-1])
    at = int(np.searchsorted(time_s, peak_s))
    ends = np.cumsum(rows.steps["trains"])
    movement = found.run.movement
    places = Places(scenario, movement)
    loads = {"depot": Load(id="depot", track="2", km=4.0, current_a=float(rows.load_a[at, 0]), limits="none")}
    for row in rows.trains[ends[at] - rows.steps["trains"][at] : ends[at]]:
        track, km = places.name(int(row["train"]), float(row["s_m"]))
        name = movement.names[int(row["train"])]
        loads[name] = Load(id=name, track=track, km=km, current_a=float(row["current_a"]), limits="none")
    return loads


def calculated(scenario, loads):
    """Return the currents of all columns in a study without trains [A]."""
    supply = scenario.supply.model_copy(update={"loads": tuple(loads.values())})
    clock = scenario.clock.model_copy(update={"end": 1.0})
    each = QuietRun(scenario.model_copy(update={"supply": supply, "clock": clock, "timetable": Timetable()}))
    currents, kept = DeviceCurrents(each.compiled.supply), []
    each.watches.append(lambda time_s, rows, tables: kept.append(currents(rows, tables)[0]))
    each.execute()
    return kept[0]


def test_a_study_without_trains_has_peaks_too(rated):
    load = {"id": "depot", "track": "1", "km": 4.0, "power_kw": 900.0}
    found = rated(couple(end_s=20.0, loads=[load]))
    (row,) = by_device(found.tables["peaks"])["A"]
    assert (row["train"], row["peak_s"]) == ("", 0.0)
    assert row["part_a"] + row["remainder_a"] == pytest.approx(row["peak_a"], abs=1e-6)
    assert row["train_current_a"] == pytest.approx(found.seen[0][1].source_a[0].sum(), rel=1e-6)

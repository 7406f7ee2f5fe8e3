"""Devices and their currents: names, units, what a common return feeder carries, the two ends of sections."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling
from small_supplies import OWN_RAILS, RAILS, small_line, small_supply

from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.io.limits_files import shipped_limits
from tractionpower.supply.compile import compile_network
from tractionpower.supply.devices import DeviceCurrents, columns_of, devices_of, sums_of_columns

OWN_RETURN = {"at": "A", "track": "1", "side": "return", "resistance_ohm": 0.001}
LIMITS = shipped_limits()


def compiled(**changes):
    return compile_network(small_supply(**changes), small_line(), LIMITS)


def test_what_there_is():
    devices = devices_of(compiled())
    by_id = {device.id: device for device in devices}
    assert len(by_id) == len(devices)
    assert (by_id["A unit"].station, by_id["M"].from_km) == ("A", 8.0)
    kinds = {
        "A unit": "unit",
        "M": "substation",
        "M 1 low_km": "feeder",
        "C 2 high_km": "cabin_feeder",
        "A return": "return_feeder",
    }
    assert {name: by_id[name].kind for name in kinds} == kinds
    line = by_id["track 1 km 0-8"]
    assert (line.kind, line.track, line.from_km, line.to_km, line.station) == ("contact_line", "1", 0.0, 8.0, "")
    assert (by_id["rails 1 2 km 8-20"].kind, by_id["rails 1 2 km 8-20"].track) == ("rails", "1 2")
    columns = columns_of(devices)
    assert [devices[k].kind in ("contact_line", "rails") for k in columns].count(True) == 2 * sum(
        device.kind in ("contact_line", "rails") for device in devices
    )


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out", "bypassed", "open"])
def test_states_do_not_change_devices(state):
    station = {"id": "M", "km": 8.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12, "state": state}
    others = [s.model_dump() for s in small_supply().substations if s.id != "M"]
    assert devices_of(compiled(substations=[*others, station])) == devices_of(compiled())


def test_a_substation_with_a_return_feeder_for_each_track_has_no_common_one():
    feeders = [OWN_RETURN, OWN_RETURN | {"track": "2"}]
    kinds = {d.id: d.kind for d in devices_of(compiled(return_circuit=OWN_RAILS, feeders=feeders))}
    assert kinds["A 1 return"] == kinds["A 2 return"] == kinds["B return"] == "return_feeder"
    assert "A return" not in kinds
    assert "A return" in {d.id for d in devices_of(compiled(return_circuit=OWN_RAILS, feeders=feeders[:1]))}


def test_pieces_with_one_name_are_told_apart():
    rows = [RAILS | {"from_km": a, "to_km": b} for a, b in ((0.0, 5.0000001), (5.0000001, 20.0))]
    ids = [device.id for device in devices_of(compiled(return_circuit=rows))]
    assert len(set(ids)) == len(ids)


class Taken:
    """The currents of all devices of a run by their names, and its rows."""

    def __init__(self, scenario):
        quiet = QuietRun(scenario)
        self.tables = quiet.compiled.supply
        self.currents = DeviceCurrents(self.tables)
        self.amps, self.rows = [], []
        quiet.watches.append(self)
        quiet.execute()
        self.amps = np.concatenate(self.amps)

    def __call__(self, time_s, rows, supply):
        self.amps.append(self.currents(rows, supply))
        ends = np.cumsum(rows.steps["trains"])
        sums = np.concatenate([[0.0], np.cumsum(rows.trains["current_a"])])
        trains_a = sums[ends] - sums[ends - rows.steps["trains"]]
        self.rows.append({"load_a": rows.load_a.copy(), "trains_a": trains_a})
        self.buffers = type(rows)(*(array.copy() for array in rows))

    def of(self, name):
        number = [device.id for device in self.currents.devices].index(name)
        return self.amps[:, self.currents.columns == number]

    def row(self, name):
        return np.concatenate([rows[name] for rows in self.rows])


UNITS = {"no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1, "grid_resistance_ohm": 0.02}


def test_currents_of_units_feeders_and_sections():
    """A unit goes out and comes back, and so does the whole substation; each share is that of the units there are."""
    substations = [{"id": "A", "km": 0.0, "units": 3, **UNITS}, {"id": "B", "km": 20.0, **UNITS}]
    events = [{"device": "A", "time": time, "units_in_service": k} for time, k in ((50.0, 2), (100.0, 0), (150.0, 3))]
    taken = Taken(couple(run("x"), end_s=200.0, substations=substations, switch_events=events))
    units, whole = taken.of("A unit")[:, 0], taken.of("A")[:, 0]
    for part, count in ((slice(0, 50), 3), (slice(50, 100), 2), (slice(100, 150), 1), (slice(150, 200), 3)):
        np.testing.assert_array_equal(units[part], whole[part] / count)
    assert not whole[100:150].any()
    assert whole[:100].min() > 10.0
    assert units[51] == pytest.approx(units[49] * 1.5, rel=0.2)
    np.testing.assert_allclose(sum(taken.of(f"A {track} high_km")[:, 0] for track in "12"), whole, atol=1e-5)  # Kirchhoff
    np.testing.assert_array_equal(taken.of("A return")[:, 0], whole)
    low, high = taken.of("track 1 km 0-10").T
    np.testing.assert_allclose(low, taken.of("A 1 high_km")[:, 0], atol=1e-5)
    np.testing.assert_allclose(high, taken.of("C 1 low_km")[:, 0], atol=1e-5)
    rails = taken.of("rails 1 2 km 0-20")
    np.testing.assert_allclose(rails[:, 0], -whole, atol=1e-5)  # what a substation feeds comes back by the rails


def test_a_common_return_carries_what_the_others_leave():
    whole = {"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.01}
    rails = [whole | {"tracks": [track]} for track in "12"]
    scenario = couple(run("x"), end_s=60.0, return_circuit=rails, feeders=[OWN_RETURN])
    taken = Taken(scenario)
    own, common = taken.of("A 1 return")[:, 0], taken.of("A return")[:, 0]
    np.testing.assert_allclose(own + common, taken.of("A")[:, 0], atol=1e-9)
    np.testing.assert_allclose(common, -taken.of("rails 2 km 0-20")[:, 0], atol=1e-5)
    assert np.abs(own).max() > 100.0


@pytest.mark.parametrize("seed", [1, 4, 6, 7, 9])
def test_what_flows_into_sections_is_what_trains_and_loads_take(seed):
    """Whatever is switched, cut or dead: of all contact lines together, and in each step."""
    taken = Taken(RandomCoupling(seed, 80).scenario)
    into = [k for k, number in enumerate(taken.currents.columns) if taken.currents.devices[number].kind == "contact_line"]
    trains_a = np.concatenate([rows["trains_a"] for rows in taken.rows])
    np.testing.assert_allclose(taken.amps[:, into].sum(axis=1), trains_a + taken.row("load_a").sum(axis=1), atol=1e-3)
    assert np.abs(trains_a).max() > 1.0


def test_a_step_without_a_solution_does_not_spoil_the_sums():
    taken = Taken(couple(run("x"), end_s=5.0))
    buffers, tables = taken.buffers, taken.tables
    buffers.link_a[1], buffers.gauge_a[2, 0] = np.nan, np.inf
    amps = taken.currents(buffers, tables)
    assert np.isfinite(amps).all()
    np.testing.assert_array_equal(amps[[0, 3, 4]], taken.amps[[0, 3, 4]])


def test_sums_of_columns_do_not_depend_on_how_many_rows_there_are():
    values = np.random.default_rng(3).normal(size=(50, 9))
    groups = [[0, 4, 8, 2], [], [1]]
    whole = sums_of_columns(values, groups)
    np.testing.assert_array_equal(whole, np.concatenate([sums_of_columns(values[k : k + 1], groups) for k in range(50)]))
    np.testing.assert_allclose(whole[:, 0], values[:, [0, 4, 8, 2]].sum(axis=1))
    assert not whole[:, 1].any()

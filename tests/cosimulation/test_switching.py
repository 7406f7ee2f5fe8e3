"""Switching while a run lasts: orders, trips, reclosures, voltage-limiting devices, dead stretches."""

import numpy as np
import pytest
from solved import LIMITS, seed_network, tap

from tractionpower.cosimulation import run as run_module
from tractionpower.cosimulation.simulate import simulate
from tractionpower.model.earthing import VoltageLimitingDevice, VoltageTime
from tractionpower.model.scenario import Clock, Scenario
from tractionpower.model.supply import ReturnCircuit
from tractionpower.model.switchgear import Feeder, SwitchEvent
from tractionpower.results.store import MemoryWriter

FAR = "A 1 high_km"


def scenario(loads, start=0.0, end=60.0, step_s=1.0, *, line=None, **changes):
    supply, own_line = seed_network(loads)
    supply = supply.model_copy(update=changes)
    return Scenario(line=line or own_line, supply=supply, clock=Clock(start=start, end=end, step_s=step_s), limits=LIMITS)


def order(time, device, state):
    return SwitchEvent(time=time, device=device, state=state)


def protected(**settings):
    return {"feeders": (Feeder(at="A", track="1", side="high_km", resistance_ohm=0.001, **settings),)}


def events(results, *kinds):
    rows = results.table("events")
    return [(row.kind, row.subject, row.time_s) for row in rows.itertuples() if row.kind in kinds]


def feeder_current(results):
    rows = results.table("feeders")
    own = rows[(rows.substation == "A") & (rows.track == "1") & (rows.side == "high_km")]
    return own.current_a.to_numpy()


LOADS = [tap("t", 4.0, kw=3000.0), tap("u", 14.0, track="2", kw=2000.0)]


@pytest.mark.parametrize(
    ("device", "state", "field"),
    [("C", "open", "section_cabins"), ("B", "bypassed", "substations"), ("B", "open", "substations"), (FAR, "open", "feeders")],
)
def test_switching_by_events_equals_two_studies_joined(device, state, field):
    whole = simulate(scenario(LOADS, switch_events=(order(20.0, device, state),)))
    before = simulate(scenario(LOADS, end=20.0))
    if field == "feeders":
        changes = {"feeders": (Feeder(at="A", track="1", side="high_km", state=state),)}
    else:
        rows = getattr(scenario(LOADS).supply, field)
        changes = {field: tuple(row.model_copy(update={"state": state}) if row.id == device else row for row in rows)}
    after = simulate(scenario(LOADS, start=20.0, **changes))
    for table in ("substations", "feeders", "loads", "cabins"):
        joined = [results.table(table).drop(columns="time_s") for results in (before, after)]
        ours = whole.table(table)
        for column in joined[0].select_dtypes("number"):
            values = np.concatenate([part[column].to_numpy() for part in joined])
            np.testing.assert_allclose(ours[column].to_numpy(), values, rtol=0.0, atol=1e-3, err_msg=f"{table} {column}")
    assert len(whole.table("loads")) == 2 * 60


def test_an_order_takes_effect_in_the_first_step_that_starts_then():
    results = simulate(scenario(LOADS, end=10.0, step_s=2.0, switch_events=(order(5.0, FAR, "open"), order(8.0, FAR, "closed"))))
    assert (np.abs(feeder_current(results)) > 1.0).tolist() == [True, True, True, False, True]


def test_an_order_before_the_clock_is_the_state_at_its_start():
    events_ = (order(10.0, FAR, "open"), order(20.0, "B", "bypassed"), order(30.0, "B", "in_service"))
    results = simulate(scenario(LOADS, start=100.0, end=105.0, switch_events=events_))
    assert np.abs(feeder_current(results)).max() == 0.0
    station = results.table("substations")
    assert (station[station.substation == "B"].current_a > 10.0).all()


def test_a_unit_out_and_back():
    supply, _ = seed_network()
    stations = tuple(s.model_copy(update={"units": 2, "grid_resistance_ohm": 0.04}) for s in supply.substations)
    out = SwitchEvent(time=5.0, device="A", units_in_service=1), SwitchEvent(time=9.0, device="A", units_in_service=2)
    results = simulate(scenario(LOADS, end=12.0, substations=stations, switch_events=out))
    rows = results.table("substations")
    own = rows[rows.substation == "A"]
    ohm = (3600.0 - own.voltage_v) / own.current_a
    expected = [0.12] * 5 + [2.0 * (0.12 - 0.04) + 0.04] * 4 + [0.12] * 3
    np.testing.assert_allclose(ohm, expected, rtol=1e-4)
    np.testing.assert_allclose(own.regulation_kw, ohm * own.current_a**2 / 1000.0, rtol=1e-4)


# -- trips


def heavy(from_s=10.0, to_s=1000.0):
    return tap("h", 3.0, kw=6000.0).model_copy(update={"from_": from_s, "to": to_s})


def open_cabin():
    supply, _ = seed_network()
    return {"section_cabins": tuple(c.model_copy(update={"state": "open"}) for c in supply.section_cabins)}


def test_a_breaker_trips_after_its_delay_recloses_and_stays_open():
    changes = protected(trip_current_a=1000.0, trip_delay_s=3.0, reclose_after_s=5.0, reclosures=1) | open_cabin()
    results = simulate(scenario([heavy()], **changes))
    assert events(results, "tripped", "switched") == [("tripped", FAR, 13.0), ("switched", FAR, 18.0), ("tripped", FAR, 21.0)]
    on = np.abs(feeder_current(results)) > 1.0
    assert np.flatnonzero(on).tolist() == [10, 11, 12, 18, 19, 20]
    assert "stays open" in results.table("events").query("kind == 'tripped'").message.iloc[-1]


def test_a_current_that_falls_back_in_time_does_not_trip():
    changes = protected(trip_current_a=1000.0, trip_delay_s=3.0) | open_cabin()
    results = simulate(scenario([heavy(10.0, 12.0), heavy(13.0, 15.0).model_copy(update={"id": "i"})], **changes))
    assert events(results, "tripped") == []


def test_reclosures_are_counted_anew_after_the_reclaim_time():
    changes = protected(trip_current_a=1000.0, reclose_after_s=5.0, reclosures=1, reclaim_s=10.0) | open_cabin()
    loads = [heavy(10.0, 11.0), heavy(40.0, 41.0).model_copy(update={"id": "i"})]
    results = simulate(scenario(loads, **changes))
    kinds = [kind for kind, *_ in events(results, "tripped", "switched")]
    assert kinds == ["tripped", "switched", "tripped", "switched"]


def test_an_order_calls_a_planned_reclosure_off():
    changes = protected(trip_current_a=1000.0, reclose_after_s=20.0) | open_cabin()
    results = simulate(scenario([heavy(10.0, 11.0)], switch_events=(order(15.0, FAR, "open"),), **changes))
    assert events(results, "tripped", "switched") == [("tripped", FAR, 11.0), ("switched", FAR, 15.0)]
    assert np.abs(feeder_current(results))[11:].max() == 0.0


def test_the_settings_of_a_station_are_those_of_its_feeders():
    supply, _ = seed_network(feeder_resistance_ohm=0.001)
    stations = tuple(s.model_copy(update={"trip_current_a": 1000.0}) for s in supply.substations)
    results = simulate(scenario([heavy()], substations=stations, **open_cabin()))
    assert events(results, "tripped") == [("tripped", FAR, 11.0)]


# -- dead stretches


def test_dead_stretches_are_told_with_place_and_time():
    changes = open_cabin() | {"switch_events": (order(20.0, FAR, "open"), order(30.0, FAR, "closed"))}
    results = simulate(scenario([tap("t", 4.0, kw=1000.0)], **changes))
    rows = results.table("events")
    dead = rows[rows.kind.isin(["line_dead", "line_live"])]
    assert dead[["kind", "track", "time_s", "position_km"]].values.tolist() == [
        ["line_dead", "1", 20.0, 0.0], ["line_live", "1", 30.0, 0.0],
    ]  # fmt: skip
    assert "km 10" in dead.message.iloc[0]
    volts = results.table("loads").voltage_v.to_numpy()
    assert np.abs(volts[20:30]).max() < 1e-3
    lowest = next(figure for figure in results.key_figures if figure["name"] == "lowest_voltage_v")
    assert lowest["value"] > 3000.0  # a contact line that nothing feeds has no voltage


# -- voltage-limiting devices


def leaky(device):
    rails = tuple(
        ReturnCircuit(tracks=(t,), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.02, leakage_s_per_km=0.1) for t in "12"
    )
    return {"return_circuit": rails, "voltage_limiting_devices": (device,)}


def test_a_device_closes_by_its_characteristic_latches_and_opens():
    points = (VoltageTime(above_v=30.0, after_s=4.0), VoltageTime(above_v=500.0))
    device = VoltageLimitingDevice(id="V", track="1", km=9.0, closes=points, closed_resistance_ohm=0.01, opens_after_s=20.0)
    results = simulate(scenario([tap("t", 9.0, kw=5000.0)], end=40.0, **leaky(device)))
    assert events(results, "vld_closed", "switched") == [
        ("vld_closed", "V", 4.0),
        ("switched", "V", 24.0),
        ("vld_closed", "V", 28.0),
    ]


def test_blocks_may_end_anywhere(monkeypatch):
    """Trips, reclosures and devices: the rows do not depend on where the blocks end."""
    device = VoltageLimitingDevice(id="V", track="1", km=9.0, closes=(VoltageTime(above_v=20.0, after_s=3.0),), opens_after_s=7.0)
    changes = protected(trip_current_a=1200.0, trip_delay_s=2.0, reclose_after_s=5.0, reclosures=3) | leaky(device)
    study = scenario([heavy(), tap("t", 9.0, kw=5000.0)], **changes)
    tables = []
    monkeypatch.setattr(run_module, "BLOCK_S", 0.0)
    for longest in (1, 7, 1000):
        monkeypatch.setattr(run_module, "FIRST_BLOCK", longest)
        writer = MemoryWriter()
        run_module.Run(study, writer).execute()
        tables.append(writer.tables())
    for other in tables[1:]:
        assert {name: table.to_pydict() for name, table in other.items()} == {
            name: table.to_pydict() for name, table in tables[0].items()
        }
    kinds = set(tables[0]["events"].to_pandas().kind)
    assert {"tripped", "vld_closed", "switched"} <= kinds

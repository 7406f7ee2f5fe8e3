"""What is watched: which breakers trip, and what a trigger looks at."""

import numpy as np
import pytest
from nodes import line, rails_of_each, station, supply
from solved import LIMITS

from tractionpower.kernels.block_tables import OVERCURRENT, RAIL_POTENTIAL
from tractionpower.model.earthing import VoltageLimitingDevice
from tractionpower.model.supply import SectionCabin
from tractionpower.model.switchgear import Feeder, Switch
from tractionpower.supply.compile import compile_network
from tractionpower.supply.protection import Trigger, find_triggers, protections
from tractionpower.supply.wiring import build_topology

TRIP = {"trip_current_a": 4000.0, "trip_delay_s": 0.5, "reclose_after_s": 10.0}
OWN = {"trip_current_a": 2500.0}


def device(name="V", km=10.0, **more):
    closes = ({"above_v": 120.0}, {"above_v": 60.0, "after_s": 10.0})
    return VoltageLimitingDevice.model_validate({"id": name, "track": "1", "km": km, "closes": closes} | more)


def found(declared):
    return find_triggers(declared, build_topology(declared, line()).links)


def test_nothing_is_watched_without_settings():
    assert found(supply(substations=(station(),), section_cabins=(SectionCabin(id="C", km=4.0),))) == ()


def test_every_feeder_of_a_station_trips_by_its_settings():
    declared = supply(substations=(station(**TRIP),), section_cabins=(SectionCabin(id="C", km=4.0, **OWN),))
    triggers = found(declared)
    links = build_topology(declared, line()).links
    assert [links[trigger.number].id for trigger in triggers] == [trigger.device for trigger in triggers]
    assert [(t.device, t.above, t.delay_s) for t in triggers] == [
        (f"S {track} {side}", 4000.0, 0.5) for track in "12" for side in ("low_km", "high_km")
    ] + [(f"C {track} {side}", 2500.0, 0.0) for track in "12" for side in ("low_km", "high_km")]


def test_a_row_has_settings_of_its_own_or_those_of_its_station():
    rows = (
        Feeder(at="S", track="1", side="low_km", **OWN), Feeder(at="S", track="1", side="high_km"),
        Feeder(at="S", track="2", side="return"),
    )  # fmt: skip
    declared = supply(substations=(station(**TRIP),), feeders=rows)
    settings = protections(declared, build_topology(declared, line()).links)
    assert {name: item.trip_current_a for name, item in settings.items()} == {
        "S 1 low_km": 2500.0, "S 1 high_km": 4000.0, "S 2 low_km": 4000.0, "S 2 high_km": 4000.0,
    }  # fmt: skip
    assert settings["S 1 low_km"].reclose_after_s is None  # all of the row's, not some of each
    assert settings["S 1 high_km"].reclose_after_s == 10.0


def test_switches_and_return_feeders_have_no_trip():
    switches = (Switch.model_validate({"id": "Q", "from": {"busbar": "S"}, "to": {"track": "1", "km": 3.0}}),)
    rows = (Feeder(at="S", track="1", side="return"),)
    declared = supply(substations=(station(),), feeders=rows, switches=switches)
    assert found(declared) == ()


def test_devices_come_last_by_identifier_with_each_point():
    declared = supply(substations=(station(tracks=("1",), **TRIP),), voltage_limiting_devices=(device("W"), device("V", 3.0)))
    assert found(declared)[2:] == tuple(
        Trigger("rail_potential", name, -1, above, after) for name in "VW" for above, after in ((120.0, 0.0), (60.0, 10.0))
    )


def test_the_table_knows_links_and_rail_places():
    devices = (device("V", 3.0), device("W", 14.0, track="2"))
    declared = supply(substations=(station(**TRIP),), return_circuit=rails_of_each(leakage=0.1), voltage_limiting_devices=devices)
    tables = compile_network(declared, line(), LIMITS)
    assert tables.triggers["kind"].tolist() == [OVERCURRENT] * 4 + [RAIL_POTENTIAL] * 4
    assert [tables.links[k].id for k in tables.triggers["index"][:4]] == [trigger.device for trigger in tables.watched[:4]]
    places = [(tables.rail_places[k].tracks, tables.rail_places[k].km) for k in tables.triggers["index"][4:]]
    assert places == [("1", 3.0), ("1", 3.0), ("2", 14.0), ("2", 14.0)]
    assert tables.triggers["above"].tolist() == [4000.0] * 4 + [120.0, 60.0] * 2
    assert tables.triggers["delay_s"].tolist() == [0.5] * 4 + [0.0, 10.0] * 2


@pytest.mark.parametrize("state", ["in_service", "bypassed"])
def test_what_has_done_its_work_watches_nothing(state):
    rows = (Feeder(at="S", track="1", side="low_km", state="open"),)
    declared = supply(
        substations=(station(state=state, **TRIP),),
        feeders=rows,
        voltage_limiting_devices=(device("V", state="closed"), device("W", 3.0)),
    )
    tables = compile_network(declared, line(), LIMITS)
    resting = np.isinf(tables.triggers["above"]).tolist()
    assert resting == [True] + [state == "bypassed"] * 3 + [True, True, False, False]
    normal = supply(substations=(station(**TRIP),), voltage_limiting_devices=(device("V"), device("W", 3.0)))
    assert tables.watched == compile_network(normal, line(), LIMITS).watched  # the same list in every state

"""Ratings of devices: which value wins, over which windows it holds, and what is said where there is none."""

import math

import pytest
from small_studies import make_scenario, station

from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.model.conductors import Conductor
from tractionpower.model.limits import Limit, overlay
from tractionpower.model.ratings import DutyRow
from tractionpower.model.scenario import Scenario
from tractionpower.supply.devices import Device
from tractionpower.supply.ratings import ratings_of

WHOLE = {"from_km": 0.0, "to_km": 20.0}
TABLES = {"conductors": shipped_conductors(), "duty_classes": DUTY_CLASSES.shipped, "rectifier_units": RECTIFIER_UNITS.shipped}
UNIT = Device("unit", "A unit", "A", "", 0.0, 0.0)
PLANT = Device("substation", "A", "A", "", 0.0, 0.0)
FEEDER = Device("feeder", "A 1 low_km", "A", "1", 0.0, 0.0)
CABIN = Device("cabin_feeder", "C 1 low_km", "C", "1", 10.0, 10.0)
RETURN = Device("return_feeder", "A 1 return", "A", "1", 0.0, 0.0)
COMMON = Device("return_feeder", "A return", "A", "", 0.0, 0.0)
SECTION = Device("contact_line", "track 1 km 10-20", "", "1", 10.0, 20.0)
RAILS = Device("rails", "rails 1 2 km 0-20", "", "1 2", 0.0, 20.0)
SWITCH = Device("switch", "tie", "", "1", 5.0, 5.0)


def scenario(limits=None, tables=TABLES, **supply):
    made = make_scenario(**supply)
    parts = {name: getattr(made, name) for name in Scenario.model_fields} | tables
    return Scenario(**parts | ({"limits": limits} if limits else {}))


def rating(device, **supply):
    (found,) = ratings_of(scenario(**supply), [device])
    assert found.device_id == device.id
    return found


def of_unit(device=UNIT, **more):
    return rating(device, substations=[station("A", 0.0, **more), station("B", 20.0)])


def test_a_unit_has_current_and_class_of_its_type():
    found = of_unit(unit="ADIF-3000", units=2)
    assert (found.rated_a, found.duty_class, found.status) == (909.0, "IX", "secondary")
    assert found.windows == ((0.0, 1.0), (300.0, 3.0), (7200.0, 1.5))
    assert "Adif" in found.source


def test_own_current_and_class_win_and_the_least_sure_value_gives_the_status():
    found = of_unit(unit="ADIF-3000", rated_current_a=1000.0, duty_class="V")
    assert (found.rated_a, found.duty_class, found.status) == (1000.0, "V", "recalled")
    assert found.source == (
        "rated_current_a of substation A; class V: IEC 60146-1-1 as recalled; the text of the standard is not at hand"
    )


def test_a_substation_bears_what_its_units_in_service_do():
    assert of_unit(PLANT, unit="PD-17", units=3).rated_a == 3 * 1700.0
    assert of_unit(PLANT, unit="PD-17", units=3, units_in_service=1).rated_a == 1700.0
    assert math.isnan(of_unit(PLANT, unit="PD-17", units=3, units_in_service=0).rated_a)


def test_without_a_class_no_overload_is_borne():
    found = of_unit(rated_current_a=1000.0)
    assert (found.rated_a, found.duty_class) == (1000.0, "")
    assert found.windows == ((0.0, 1.0), (60.0, 1.0))
    assert found.status == "derived"  # the user has given the current, not that it is a limit for a minute


def test_own_cycles_stand_in_for_a_class():
    own = [DutyRow(duty_class="mine", window_s=window, multiple=m) for window, m in ((0.0, 0.9), (1800.0, 1.2))]
    tables = TABLES | {"duty_classes": own}
    (found,) = ratings_of(
        scenario(tables=tables, substations=[station("A", 0.0, rated_current_a=1500.0, duty_class="mine")]), [UNIT]
    )
    assert found.windows == ((0.0, 0.9), (1800.0, 1.2))
    assert found.status == "user"


def feeder_row(side="low_km", **more):
    return {"at": "A", "track": "1", "side": side, "cable": "XLPE-Cu-240", "length_m": 300.0} | more


@pytest.mark.parametrize(
    ("device", "side", "expected"), [(FEEDER, "low_km", 555.0), (RETURN, "return", 555.0)], ids=["feeder", "return feeder"]
)
def test_a_feeder_bears_what_its_cables_do(device, side, expected):
    assert rating(device, feeders=[feeder_row(side)]).rated_a == expected
    assert rating(device, feeders=[feeder_row(side, cables=3)]).rated_a == 3 * expected
    own = rating(device, feeders=[feeder_row(side, cables=3, rated_current_a=700.0)])
    assert (own.rated_a, own.status) == (700.0, "user")
    assert own.windows == ((3600.0, 1.0),)
    assert own.duty_class == "60 min"


def test_a_feeder_without_own_value_bears_what_its_station_says():
    stations = [station("A", 0.0, feeder_rated_current_a=900.0, return_rated_current_a=1800.0)]
    cabins = [{"id": "C", "km": 10.0, "feeder_rated_current_a": 600.0}]
    given = {"substations": stations, "section_cabins": cabins}
    assert [rating(d, **given).rated_a for d in (FEEDER, CABIN, COMMON, RETURN)] == [900.0, 600.0, 1800.0, 1800.0]
    unrated = rating(FEEDER, **given, feeders=[feeder_row(cable="YAKY-500")])
    assert unrated.rated_a == 900.0  # no rating of that cable is at hand
    assert rating(FEEDER, **given, feeders=[feeder_row()]).rated_a == 555.0


def test_a_feeder_without_any_value_says_so():
    found = rating(FEEDER, feeders=[feeder_row(cable="YAKY-500")])
    assert math.isnan(found.rated_a)
    assert (found.windows, found.status) == ((), "")
    assert found.source == "no rating given; the conductors table has none for cable YAKY-500"
    assert rating(SWITCH).source == "no rating given"


def test_the_setting_is_that_of_the_breaker():
    stations = [station("A", 0.0, trip_current_a=2500.0)]
    assert rating(FEEDER, substations=stations).setting_a == 2500.0
    assert rating(FEEDER, substations=stations, feeders=[feeder_row(trip_current_a=1200.0)]).setting_a == 1200.0
    assert math.isnan(rating(CABIN, substations=stations).setting_a)
    assert math.isnan(rating(COMMON, substations=stations).setting_a)


def test_a_contact_line_bears_what_its_wires_do_unless_its_row_says_more():
    rows = [
        {"tracks": ["1", "2"], "from_km": 0.0, "to_km": 10.0, "type": "C120-2C", "rated_current_a": 1700.0},
        {"tracks": ["1", "2"], "from_km": 10.0, "to_km": 20.0, "type": "C120-2C"},
    ]
    found = rating(SECTION, contact_lines=rows)
    assert found.status == "derived"
    assert found.rated_a == pytest.approx(1150.4, abs=0.1)
    assert "L120 at its highest temperature; air 40 °C, wind 0.6 m/s" in found.source
    assert found.windows == ((480.0, 1.0),)
    west = Device("contact_line", "track 1 km 0-10", "", "1", 0.0, 10.0)
    assert (rating(west, contact_lines=rows).rated_a, rating(west, contact_lines=rows).status) == (1700.0, "user")


def test_a_contact_line_whose_wires_nobody_knows_has_none():
    assert rating(SECTION).source == "no rating given; its wires are not known"


def test_rows_of_other_tracks_are_not_taken():
    rows = [WHOLE | {"tracks": ["2"], "type": "C150-2C150"}, WHOLE | {"tracks": ["1"], "type": "C95-C"}]
    assert rating(SECTION, contact_lines=rows).rated_a == pytest.approx(761.2, abs=0.1)


def test_rails_bear_their_row_or_their_rail_for_each_track():
    rail = Conductor(kind="rail", name="mine", resistance_ohm_per_km=0.01, rated_current_a=800.0, status="recalled", source="s")
    tables = TABLES | {"conductors": (*shipped_conductors(), rail)}
    whole = [WHOLE | {"rail": "mine"}]
    (found,) = ratings_of(scenario(tables=tables, return_circuit=whole), [RAILS])
    assert (found.rated_a, found.status, found.source) == (1600.0, "recalled", "2 x 800 A, rail mine: s")
    own = [WHOLE | {"rail": "mine", "rated_current_a": 1000.0}]
    assert ratings_of(scenario(tables=tables, return_circuit=own), [RAILS])[0].rated_a == 1000.0
    assert rating(RAILS, return_circuit=[WHOLE | {"rail": "60E1"}]).source == "no rating given"


def test_windows_of_conductors_come_from_the_limits_table():
    limits = overlay(shipped_limits(), [Limit(system="dc3000", name="window_cable_s", value=1200.0)])
    stations = [station("A", 0.0, feeder_rated_current_a=900.0)]
    (found,) = ratings_of(scenario(limits=limits, substations=stations), [FEEDER])
    assert (found.windows, found.duty_class) == (((1200.0, 1.0),), "20 min")


def test_a_missing_window_leaves_conductors_without_rating():
    limits = tuple(limit for limit in shipped_limits() if limit.name != "window_cable_s")
    found = ratings_of(scenario(limits=limits, substations=[station("A", 0.0, feeder_rated_current_a=900.0)]), [FEEDER])[0]
    assert math.isnan(found.rated_a)
    assert found.source == "no rating: the limits table lacks window_cable_s"


# --- the tables that ship


def test_every_unit_has_a_class_and_every_class_a_value_for_the_whole_run():
    classes = {row.duty_class for row in DUTY_CLASSES.shipped}
    assert {unit.duty_class for unit in RECTIFIER_UNITS.shipped} <= classes
    for name in classes:
        own = sorted((row for row in DUTY_CLASSES.shipped if row.duty_class == name), key=lambda row: row.window_s or math.inf)
        multiples = [row.multiple for row in own]
        assert own[-1].window_s == 0.0
        assert multiples == sorted(multiples, reverse=True), name  # a shorter window never permits less
        assert all(row.source and row.meaning and row.status in ("secondary", "recalled") for row in own)


def test_rated_power_and_current_of_units_agree_with_their_transformers():
    for unit in RECTIFIER_UNITS.shipped:
        power_mw = unit.rated_current_a * unit.rated_voltage_v / 1e6
        assert 0.55 < power_mw / unit.transformer_mva < 1.0, unit.unit

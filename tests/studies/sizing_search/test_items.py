"""What may be varied, and what the changes of a design come to."""

import pytest
from small_studies import STATION, load, make_scenario, station

from tractionpower.model.change import apply_changes
from tractionpower.studies.sizing_search.items import changes_of, cost_of, items_of
from tractionpower.supply.characteristics import dissipative_resistance, internal_resistance, no_load_voltage

SEARCH = {"fewest_units": 1, "most_units": 4, "most_cables": 4, "unit_points": 10.0, "cable_points": 0.5}
FEEDER = {"at": "A", "track": "1", "side": "high_km", "cable": "YAKY-500", "length_m": 100.0, "cables": 2}


def plants():
    by_unit = {key: value for key, value in STATION.items() if key != "internal_resistance_ohm"}
    return [
        {
            "id": "A",
            "km": 0.0,
            **by_unit,
            "unit_resistance_ohm": 0.2,
            "grid_resistance_ohm": 0.02,
            "units": 2,
            "dissipative_resistance_ohm": 0.02,
        },
        station("B", 20.0, units=2, grid_resistance_ohm=0.02, dissipative_resistance_ohm=0.01),
        station("M", 12.0, state="bypassed"),
    ]


def study(**more):
    scenario = make_scenario(load("x"), substations=plants(), **more)
    sizing = scenario.sizing.model_copy(update={"search": scenario.sizing.search.model_copy(update=SEARCH)})
    return scenario.model_copy(update={"sizing": sizing})


def plant(scenario, name):
    return next(s for s in scenario.supply.substations if s.id == name)


def test_only_plants_that_feed_may_have_other_units():
    assert set(items_of(study())) == {"units of A", "units of B"}


@pytest.mark.parametrize("units", [1, 2, 3, 4])
@pytest.mark.parametrize("name", ["A", "B"])
def test_other_units_share_what_is_not_of_the_grid_and_keep_the_no_load_voltage(name, units):
    scenario = study()
    items = items_of(scenario)
    item = items[f"units of {name}"]
    changed = plant(apply_changes(scenario, changes_of(items, {item.name: units - 1})), name)
    one = 0.2 if name == "A" else (0.12 - 0.02) * 2
    assert changed.units == units
    assert internal_resistance(changed) == pytest.approx(one / units + 0.02, rel=1e-12)
    assert no_load_voltage(changed) == 3600.0
    assert dissipative_resistance(changed) == pytest.approx(0.02 / units, rel=1e-12)


def test_what_is_declared_is_no_change_and_costs_what_it_is():
    scenario = study()
    items = items_of(scenario)
    assert changes_of(items, {}) == ()
    assert changes_of(items, {"units of A": 1}) == ()
    assert cost_of(items, {}) == 40.0
    assert cost_of(items, {"units of A": 2}) == 50.0


def test_more_than_the_bounds_is_kept_as_a_possibility():
    scenario = study()
    supply = scenario.supply.model_copy(
        update={
            "substations": tuple(s.model_copy(update={"units": 6}) if s.id == "A" else s for s in scenario.supply.substations)
        }
    )
    item = items_of(scenario.model_copy(update={"supply": supply}))["units of A"]
    assert [rung.words for rung in item.rungs][-2:] == ["4 rectifier units", "6 rectifier units"]
    assert item.declared == len(item.rungs) - 1


def test_cables_and_contact_lines_vary_where_the_bounds_say():
    whole = {"from_km": 0.0, "to_km": 20.0}
    scenario = study(feeders=[FEEDER], contact_lines=[whole | {"type": "C95-2C"}])
    search = scenario.sizing.search.model_copy(update={"contact_lines": ("C120-2C", "2C120-2C")})
    scenario = scenario.model_copy(update={"sizing": scenario.sizing.model_copy(update={"search": search})})
    items = items_of(scenario)
    assert [rung.changes for rung in items["cables of A 1 high_km"].rungs][1:] == [
        ("supply.feeders[0].cables=3",),
        ("supply.feeders[0].cables=4",),
    ]
    line = items["contact line 0 of tracks 1 2"]
    assert [rung.words for rung in line.rungs] == ["C95-2C", "C120-2C", "2C120-2C"]
    assert [rung.cost for rung in line.rungs] == [0.0, 40.0, 80.0]
    assert line.tracks == ("1", "2")

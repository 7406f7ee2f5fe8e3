"""A supply with some of its devices in other states."""

import pytest
from nodes import line, station, supply
from solved import LIMITS

from tractionpower.model.earthing import VoltageLimitingDevice
from tractionpower.model.supply import SectionCabin, SectionPoint, Supply
from tractionpower.model.switchgear import Feeder, Switch, SwitchEvent
from tractionpower.supply.compile import compile_network
from tractionpower.supply.states import SWITCHED, change_of, find_list, with_states


def whole():
    """Return a supply with a device of each kind."""
    return supply(
        substations=(station("S 0", 0.0, units=3), station()),
        section_cabins=(SectionCabin(id="C", km=4.0),),
        section_points=(SectionPoint(id="P", track="1", km=7.0),),
        switches=(Switch.model_validate({"id": "Q", "from": {"busbar": "S"}, "to": {"track": "1", "km": 3.0}}),),
        voltage_limiting_devices=(
            VoltageLimitingDevice.model_validate({"id": "V", "track": "1", "km": 9.0, "closes": [{"above_v": 60.0}]}),
        ),
        feeders=(Feeder(at="S", track="2", side="low_km", resistance_ohm=0.3), Feeder(at="S", track="1", side="return")),
    )


@pytest.mark.parametrize(
    ("name", "expected"),
    [("S", "substations"), ("S 0", "substations"), ("C", "section_cabins"), ("P", "section_points"), ("Q", "switches"),
     ("V", "voltage_limiting_devices"), ("S 2 low_km", "feeders"), ("S 1 high_km", "feeders"), ("C 2 high_km", "feeders"),
     ("S 0 1 high_km", "feeders"), ("S 1 return", "feeders"), ("S 2 return", None), ("X", None), ("X 1 low_km", None),
     ("S 1", None), ("S 1 up", None), ("1 low_km", None), ("S  low_km", None), ("", None)],
)  # fmt: skip
def test_where_a_device_is(name, expected):
    assert find_list(whole(), name) == expected


def test_lists_and_states_are_those_of_the_model():
    for name, states in SWITCHED.items():
        item = getattr(whole(), name)[0]
        for state in states:
            fields = item.model_dump(by_alias=True) | {"state": state}
            assert type(item).model_validate(fields).state == state
        with pytest.raises(ValueError, match="state"):
            type(item).model_validate(item.model_dump(by_alias=True) | {"state": "ajar"})


def test_what_an_event_changes():
    assert change_of(SwitchEvent(time=1.0, device="Q", state="open")) == ("state", "open")
    assert change_of(SwitchEvent(time=1.0, device="S", units_in_service=0)) == ("units_in_service", 0)


def test_states_change_and_all_else_stays():
    before = whole()
    changes = {"S": [("state", "open")], "C": [("state", "bypassed")], "P": [("state", "closed")], "Q": [("state", "open")],
               "V": [("state", "closed")], "S 0": [("units_in_service", 2), ("state", "rectifiers_out")]}  # fmt: skip
    after = with_states(before, changes)
    assert before == whole()
    states = {item.id: item.state for name in SWITCHED for item in getattr(after, name)}
    assert states == {"S 0": "rectifiers_out", "S": "open", "C": "bypassed", "P": "closed", "Q": "open", "V": "closed",
                      "S 2 low_km": "closed", "S 1 return": "closed"}  # fmt: skip
    assert after.substations[0].units_in_service == 2
    back = {"S": [("state", "in_service")], "C": [("state", "closed")], "P": [("state", "open")], "Q": [("state", "closed")],
            "V": [("state", "open")], "S 0": [("units_in_service", None), ("state", "in_service")]}  # fmt: skip
    assert with_states(after, back) == before


def test_no_change_is_no_change():
    assert with_states(whole(), {}) == whole()


def test_a_feeder_with_a_row_keeps_what_the_row_says():
    after = with_states(whole(), {"S 2 low_km": [("state", "open")]})
    assert [(row.id, row.state, row.resistance_ohm) for row in after.feeders] == [
        ("S 2 low_km", "open", 0.3), ("S 1 return", "closed", None),
    ]  # fmt: skip


def test_a_feeder_without_a_row_gets_one_that_changes_only_its_state():
    before = whole()
    after = with_states(before, {"S 1 high_km": [("state", "open")], "C 1 low_km": [("state", "open")]})
    assert [row.id for row in after.feeders] == ["S 2 low_km", "S 1 return", "C 1 low_km", "S 1 high_km"]
    links = [{link.id: link for link in compile_network(each, line(), LIMITS).links} for each in (before, after)]
    assert {name for name, link in links[0].items() if link.closed != links[1][name].closed} == {"S 1 high_km", "C 1 low_km"}
    assert all(link.ohm == links[1][name].ohm for name, link in links[0].items())
    closed = with_states(after, {"S 1 high_km": [("state", "closed")], "C 1 low_km": [("state", "closed")]})
    tables = [compile_network(each, line(), LIMITS) for each in (before, closed)]
    assert tables[0].network.base.tolist() == tables[1].network.base.tolist()
    assert tables[0].links == tables[1].links


def test_a_device_that_is_not_there():
    with pytest.raises(LookupError, match="X"):
        with_states(whole(), {"X": [("state", "open")]})


def test_the_result_is_a_supply_that_could_have_been_declared():
    after = with_states(whole(), {"S": [("state", "open")], "S 1 high_km": [("state", "open")]})
    assert Supply.model_validate(after.model_dump(by_alias=True)) == after

"""Which inputs differ: told as the changes that lead from the one scenario to the other."""

import pytest
from small_studies import load, make_scenario, station

from tractionpower.io.library import change
from tractionpower.io.scenario_files import load as load_study
from tractionpower.studies.compare.inputs import input_differences

BASE = make_scenario(load("tap"), load("depot", 14.0, "2"), name="base")
A = "supply.substations[A]"


@pytest.mark.parametrize(
    "changes",
    [
        [f"{A}.internal_resistance_ohm=0.2"],
        [f"{A}.state=bypassed", "supply.section_cabins[C].state=open", "clock.end=00:00:20"],
        ["supply.contact_lines[0].resistance_ohm_per_km=0.07", "coupling=constant_voltage"],
        ["supply.substations[*].grid_voltage_pu=0.95"],
        ["supply.loads[tap].power_kw=null", "supply.loads[tap].current_a=300.0", "name=another, with a comma"],
        ['supply.feeders[+]={"at": "A", "track": "1", "side": "high_km", "state": "open"}'],
    ],
)
def test_the_differences_are_changes_that_make_them(changes):
    other = change(BASE, changes)
    found = input_differences(BASE, other)
    assert change(BASE, [f"{item.path}={item.value}" for item in found]).input_hash == other.input_hash
    assert len(found) == len(changes)


def test_nothing_differs_from_itself():
    assert input_differences(BASE, change(BASE, ["name=base"])) == []


def test_they_are_told_as_people_write_them():
    other = change(BASE, [f"{A}.units=3", f"{A}.unit_resistance_ohm=0.3", f"{A}.internal_resistance_ohm=null"])
    told = [str(item) for item in input_differences(BASE, other)]
    assert f"{A}.internal_resistance_ohm: 0.12 -> null" in told
    assert f"{A}.units: 1 -> 3" in told


def test_what_all_items_have_alike_is_told_once_and_else_one_by_one():
    low = change(BASE, ["supply.substations[*].grid_voltage_pu=0.95"])
    assert [item.path for item in input_differences(BASE, low)] == ["supply.substations[*].grid_voltage_pu"]
    mixed = change(BASE, [f"{A}.grid_voltage_pu=0.95", "supply.substations[B].grid_voltage_pu=0.9"])
    assert [item.path for item in input_differences(BASE, mixed)] == [
        f"{A}.grid_voltage_pu",
        "supply.substations[B].grid_voltage_pu",
    ]


def test_devices_that_are_added_or_gone():
    more = make_scenario(load("tap"), name="base", substations=[station("A", 0.0), station("M", 5.0), station("B", 20.0)])
    found = {item.path: item for item in input_differences(BASE, more)}
    assert set(found) == {"supply.substations[M]", "supply.loads[depot]"}
    assert found["supply.substations[M]"].base == ""
    assert '"km": 5.0' in found["supply.substations[M]"].value
    assert found["supply.loads[depot]"].value == ""
    assert "not there" in str(found["supply.loads[depot]"])


def test_rows_without_identifier_are_matched_where_they_are_equal():
    rows = [{"from_km": float(k), "to_km": k + 1.0, "resistance_ohm_per_km": 0.01 * (k + 1)} for k in range(20)]
    base = make_scenario(contact_lines=rows)
    cut = make_scenario(contact_lines=[*rows[:3], rows[3] | {"to_km": 3.5}, rows[3] | {"from_km": 3.5}, *rows[4:]])
    found = [item.path for item in input_differences(base, cut)]
    assert found == ["supply.contact_lines[3].to_km", "supply.contact_lines[+]"]


def test_a_list_with_many_differences_is_told_as_a_whole():
    base = load_study("cmk")
    other = change(base, ["line.gradients[0].permille=0.123"])
    assert [item.path for item in input_differences(base, other)] == ["line.gradients[0].permille"]
    rows = [{"from_km": k * 0.2, "to_km": k * 0.2 + 0.2, "resistance_ohm_per_km": 0.05} for k in range(100)]
    first = make_scenario(contact_lines=rows)
    second = make_scenario(contact_lines=[row | {"resistance_ohm_per_km": 0.06} for row in rows])
    (item,) = input_differences(first, second)
    assert item.path == "supply.contact_lines"
    assert "100 differences" in item.value

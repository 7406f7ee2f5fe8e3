"""Checks of conductors: each fault gives one problem with its code, its place and what a person needs to mend it."""

import pytest

from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.model.conductors import Conductor
from tractionpower.model.supply import Supply
from tractionpower.supply.conductor_checks import check_conductors

TABLE = shipped_conductors()
WHOLE = {"from_km": 0.0, "to_km": 20.0}
FEEDER = {"at": "A", "track": "1", "side": "low_km"}
OWN = Conductor(kind="contact_line", name="own", wires="messenger 1 L120 + contact 2 Zn9", resistance_ohm_per_km=0.1)


def problems(contact=None, rail=None, feeder=None, table=TABLE):
    supply = Supply.model_validate(
        {
            "contact_lines": [WHOLE | (contact or {"resistance_ohm_per_km": 0.05})],
            "return_circuit": [WHOLE | (rail or {"resistance_ohm_per_km": 0.01})],
            "feeders": [FEEDER | feeder] if feeder else [],
        }
    )
    return check_conductors(supply, table)


@pytest.mark.parametrize(
    "parts",
    [
        {},
        {"contact": {"type": "C120-2C", "wear_percent": 10.0, "temperature_c": 40.0}},
        {"contact": {"type": "KB70-C"}},
        {"contact": {"type": "KB70-C", "temperature_c": 20.0}},
        {"contact": {"type": "CA-220"}},
        {"contact": {"wires": [{"conductor": "Cu100", "use": "contact"}], "temperature_c": 40.0}},
        {"rail": {"rail": "60E1", "wear_percent": 5.0, "temperature_c": 0.0}},
        {"feeder": {"cable": "YAKY-500", "cables": 2, "length_m": 350.0}},
        {"feeder": {"resistance_ohm": 0.02}},
    ],
)
def test_sound_conductors_have_none(parts):
    assert problems(**parts) == []


@pytest.mark.parametrize(
    ("parts", "path", "found", "near"),
    [
        (
            {"contact": {"type": "C120-2c1500"}},
            "supply.contact_lines[0].type",
            "no type of contact line 'C120-2c1500'",
            "C120-2C150",
        ),
        (
            {"contact": {"wires": [{"conductor": "Cu100", "use": "contact"}, {"conductor": "CuAg15", "use": "contact"}]}},
            "supply.contact_lines[0].wires[1].conductor",
            "no wire 'CuAg15'",
            "CuAg150",
        ),
        ({"rail": {"rail": "60E"}}, "supply.return_circuit[0].rail", "no rail '60E'", "60E1"),
        ({"feeder": {"cable": "YAKY500", "length_m": 9.0}}, "supply.feeders[0].cable", "no cable 'YAKY500'", "YAKY-500"),
    ],
)
def test_an_unknown_name_is_told_with_the_nearest(parts, path, found, near):
    (problem,) = problems(**parts)
    assert (problem.code, problem.path, problem.severity) == ("unknown_conductor", path, "error")
    assert found in problem.found
    assert near in problem.allowed
    assert "`conductors:`" in problem.remedy


def test_a_name_like_none_has_examples_of_its_kind():
    (problem,) = problems({"type": "?"})
    assert problem.allowed == "for example 2C120-2C, 2C120-2C-1, 2C120-2C-2"
    assert "did you mean" not in problem.remedy


def test_a_name_of_another_kind_is_said_to_be_that():
    (problem,) = problems({"type": "L120"})
    assert problem.remedy.startswith("L120 is a wire; ")


def test_a_shipped_name_that_the_scenario_lacks_is_said_to_ship():
    (problem,) = problems({"type": "C120-2C"}, table=())
    assert (problem.code, problem.remedy) == (
        "unknown_conductor",
        "it ships with the program: put its row into Scenario.conductors",
    )


def test_a_wire_of_a_type_that_the_table_lacks():
    (problem,) = problems({"type": "own"}, table=(*TABLE, OWN))
    assert (problem.code, problem.path) == ("unknown_conductor", "supply.contact_lines[0].type")
    assert "no wire 'Zn9' of own" in problem.found


def test_wear_and_temperature_need_wires():
    found = problems({"type": "KB70-C", "wear_percent": 10.0, "temperature_c": 40.0})
    assert [(problem.code, problem.path) for problem in found] == [
        ("no_wires", "supply.contact_lines[0].wear_percent"),
        ("no_wires", "supply.contact_lines[0].temperature_c"),
    ]
    warm = next(row for row in TABLE if row.name == "KB70-C").model_copy(update={"per_kelvin": 0.004})
    assert problems({"type": "KB70-C", "temperature_c": 40.0}, table=(warm,)) == []


def test_wear_and_temperature_beside_a_given_resistance_would_be_lost():
    given = {"resistance_ohm_per_km": 0.05, "wear_percent": 10.0, "temperature_c": 40.0}
    found = problems(given, given)
    assert [(problem.code, problem.path) for problem in found] == [
        ("unused_value", f"supply.{name}[0].{field}")
        for name in ("contact_lines", "return_circuit")
        for field in ("wear_percent", "temperature_c")
    ]
    assert "type or wires" in found[0].remedy
    assert "rail" in found[2].remedy


def test_a_printed_resistance_that_its_wires_cannot_have_is_doubtful():
    row = OWN.model_copy(update={"wires": "messenger 1 L120 + contact 2 Cu100", "resistance_ohm_per_km": 0.05})
    (problem,) = problems({"type": "own"}, table=(*TABLE, row))
    assert (problem.code, problem.severity) == ("printed_resistance", "warning")


def test_cables_of_no_type():
    (problem,) = problems(feeder={"resistance_ohm": 0.1, "cables": 3})
    assert (problem.code, problem.path) == ("cables_without_cable", "supply.feeders[0].cables")


def test_all_are_told_at_once():
    found = problems({"type": "?"}, {"rail": "?"}, {"cable": "?", "length_m": 1.0})
    assert [problem.path.split(".")[1][:7] for problem in found] == ["contact", "return_", "feeders"]

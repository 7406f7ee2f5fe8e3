"""The conductors table: what a row may be, and which rows a supply uses."""

import pytest
from pydantic import ValidationError

from tractionpower.model.conductors import Conductor, overlay_conductors, parse_wires, used_conductors
from tractionpower.model.supply import Supply


def wire(name, ohm=0.183):
    return Conductor(kind="wire", name=name, resistance_ohm_per_km=ohm)


def line(name, wires="", ohm=None):
    return Conductor(kind="contact_line", name=name, wires=wires, resistance_ohm_per_km=ohm)


def supply(contact=None, rail=None, **more):
    whole = {"from_km": 0.0, "to_km": 1.0}
    return Supply.model_validate(
        {
            "contact_lines": [whole | (contact or {"resistance_ohm_per_km": 0.05})],
            "return_circuit": [whole | ({"resistance_ohm_per_km": 0.01} if rail is None else {"rail": rail})],
            **more,
        }
    )


def test_wires_are_read_with_their_use_and_count():
    wires = parse_wires("messenger 2 L 120 + contact 12 Cu100")
    assert [(w.use, w.count, w.conductor) for w in wires] == [("messenger", 2, "L 120"), ("contact", 12, "Cu100")]
    assert parse_wires("") == ()


@pytest.mark.parametrize("text", ["L120", "messenger L120", "contact 0 Cu100", "trolley 1 Cu100", "contact 1 Cu100 +", "+"])
def test_wires_that_cannot_be_read_are_refused(text):
    with pytest.raises(ValidationError, match="USE COUNT NAME"):
        line("x", text)


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ({"kind": "wire"}, "has resistance_ohm_per_km"),
        ({"kind": "contact_line"}, "has resistance_ohm_per_km"),
        ({"kind": "cable", "resistance_ohm_per_km": 1.0, "wires": "contact 1 Cu100"}, "only a contact_line has wires"),
    ],
)
def test_a_row_has_a_value(row, told):
    with pytest.raises(ValidationError, match=told):
        Conductor(name="x", **row)


def test_rows_are_replaced_and_added_by_kind_and_name():
    cable = Conductor(kind="cable", name="a", resistance_ohm_per_km=1.0)
    rows = overlay_conductors((wire("b"), wire("a")), (wire("a", 0.2), cable))
    assert [(row.kind, row.name, row.resistance_ohm_per_km) for row in rows] == [
        ("cable", "a", 1.0),
        ("wire", "a", 0.2),
        ("wire", "b", 0.183),
    ]


def test_only_rows_that_the_supply_uses_are_kept():
    table = (
        *(wire(name) for name in ("c", "m", "own", "rest")),
        *(line(name, "messenger 1 m + contact 2 c") for name in ("T", "U")),
        Conductor(kind="rail", name="R", resistance_ohm_per_km=0.01),
        Conductor(kind="cable", name="R", resistance_ohm_per_km=0.06),
    )
    names = [(row.kind, row.name) for row in used_conductors(supply({"type": "T"}, "R"), table)]
    assert names == [("contact_line", "T"), ("rail", "R"), ("wire", "c"), ("wire", "m")]
    own = supply({"wires": [{"conductor": "own", "use": "contact"}]})
    assert [row.name for row in used_conductors(own, table)] == ["own"]
    feeder = {"at": "A", "track": "1", "side": "low_km", "cable": "R", "length_m": 10.0}
    assert [row.kind for row in used_conductors(supply(feeders=[feeder]), table)] == ["cable"]
    assert used_conductors(supply(), table) == ()
    assert used_conductors(supply({"type": "none"}, "R"), table[:4]) == ()

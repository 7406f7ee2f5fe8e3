"""Resistances from types, wires, rails and cables, against tables computed elsewhere and sums by hand."""

import pytest

from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.model.conductors import Conductor, find_conductor, overlay_conductors
from tractionpower.model.supply import ContactLine, ReturnCircuit
from tractionpower.model.switchgear import Cable
from tractionpower.supply.conductors import (
    cable_resistance,
    contact_line_resistance,
    look_up,
    return_resistance,
    wear_as_printed,
    wire_shares,
)

TABLE = shipped_conductors()
TYPES = [row for row in TABLE if row.kind == "contact_line"]

# Computed outside this project from the resistances of single wires, for mean wear of the contact wires of 0, 5, 10, 15
# and 20 %, and the value that Yoo's thesis (Warsaw University of Technology 2024, table 4) prints [ohm/km].
RECONSTRUCTED = {
    "C95-C": ([0.0941, 0.0966, 0.0992, 0.1020, 0.1049], 0.0985),
    "C95-2C": ([0.0622, 0.0643, 0.0667, 0.0692, 0.0719], 0.0662),
    "C120-2C": ([0.0578, 0.0597, 0.0617, 0.0639, 0.0662], 0.0613),
    "2C120-2C": ([0.0423, 0.0433, 0.0443, 0.0454, 0.0466], 0.0440),
    "C120-2C150": ([0.0439, 0.0456, 0.0473, 0.0493, 0.0513], 0.0470),
    "C150-2C150": ([0.0409, 0.0423, 0.0438, 0.0454, 0.0472], 0.0435),
    "YC150-2CS150": ([0.0409, 0.0423, 0.0438, 0.0454, 0.0472], 0.0435),
}


def contact(**more):
    return ContactLine.model_validate({"from_km": 0.0, "to_km": 1.0, **more})


def rails(**more):
    return ReturnCircuit.model_validate({"from_km": 0.0, "to_km": 1.0, **more})


def ohm(table=TABLE, **more):
    return contact_line_resistance(contact(**more), table)


@pytest.mark.parametrize("name", RECONSTRUCTED)
def test_polish_types_from_their_wires(name):
    expected, printed = RECONSTRUCTED[name]
    found = [ohm(type=name, wear_percent=wear) for wear in (0.0, 5.0, 10.0, 15.0, 20.0)]
    assert found == pytest.approx(expected, rel=0.0, abs=0.51e-4)  # the last digit is rounded
    assert ohm(type=name) == printed


@pytest.mark.parametrize("row", [row for row in TYPES if row.wires and row.resistance_ohm_per_km], ids=lambda row: row.name)
def test_printed_values_are_those_of_nine_to_ten_percent_wear(row):
    for wear in (9.0, 10.0):
        assert ohm(type=row.name, wear_percent=wear) == pytest.approx(row.resistance_ohm_per_km, rel=0.01)
    implied = wear_as_printed(row, TABLE)
    assert 8.5 < implied < 9.2
    assert ohm(type=row.name, wear_percent=implied) == pytest.approx(row.resistance_ohm_per_km, rel=1e-12)


@pytest.mark.parametrize("row", TYPES, ids=lambda row: row.name)
def test_every_type_that_ships_has_a_resistance(row):
    assert 0.03 < ohm(type=row.name) < 0.13
    assert row.source
    assert row.status in ("secondary", "recalled")  # nothing was read in a manufacturer's own document


def test_the_worked_example_of_the_page():
    worn = contact(type="C120-2C", wear_percent=15.0, temperature_c=40.0)
    assert contact_line_resistance(worn, TABLE) == pytest.approx(0.06888, abs=5e-6)
    shares = {share.conductor: share for share in wire_shares(worn, TABLE)}
    assert shares["L120"].resistance_ohm_per_km == pytest.approx(0.157 * 1.0786)
    assert shares["Cu100"].resistance_ohm_per_km == pytest.approx(0.183 * 1.0786 / 0.85)
    assert (shares["L120"].share, shares["Cu100"].share) == pytest.approx((0.4068, 0.5932), abs=1e-4)
    assert (shares["Cu100"].count, shares["Cu100"].use, shares["Cu100"].wear_percent) == (2, "contact", 15.0)


def test_wires_in_parallel_by_hand():
    wires = [
        {"conductor": "L150", "use": "messenger"},
        {"conductor": "CuAg150", "use": "contact", "count": 2},
        {"conductor": "Cu300", "use": "feeder", "wear_percent": 5.0},
        {"conductor": "Cu100", "use": "contact", "wear_percent": 30.0},
    ]
    siemens = [1.0 / 0.1237, 2.0 * 0.9 / 0.122, 0.95 / 0.061, 0.7 / 0.183]
    row = contact(wires=wires, wear_percent=10.0)  # a wire's own wear wins
    assert contact_line_resistance(row, TABLE) == pytest.approx(1.0 / sum(siemens), rel=1e-12)
    assert [s.share for s in wire_shares(row, TABLE)] == pytest.approx([g / sum(siemens) for g in siemens], rel=1e-12)
    assert sum(s.share for s in wire_shares(row, TABLE)) == pytest.approx(1.0, rel=1e-12)


def test_temperature_alone_changes_the_printed_value_as_its_wires_do():
    assert ohm(type="C120-2C", temperature_c=20.0) == ohm(type="C120-2C") == 0.0613
    assert ohm(type="C120-2C", temperature_c=80.0) == pytest.approx(0.0613 * (1.0 + 0.00393 * 60.0), rel=1e-12)
    assert ohm(type="C120-2C", temperature_c=-10.0) == pytest.approx(0.0613 * (1.0 - 0.00393 * 30.0), rel=1e-12)


def test_wires_of_other_metals_change_by_their_own_coefficients():
    aluminium = Conductor(kind="wire", name="Al", resistance_ohm_per_km=0.12, per_kelvin=0.00403)
    wires = [{"conductor": "Al", "use": "feeder"}, {"conductor": "Cu100", "use": "contact"}]
    warm = 1.0 / (1.0 / (0.12 * (1.0 + 40.0 * 0.00403)) + 1.0 / (0.183 * (1.0 + 40.0 * 0.00393)))
    assert ohm((*TABLE, aluminium), wires=wires, temperature_c=60.0) == pytest.approx(warm, rel=1e-12)


def test_a_type_without_wires_has_its_printed_value_and_its_own_coefficient():
    assert ohm(type="KB70-C") == 0.123
    assert wire_shares(contact(type="KB70-C"), TABLE) == []
    bronze = find_conductor(TABLE, "contact_line", "KB70-C").model_copy(update={"per_kelvin": 0.004})
    table = overlay_conductors(TABLE, (bronze,))
    assert ohm(table, type="KB70-C", temperature_c=70.0) == pytest.approx(0.123 * 1.2, rel=1e-12)


def test_shares_of_a_type_without_wear_go_with_its_printed_value():
    shares = wire_shares(contact(type="C120-2C"), TABLE)
    assert 1.0 / sum(s.count / s.resistance_ohm_per_km for s in shares) == pytest.approx(0.0613, rel=1e-12)
    assert shares[0].share == pytest.approx(0.0613 / 0.157, rel=1e-12)


@pytest.mark.parametrize("printed", [0.03, 0.16])
def test_a_printed_value_that_no_wear_gives_stays_and_the_shares_are_those_of_new_wires(printed):
    odd = Conductor(kind="contact_line", name="odd", resistance_ohm_per_km=printed, wires="messenger 1 L120 + contact 2 Cu100")
    table = (*TABLE, odd)
    assert wear_as_printed(odd, table) is None
    assert ohm(table, type="odd") == printed
    assert ohm(table, type="odd", temperature_c=40.0) == pytest.approx(printed * 1.0786, rel=1e-12)
    assert [s.share for s in wire_shares(contact(type="odd"), table)] == [
        s.share for s in wire_shares(contact(type="C120-2C", wear_percent=0.0), table)
    ]


def test_a_given_resistance_is_used_as_it_is():
    row = contact(resistance_ohm_per_km=0.05)
    assert contact_line_resistance(row, ()) == 0.05
    assert wire_shares(row, ()) == []
    assert return_resistance(rails(resistance_ohm_per_km=0.0), 2, ()) == 0.0


@pytest.mark.parametrize(("rail", "single"), [("S49", 0.0134), ("49E1", 0.0134), ("60E1", 0.0110), ("S60", 0.0110)])
def test_rails_of_several_tracks_are_in_parallel(rail, single):
    # S. Yoo 2024: 0.0134 and 0.0110 ohm/km for one track, 0.0067 and 0.0055 for two
    assert return_resistance(rails(rail=rail), 1, TABLE) == single
    assert return_resistance(rails(rail=rail), 2, TABLE) == pytest.approx(single / 2.0, rel=1e-12)


def test_rails_wear_and_warm():
    row = rails(rail="60E1", wear_percent=5.0, temperature_c=45.0)
    assert return_resistance(row, 2, TABLE) == pytest.approx(0.011 * (1.0 + 25.0 * 0.0046) / 0.95 / 2.0, rel=1e-12)


@pytest.mark.parametrize(("rail", "area"), [("49E1", 6292.0), ("60E1", 7670.0)])
@pytest.mark.parametrize("rho", ["0.20", "0.21"])
def test_rails_of_other_literature_have_its_resistivity(rail, area, rho):
    row = look_up("rail", f"{rail}-rho{rho}", TABLE)
    assert row.resistance_ohm_per_km == pytest.approx(1000.0 * float(rho) / (2.0 * area), abs=0.51e-4)
    assert row.status == "recalled"


def test_feeder_cables():
    # S. Yoo 2024: feeder 2 x 500 Al 350 m, return feeder 6 x 240 Al 350 m; 0.0105 and 0.0073 ohm
    assert cable_resistance(Cable(cable="YAKY-500", cables=2, length_m=350.0), TABLE, 1.0) == pytest.approx(0.0105, rel=1e-12)
    assert cable_resistance(Cable(cable="YAKY-240", cables=6, length_m=350.0), TABLE, 1.0) == pytest.approx(0.0073, abs=5e-5)
    assert cable_resistance(Cable(resistance_ohm=0.02), TABLE, 1.0) == 0.02
    assert cable_resistance(Cable(resistance_ohm=0.0), TABLE, 1.0) == 0.0
    assert cable_resistance(Cable(), TABLE, 0.7) == 0.7


@pytest.mark.parametrize("kind", ["YKY", "YAKY", "XLPE-Cu"])
def test_cables_have_the_resistivity_of_their_metal(kind):
    rows = [row for row in TABLE if row.kind == "cable" and row.name.rsplit("-", 1)[0] == kind]
    low, high = (0.028, 0.032) if kind == "YAKY" else (0.0176, 0.0190)
    assert len(rows) >= 7
    for row in rows:
        assert low < row.resistance_ohm_per_km * row.area_mm2 / 1000.0 < high, row.name  # [ohm mm2/m]


def test_a_name_that_the_table_lacks_is_a_key_error():
    for call in (
        lambda: ohm((), type="C120-2C"),
        lambda: ohm((), wires=[{"conductor": "Cu100", "use": "contact"}]),
        lambda: return_resistance(rails(rail="60E1"), 1, ()),
        lambda: cable_resistance(Cable(cable="YKY-120", length_m=1.0), (), 0.0),
    ):
        with pytest.raises(KeyError):
            call()

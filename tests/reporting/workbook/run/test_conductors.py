"""Resistances and shares of wires among the inputs of the workbook."""

import pytest
from fake_results import make_case
from read_workbook import read_table, texts

from tractionpower.io.library import change

GIVEN = "supply.contact_lines[0].resistance_ohm_per_km=null"


@pytest.fixture
def inputs(write):
    """Return a function that writes the workbook of changed inputs and reads their sheet."""
    results, scenario = make_case()
    return lambda *changes: write(results, change(scenario, changes))["Inputs conductors"]


def test_given_resistances_are_said_to_be(small):
    contact, rails = read_table(small["Inputs conductors"], 1)
    assert (contact["conductor"], contact["resistance [Ω/km]"], contact["found by"]) == ("contact line", 0.05, "given")
    assert (rails["conductor"], rails["resistance [Ω/km]"], rails["status"]) == ("return circuit", 0.01, "given by the user")
    assert (contact["wear [%]"], contact["temperature [°C]"]) == (None, None)
    assert "Share of current of each wire" not in texts(small["Inputs conductors"])


def test_a_type_as_printed_and_rails_of_both_tracks(inputs):
    sheet = inputs(GIVEN, "supply.contact_lines[0].type=C120-2C",
                   "supply.return_circuit[0].resistance_ohm_per_km=null", "supply.return_circuit[0].rail='60E1'")  # fmt: skip
    contact, rails = read_table(sheet, 1)
    assert (contact["resistance [Ω/km]"], contact["found by"]) == (0.0613, "type C120-2C, as its source prints")
    assert contact["wear [%]"] == pytest.approx(9.0, abs=0.1)
    assert contact["source"].startswith("C120-2C: S. Yoo")
    assert contact["status"].startswith("secondary")
    assert (rails["resistance [Ω/km]"], rails["found by"]) == (pytest.approx(0.0055), "rail 60E1, 2 tracks")
    assert rails["temperature [°C]"] == 20
    shares = read_table(sheet, 2)
    assert [(row["wire"], row["count"]) for row in shares] == [("L120", 1), ("Cu100", 2)]
    assert sum(row["share of the current [%]"] for row in shares) == pytest.approx(100.0)
    assert shares[0]["share of the current [%]"] == pytest.approx(100.0 * 0.0613 / 0.157)


def test_worn_and_warm_wires_name_all_their_sources(inputs):
    sheet = inputs(GIVEN, "supply.contact_lines[0].type=C120-2C",
                   "supply.contact_lines[0].wear_percent=15", "supply.contact_lines[0].temperature_c=40")  # fmt: skip
    contact = read_table(sheet, 1)[0]
    assert contact["resistance [Ω/km]"] == pytest.approx(0.06888, abs=5e-6)
    assert (contact["found by"], contact["wear [%]"], contact["temperature [°C]"]) == ("type C120-2C, its wires", 15, 40)
    assert all(f"{name}: " in contact["source"] for name in ("C120-2C", "L120", "Cu100"))


def test_feeders_by_their_cable(inputs, write):
    results, scenario = make_case()
    feeder = {"at": "Substation 1", "track": "1", "side": "high_km", "cable": "YAKY-500", "cables": 2, "length_m": 350.0}
    plain = scenario.model_dump(by_alias=True)
    plain["supply"]["feeders"] = [feeder]
    with_feeder = change(type(scenario).model_validate(plain), [])
    sheet = write(results, with_feeder)["Inputs conductors"]
    (row,) = read_table(sheet, 2)
    assert (row["feeder"], row["cable"], row["resistance [Ω]"]) == ("Substation 1 1 high_km", "YAKY-500", pytest.approx(0.0105))

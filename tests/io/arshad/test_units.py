"""Quantities as the paper writes them: numbers with a unit close by, glued on, or none."""

import math

import pytest

from tractionpower.io.arshad.units import PSI_BAR, Told, allowed_units, plain_unit, read_quantity


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("150.0 sec", "time", 150.0),
        ("0.005sec", "time", 0.005),
        ("150", "time", 150.0),
        ("6000.0 n/mm", "stiffness", 6.0),
        ("600000.0 N/mm", "stiffness", 600.0),
        ("6 MN/m", "stiffness", 6.0),
        ("0.4 m", "length", 0.4),
        ("1000 feet", "length", 304.8),
        ("1 mile", "length", 1609.344),
        ("35.0 degree", "angle", 35.0),
        ("1 %", "grade", 10.0),
        ("1%", "grade", 10.0),
        ("-1.5 percent", "grade", -15.0),
        ("2 Deg", "degrees", 2.0),
        ("12 %", "share", 0.12),
        ("0.12", "share", 0.12),
        ("800 ft/s", "speed", 243.84),
        ("1 short ton", "mass", 0.90718474),
        ("2000 lb", "mass", 0.90718474),
        ("0.0015", "resistance", 1.5),
        ("3 lb/ton", "resistance", 1.5),
        ("0.8 lb/ton/deg", "curve_resistance", 0.4),
        ("20000", "count", 20000.0),
        ("1 hp", "power", 0.745699872),
    ],
)  # fmt: skip
def test_numbers_with_units(text, dimension, value):
    assert read_quantity(text, dimension) == pytest.approx(value, rel=1e-8)


def test_psi_is_pound_per_square_inch():
    assert read_quantity("26", "pressure") == pytest.approx(26 * 6894.757293168 / 1e5, rel=1e-10)
    assert PSI_BAR == pytest.approx(0.06894757293168, rel=1e-12)


def test_grade_of_eq_10():
    # 20 lb per short ton and per cent is 10 N/kN: the weight times the gradient.
    assert read_quantity("20 lb/ton", "resistance") == read_quantity("1 %", "grade") == 10.0


@pytest.mark.parametrize(
    ("text", "dimension", "found", "allowed", "remedy"),
    [
        ("0.4 furlong", "length", "the unit in '0.4 furlong'", "mile", ""),
        ("0.4", "length", "'0.4', without a unit", "ft", ""),
        ("0,4 m", "length", "'0,4 m'", "a number", "point"),
        ("many", "time", "'many'", "a number", ""),
        ("1 % ", "degrees", "the unit", "deg", ""),
        ("1e999", "count", "'1e999'", "a finite number", ""),
        ("2.5", "count", "'2.5'", "a whole number", ""),
        ("3 m", "number", "the unit", "without a unit", ""),
    ],
)
def test_what_is_no_quantity_is_told(text, dimension, found, allowed, remedy):
    told = read_quantity(text, dimension)
    assert isinstance(told, Told)
    assert found in told.found
    assert allowed in told.allowed
    assert remedy in told.remedy


def test_the_unit_of_a_header():
    assert read_quantity("3000", "length", "feet") == pytest.approx(914.4)
    assert read_quantity("1 m", "length", "feet") == 1.0  # a cell may say otherwise
    assert plain_unit(" Sq. ft") == "sqft"
    assert "ft" in allowed_units("length")
    assert math.isclose(read_quantity("7", "pressure", "kpa"), 0.07)

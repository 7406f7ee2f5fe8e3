"""The train consist, whose format the paper omits: places, masses, resistance, what a locomotive needs."""

import pytest
from arshad_files import CONSIST, INI

from tractionpower.io.arshad.consist import read_consist
from tractionpower.io.arshad.settings import read_settings
from tractionpower.io.documents import Reader
from tractionpower.io.text_files import Source

HEAD = "Position,Number,Type,Lading Weight (tons),Tare Weight (tons),Length (ft),Axles,Tractive Effort (lbf),Power (hp)\n"
LOCO = "1,1,Locomotive,0,130,60,6,60000,3000\n"


@pytest.fixture
def read(tmp_path):
    def tell(text, extra=""):
        (tmp_path / "Simulation.ini").write_text(INI + extra, encoding="utf-8")
        (tmp_path / "TrainConsist.csv").write_text(text, encoding="utf-8")
        reader = Reader(tmp_path)
        settings = read_settings(reader, Source(tmp_path / "Simulation.ini", "Simulation.ini", ""))
        consist = read_consist(reader, Source(tmp_path / "TrainConsist.csv", "TrainConsist.csv", ""), settings)
        return consist, reader.problems

    return tell


def force_lb_per_ton(vehicle, mass_t, speed_mph):
    """Return the running resistance that the declaration makes."""
    resistance, kmh = vehicle["resistance"], speed_mph * 1.609344
    weight_kn = mass_t * 9.80665
    force_n = resistance["a_n"] + resistance["c_n_per_kmh2"] * kmh**2
    force_n += weight_kn * (resistance["specific_a_n_per_kn"] + resistance["specific_b_n_per_kn_per_kmh"] * kmh)
    return force_n / 4.4482216152605 / (mass_t / 0.90718474)


def test_places_masses_and_lengths(read):
    consist, problems = read(CONSIST)
    assert problems == []
    assert (consist.locomotives, consist.cars, consist.length_m) == (1, 5, 94.0)
    assert [part["count"] for part in consist.parts] == [1, 5]
    assert [vehicle["mass_t"] for vehicle in consist.vehicles] == [110.0, 25.0]
    assert consist.parts[0]["traction"]["law"] == "quadratic_power"
    assert "traction" not in consist.parts[1]
    assert not consist.has_electric
    assert consist.mark.find((1,)).place == "TrainConsist.csv:3"


def test_rows_in_any_order_and_imperial_units(read):
    consist, problems = read(f"{HEAD}2,40,Gondola,100,30,50,4,,\n{LOCO}")
    assert problems == []
    assert [vehicle["id"] for vehicle in consist.vehicles] == ["locomotive", "gondola"]
    assert consist.vehicles[1]["mass_t"] == pytest.approx(30 * 0.90718474)
    assert consist.vehicles[1]["load_t"] == pytest.approx(100 * 0.90718474)
    assert consist.length_m == pytest.approx(2060 * 0.3048)
    assert consist.parts[0]["traction"]["starting_effort_kn"] == pytest.approx(266.893, abs=1e-3)
    assert consist.parts[0]["traction"]["power_kw"] == pytest.approx(2237.1, abs=0.1)


def test_rows_of_one_type_have_letters_and_no_number_that_looks_like_a_place(read):
    tank = "{},{},Tank Car,100,30,50,4,,\n"
    consist, problems = read(HEAD + LOCO + tank.format(2, 3) + "5,1,Gondola,0,30,50,4,,\n" + tank.format(6, 2))
    assert problems == []
    names = ["locomotive", "tank-car-a", "gondola", "tank-car-b"]
    assert [vehicle["id"] for vehicle in consist.vehicles] == names
    assert [part["id"] for part in consist.parts] == names


@pytest.mark.parametrize(("lading", "drag"), [(100.0, 4.2), (0.0, 12.0)])
@pytest.mark.parametrize("speed", [0.0, 25.0, 60.0])
def test_the_canadian_national_form(read, lading, drag, speed):
    consist, _ = read(f"{HEAD}{LOCO}2,1,Gondola,{lading:g},30,50,4,,\n")
    tons = 30.0 + lading
    expected = 1.5 + 18.0 * 4 / tons + 0.03 * speed + drag * 105.0 * speed**2 / (10_000.0 * tons)
    assert force_lb_per_ton(consist.vehicles[1], tons * 0.90718474, speed) == pytest.approx(expected, rel=1e-6)


def test_the_coefficients_of_table_3_win(read):
    consist, problems = read(
        CONSIST.replace("Power (kW)", "Power (kW),Frontal Area (ft2)").replace("270,1500", "270,1500,").replace("4,,", "4,,,100"),
        "Rolling Friction Coefficient = 0.002\nWind Resistance Drag Coefficient = 10\n",
    )
    assert problems == []
    resistance = consist.vehicles[1]["resistance"]
    assert (resistance["a_n"], resistance["specific_a_n_per_kn"]) == (0.0, 2.0)
    # 10 x 100 ft2 x V2 / 10000 lb
    assert resistance["c_n_per_kmh2"] == pytest.approx(0.1 * 4.4482216 / 1.609344**2, rel=1e-6)


def test_everything_wrong_is_told_at_once(read):
    rows = "1,1,Lokomotive,0,110,19,6,270,1500\n2,0,Car,-1,25,15,4,,\n7,1,Locomotive,0,100,19,6,270,\n8,1,Car,0,,15,x,,\n"
    consist, problems = read(CONSIST.splitlines()[0] + "\n" + rows)
    assert consist is None
    assert [(problem.place.rpartition(":")[2], problem.code) for problem in problems] == [
        ("2", "unknown_word"), ("3", "out_of_bounds"), ("3", "out_of_bounds"), ("4", "missing_value"), ("5", "missing_value"),
        ("5", "bad_value"),
    ]  # fmt: skip
    assert problems[0].remedy == "did you mean locomotive?"
    assert "no Power of a locomotive" in problems[3].found


@pytest.mark.parametrize(("place", "allowed"), [("3", "2, behind the vehicles before it"), ("1", "2, behind")])
def test_places_that_leave_gaps_or_collide(read, place, allowed):
    _, problems = read(CONSIST.replace("2,5,Car", f"{place},5,Car"))
    assert [problem.code for problem in problems] == ["bad_position"]
    assert allowed in problems[0].allowed
    assert problems[0].place == "TrainConsist.csv:3"


def test_masses_need_their_unit(read):
    _, problems = read(CONSIST.replace("Tare Weight (t)", "Tare Weight").replace("Length (m)", "Length (yd)"))
    assert [problem.code for problem in problems] == ["bad_unit", "bad_unit"]
    assert "lb" in problems[0].remedy


def test_a_dynamic_brake_has_effort_and_power(read):
    with_effort = CONSIST.replace("Power (kW)\n", "Power (kW),Dynamic Brake Effort (kN)\n").replace("270,1500", "270,1500,150")
    _, problems = read(with_effort.replace("4,,", "4,,,"))
    assert [problem.found for problem in problems] == [
        "the effort or the power of a dynamic brake alone in column 'Dynamic Brake Effort (kN)'"
    ]

"""Bonds, earth, and ways of the current back to the substations."""

import pytest
from small_supplies import OWN_RAILS, RAILS, WHOLE, assert_only, problems_of, station

BONDS = WHOLE | {"every_km": 0.5}
VLD = {"id": "V", "track": "1", "km": 5.0, "closes": [{"above_v": 60.0}]}
EARTH = {"id": "E", "track": "2", "km": 6.0, "resistance_ohm": 2.0}
LEAKY = [RAILS | {"leakage_s_per_km": 0.1}]


def test_bonds_in_order():
    assert problems_of(return_circuit=OWN_RAILS, bonds=[BONDS]) == []
    assert problems_of(return_circuit=OWN_RAILS) == []  # joined at the substations


def test_one_bond_only():
    problems = problems_of(return_circuit=OWN_RAILS, bonds=[BONDS | {"every_km": 30.0}])
    assert_only(
        problems, "one_bond", "supply.bonds[0].every_km", "every 30 km on 20 km: only the one at km 0", severity="warning"
    )


def test_bonds_that_join_nothing():
    words = ("join nothing", "share one return conductor")
    assert_only(problems_of(bonds=[BONDS]), "bond_joins_nothing", "supply.bonds[0]", *words, severity="warning")
    alone = problems_of(return_circuit=OWN_RAILS, bonds=[BONDS | {"tracks": ["1"]}])
    assert_only(alone, "bond_joins_nothing", "supply.bonds[0]", "one track", severity="warning")


def test_bonds_stand_on_tracks_that_exist():
    unknown = problems_of(return_circuit=OWN_RAILS, bonds=[BONDS | {"tracks": ["1", "2", "5"]}])
    assert_only(unknown, "unknown_track", "supply.bonds[0].tracks", "no track 5")
    beyond = problems_of(return_circuit=OWN_RAILS, bonds=[BONDS | {"to_km": 21.0}])
    assert_only(beyond, "off_track", "supply.bonds[0].to_km", "km 21")


def test_a_distance_given_in_metres_is_not_followed():
    problems = problems_of(return_circuit=OWN_RAILS, bonds=[BONDS | {"every_km": 1e-9}])
    assert_only(problems, "bond_distance", "supply.bonds[0].every_km", "at least 1 m")


@pytest.mark.parametrize(
    ("name", "item", "code", "path", "words"),
    [
        ("voltage_limiting_devices", VLD | {"km": 30.0}, "off_track", "voltage_limiting_devices[V].km", ["km 30"]),
        ("voltage_limiting_devices", VLD | {"track": "7"}, "unknown_track", "voltage_limiting_devices[V].track", ["no track 7"]),
        ("earthing", EARTH | {"km": -1.0}, "off_track", "earthing[E].km", ["km -1"]),
        (
            "earthing", {"id": "E", "substation": "Mx", "resistance_ohm": 1.0}, "unknown_station", "earthing[E].substation",
            ["no substation 'Mx'", "A, B, M"],
        ),
        (
            "earthing", {"id": "E", "substation": "C", "resistance_ohm": 1.0}, "unknown_station", "earthing[E].substation",
            ["no substation 'C'"],
        ),
    ],
)  # fmt: skip
def test_places_of_earth_devices(name, item, code, path, words):
    assert_only(problems_of(**{name: [item]}, return_circuit=LEAKY), code, f"supply.{path}", *words)


def test_earth_devices_need_rails():
    short = [LEAKY[0] | {"to_km": 10.0}]
    found = {
        problem.path: problem.code for problem in problems_of(return_circuit=short, voltage_limiting_devices=[VLD | {"km": 15.0}])
    }
    assert found["supply.voltage_limiting_devices[V].km"] == "no_return_circuit"


def test_an_id_of_an_earthing_and_of_a_device():
    problems = problems_of(return_circuit=LEAKY, earthing=[EARTH], voltage_limiting_devices=[VLD | {"id": "E"}])
    words = ("'E' is an earthing and a voltage-limiting device at once",)
    assert_only(problems, "duplicate_id", "supply.voltage_limiting_devices[E]", *words)


def test_a_device_without_reference():
    problems = problems_of(voltage_limiting_devices=[VLD])
    words = ("neither leakage nor earthing", "give leakage_s_per_km")
    assert_only(problems, "no_earth_reference", "supply.voltage_limiting_devices[V]", *words)
    assert problems_of(voltage_limiting_devices=[VLD], return_circuit=LEAKY) == []
    assert problems_of(voltage_limiting_devices=[VLD], earthing=[EARTH]) == []


def test_leakage_of_other_rails_is_no_reference():
    """Rails of track 2 leak, those of track 1 hang together with them only where a substation or bond joins them."""
    rows = [OWN_RAILS[0], OWN_RAILS[1] | {"leakage_s_per_km": 0.1}]
    only_1 = [station(name, km, tracks=["1"]) for name, km in (("A", 0.0), ("B", 20.0))]
    apart = {"return_circuit": rows, "substations": only_1, "section_cabins": [], "voltage_limiting_devices": [VLD]}
    assert "no_earth_reference" in [problem.code for problem in problems_of(**apart)]
    assert "no_earth_reference" not in [problem.code for problem in problems_of(**apart, bonds=[BONDS])]


@pytest.mark.parametrize("item", [EARTH, {"id": "E", "substation": "M", "resistance_ohm": 2.0}])
def test_a_single_earthing_carries_nothing(item):
    words = ("the only connection of its rails with earth", "no current flows")
    assert_only(problems_of(earthing=[item]), "single_earthing", "supply.earthing[E]", *words, severity="warning")
    assert problems_of(earthing=[item, EARTH | {"id": "F"}]) == []
    assert problems_of(earthing=[item], return_circuit=LEAKY) == []


def test_rails_that_no_current_leaves():
    """Track 2 is fed over the section cabin, but its rails meet those of track 1 nowhere."""
    substations = [station(name, km, tracks=["1"]) for name, km in (("A", 0.0), ("B", 20.0))]
    problems = problems_of(substations=substations, return_circuit=OWN_RAILS)
    words = ("track 2 from km 0 to km 20", "currents cannot return", "bonds")
    assert_only(problems, "no_way_back", "supply.return_circuit[1]", *words, severity="warning")
    assert problems_of(substations=substations, return_circuit=OWN_RAILS, bonds=[BONDS]) == []
    one_bond = [{"from_km": 3.0, "to_km": 3.001, "every_km": 0.001}]
    assert problems_of(substations=substations, return_circuit=OWN_RAILS, bonds=one_bond) == []


def test_rails_follow_each_other_along_a_track():
    rows = [row | {"from_km": low, "to_km": high} for row in OWN_RAILS for low, high in ((0.0, 7.0), (7.0, 20.0))]
    assert problems_of(return_circuit=rows) == []


def test_an_open_return_feeder_does_not_join():
    substations = [station("M", 8.0), station("B", 20.0, tracks=["1"])]
    row = {"at": "M", "track": "2", "side": "return", "resistance_ohm": 0.01}
    parts = {"substations": substations, "return_circuit": OWN_RAILS}
    assert problems_of(**parts, feeders=[row]) == []
    problems = problems_of(**parts, feeders=[row | {"state": "open"}])
    assert_only(problems, "no_way_back", "supply.return_circuit[1]", "track 2 from km 0 to km 20", severity="warning")

"""Checks of the supply: each fault gives one problem with its code, its place and what a person needs to mend it."""

import pytest

from tractionpower.alignment.checks import check_line
from tractionpower.model.limits import VOLTAGE_NAMES, Limit
from tractionpower.model.line import ChainageBreak, Line, Station, Track
from tractionpower.model.loads import Load
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, SectionPoint, Substation, Supply
from tractionpower.supply.checks import check_supply

BOTH = ("1", "2")
LIMITS = tuple(
    Limit(system="dc3000", name=name, value=value, unit="V")
    for name, value in zip(VOLTAGE_NAMES, (2000.0, 2000.0, 3000.0, 3600.0, 3900.0), strict=True)
)


def station(name, km, **more):
    return Substation(**({"id": name, "km": km, "no_load_voltage_v": 3600, "internal_resistance_ohm": 0.12} | more))


def cabin(name="C", km=10.0, **more):
    return SectionCabin(id=name, km=km, **more)


def insulator(name="P", track="1", km=5.0, **more):
    return SectionPoint(id=name, track=track, km=km, **more)


def wire(low=0.0, high=20.0, tracks=BOTH):
    return ContactLine(tracks=tracks, from_km=low, to_km=high, resistance_ohm_per_km=0.05)


def rails(low=0.0, high=20.0, tracks=BOTH):
    return ReturnCircuit(tracks=tracks, from_km=low, to_km=high, resistance_ohm_per_km=0.01)


def load(name="x", track="1", km=4.0, **more):
    return Load(**({"id": name, "track": track, "km": km, "power_kw": 400.0} | more))


A, B = station("A", 0.0), station("B", 20.0)


@pytest.fixture
def line():
    tracks = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0))
    return Line(tracks=tracks, stations=(Station(id="A", km=0.0), Station(id="C", km=10.0), Station(id="B", km=20.0)))


@pytest.fixture
def check(line):
    """Return a function that checks the good supply with some parts replaced."""
    good = {
        "substations": (A, B),
        "section_cabins": (cabin(),),
        "contact_lines": (wire(),),
        "return_circuit": (rails(),),
        "loads": (load("depot"), load("train", "2", 14.0, power_kw=None, current_a=1000.0)),
    }

    def run(line=line, limits=LIMITS, **changes):
        return check_supply(Supply(**(good | changes)), line, limits)

    return run


def assert_only(problems, code, path, *words, severity="error"):
    """Assert that there is one problem and that this is it."""
    assert len(problems) == 1, [str(problem) for problem in problems]
    assert (problems[0].code, problems[0].path, problems[0].severity) == (code, path, severity)
    for word in words:
        assert word in str(problems[0])


def codes(problems):
    return sorted({problem.code for problem in problems})


def test_the_good_study_has_no_problem(check, line):
    assert check() == []
    assert check_line(line) == []


# --- identifiers and places


@pytest.mark.parametrize(
    ("name", "devices"),
    [
        ("substations", (A, station("A", 20.0))),
        ("section_cabins", (cabin("A2"), cabin("A2", 12.0))),
        ("section_points", (insulator(state="closed"), insulator(km=6.0, state="closed"))),
        ("loads", (load(), load(km=5.0))),
    ],
)
def test_two_devices_of_one_id(check, name, devices):
    assert_only(check(**{name: devices}), "duplicate_id", f"supply.{name}[{devices[0].id}]", "stands 2 times", "its own id")


def test_a_substation_and_a_cabin_of_one_id(check):
    assert_only(
        check(section_cabins=(cabin("A"),)), "duplicate_id", "supply.section_cabins[A]", "'A'", "substation and a section cabin"
    )


@pytest.mark.parametrize(
    ("name", "device", "code", "path", "words"),
    [
        ("substations", station("X", 9.0, tracks=("7", "1")), "unknown_track", "tracks", ["no track 7", "tracks: 1, 2"]),
        ("section_cabins", cabin("X", tracks=("1", "1")), "duplicate_track", "tracks", ["track 1", "name it once"]),
        ("section_points", insulator("X", track="3"), "unknown_track", "track", ["no track 3"]),
        ("loads", load("X", track="3"), "unknown_track", "track", ["no track 3"]),
        ("substations", station("X", 20.5), "off_track", "km", ["no track exists at km 20.5", "tracks 1, 2 from km 0 to km 20"]),
        ("section_cabins", cabin("X", -1.0, tracks=("1", "2")), "off_track", "km", ["km -1 is not on tracks 1, 2"]),
        ("section_points", insulator("X", km=30.0), "off_track", "km", ["km 30 is not on track 1"]),
        ("loads", load("X", km=30.0), "off_track", "km", ["km 30 is not on track 1"]),
    ],
)
def test_devices_stand_on_tracks_that_exist(check, name, device, code, path, words):
    devices = (A, B, device) if name == "substations" else (device,)
    assert_only(check(**{name: devices}), code, f"supply.{name}[X].{path}", *words)


def test_a_device_without_tracks_belongs_to_those_at_its_place(check, line):
    longer = line.model_copy(update={"tracks": (*line.tracks, Track(id="3", from_km=19.0, to_km=30.0))})
    assert check(line=longer) == []
    assert check(line=longer, substations=(A, B, station("D", 25.0)))[0].code == "no_contact_line"


# --- contact lines and return circuit


@pytest.mark.parametrize(("name", "row"), [("contact_lines", wire), ("return_circuit", rails)])
def test_conductors_do_not_overlap(check, name, row):
    problems = check(**{name: (row(0.0, 12.0), row(12.0, 20.0), row(11.0, 12.5, ("2",)))})
    assert codes(problems) == ["overlap"]
    assert [problem.path for problem in problems] == [f"supply.{name}[2]"] * 2
    assert "rows 0 and 2 both hold on track 2 from km 11 to km 12" in problems[0].found


@pytest.mark.parametrize(("name", "row"), [("contact_lines", wire), ("return_circuit", rails)])
def test_conductors_lie_on_tracks_that_exist(check, name, row):
    assert_only(check(**{name: (row(tracks=("1", "2", "9")),)}), "unknown_track", f"supply.{name}[0].tracks", "no track 9")


def test_a_return_circuit_beyond_the_end_of_a_track(check):
    assert_only(
        check(return_circuit=(rails(high=25.0),)), "off_track", "supply.return_circuit[0].to_km", "km 25 is not on tracks 1, 2"
    )


def test_a_gap_of_the_contact_line(check):
    gap = check(contact_lines=(wire(0.0, 10.0), wire(10.0, 12.0, ("2",)), wire(12.0, 20.0)))
    assert_only(gap, "gap", "supply.contact_lines", "track 1 from km 10 to km 12", "has no supply", severity="warning")


def test_a_track_without_any_contact_line_is_no_gap(check):
    assert check(contact_lines=(wire(tracks=("1",)),), loads=()) == []


def test_a_load_without_contact_line(check):
    words = ("load x reaches no contact line on track 2 at km 4", "contact_lines")
    assert_only(
        check(contact_lines=(wire(tracks=("1",)),), loads=(load(track="2"),)), "no_contact_line", "supply.loads[x].km", *words
    )


def test_a_load_in_a_gap_is_an_error_beside_the_warning(check):
    problems = check(contact_lines=(wire(0.0, 11.0), wire(12.0, 20.0)), loads=(load(km=11.5), load("edge", km=11.0)))
    assert [(problem.code, problem.severity) for problem in problems] == [("gap", "warning"), ("no_contact_line", "error")]


@pytest.mark.parametrize(
    ("name", "device", "kind"),
    [
        ("substations", station("X", 5.0, tracks=("2",)), "substation X"),
        ("section_cabins", cabin("X", 5.0, tracks=("2",)), "section cabin X"),
        ("section_points", insulator("X", "2"), "section point X"),
    ],
)
def test_a_device_that_reaches_no_contact_line(check, name, device, kind):
    devices = (A, B, device) if name == "substations" else (device,)
    problems = check(contact_lines=(wire(tracks=("1",)),), loads=(), **{name: devices})
    words = (f"{kind} reaches no contact line on track 2 at km 5",)
    assert_only(problems, "no_contact_line", f"supply.{name}[X].km", *words, severity="warning")


def test_a_contact_line_without_return_circuit(check):
    words = ("no return circuit on tracks 1, 2 from km 8 to km 20", "zero resistance is allowed")
    assert_only(check(return_circuit=(rails(high=8.0),)), "no_return_circuit", "supply.contact_lines[0]", *words)


def test_the_return_circuit_of_another_track_does_not_count(check):
    problems = check(contact_lines=(wire(tracks=("1",)), wire(tracks=("2",))), return_circuit=(rails(tracks=("1",)),))
    assert_only(problems, "no_return_circuit", "supply.contact_lines[1]", "on track 2 from km 0 to km 20")


def test_conductors_through_chainage_breaks(check, line):
    broken = line.model_copy(update={"chainage_breaks": (ChainageBreak(at_km=7.0, continues_as_km=9.0),)})
    assert check(line=broken, contact_lines=(wire(0.0, 7.0), wire(9.0, 20.0))) == []


# --- reach


def test_an_open_point_leaves_a_dead_stretch(check):
    problems = check(substations=(A,), section_cabins=(), section_points=(insulator(km=15.0),))
    words = ("no substation in service reaches track 1 from km 15 to km 20", "close a section cabin or section point")
    assert_only(problems, "dead_stretch", "supply.contact_lines[0]", *words, severity="warning")


def test_a_dead_stretch_between_two_open_cabins_and_its_load(check):
    cabins = (cabin("C", 8.0, state="open"), cabin("D", 16.0, state="open"))
    problems = check(section_cabins=cabins, contact_lines=(wire(0.0, 7.0), wire(7.0, 20.0)))
    assert [(problem.code, problem.path, problem.severity) for problem in problems] == [
        ("dead_stretch", "supply.contact_lines[1]", "warning"),
        ("dead_load", "supply.loads[train].km", "warning"),
    ]
    assert "tracks 1, 2 from km 8 to km 16" in problems[0].found
    assert "load train on track 2, km 14," in problems[1].found


@pytest.mark.parametrize("state", ["in_service", "rectifiers_out"])
def test_a_busbar_ties_tracks(check, state):
    points = (insulator("P", "1", 12.0), insulator("Q", "2", 18.0))
    middle = station("M", 13.0, state=state)
    assert check(substations=(A, middle, B), section_cabins=(), section_points=points) == []
    tied = check(substations=(A, middle), section_cabins=(), section_points=points, loads=())
    assert_only(tied, "dead_stretch", "supply.contact_lines[0]", "track 2 from km 18 to km 20", severity="warning")


@pytest.mark.parametrize("state", ["bypassed", "open"])
def test_a_substation_that_is_bypassed_or_open_ties_nothing(check, state):
    points = (insulator("P", "1", 12.0),)
    problems = check(substations=(A, station("M", 13.0, state=state)), section_cabins=(), section_points=points, loads=())
    assert codes(problems) == ["dead_stretch"]
    assert problems[0].found.startswith("no substation in service reaches track 1 from km 12 to km ")


def test_a_bypassed_cabin_neither_ties_nor_cuts(check):
    point = (insulator(km=12.0),)
    assert check(section_cabins=(cabin(km=15.0),), section_points=point, substations=(A,)) == []
    assert_only(
        check(section_cabins=(cabin(km=15.0, state="bypassed"),), section_points=point, substations=(A,)),
        "dead_stretch", "supply.contact_lines[0]", "track 1 from km 12 to km 20", severity="warning",
    )  # fmt: skip


def test_a_chain_of_ties_is_followed(check):
    points = (insulator("P", "1", 5.0), insulator("Q", "2", 10.0), insulator("R", "1", 15.0))
    cabins = (cabin("C", 7.0), cabin("D", 12.0), cabin("E", 17.0))
    assert check(substations=(A,), section_points=points, section_cabins=cabins) == []
    broken = check(substations=(A,), section_points=points, section_cabins=cabins[1:], loads=())
    assert [problem.found.removeprefix("no substation in service reaches ") for problem in broken] == [
        "track 1 from km 5 to km 20",
        "track 2 from km 10 to km 20",
    ]


def test_a_track_tied_to_nothing_is_dead(check):
    problems = check(substations=(station("A", 0.0, tracks=("1",)),), section_cabins=(), loads=())
    assert_only(problems, "dead_stretch", "supply.contact_lines[0]", "track 2 from km 0 to km 20", severity="warning")


@pytest.mark.parametrize("stations", [(), (station("A", 0.0, state="rectifiers_out"),)])
def test_no_substation_in_service(check, stations):
    words = ("no substation is in service", "put a substation into service")
    assert_only(check(substations=stations), "no_source", "supply.substations", *words, severity="warning")


def test_a_supply_of_nothing_but_wires_is_in_order(check):
    assert check(substations=(), section_cabins=(), loads=()) == []


@pytest.mark.parametrize(
    ("name", "devices", "where"),
    [
        ("substations", (A, station("X", 0.0005, feeder_resistance_ohm=0.001), B), "tracks 1, 2"),
        ("section_cabins", (cabin(), cabin("X", 10.0, tracks=("2",), feeder_resistance_ohm=0.001)), "track 2"),
        ("section_points", (insulator(state="closed"), insulator("X", km=5.0009, state="closed")), "track 1"),
    ],
)
def test_devices_that_share_a_node(check, name, devices, where):
    words = ("less than 1 m apart on " + where, "they share a node")
    assert_only(check(**{name: devices}), "shared_node", f"supply.{name}[X].km", *words, severity="warning")


def test_devices_of_different_kinds_tracks_or_places_share_none(check):
    tied = cabin("C", 0.0, feeder_resistance_ohm=0.001)
    assert check(section_cabins=(tied, cabin("D", 10.0, tracks=("1",)), cabin("E", 10.0, tracks=("2",)))) == []
    assert check(section_cabins=(cabin("C", 10.0), cabin("D", 10.002)), loads=(load("a"), load("b"))) == []


# --- values


def test_more_heat_than_resistance(check):
    hot = station("A", 0.0, dissipative_resistance_ohm=0.2)
    words = ("0.2 ohm of heat", "0.12 ohm internal")
    path = "supply.substations[A].dissipative_resistance_ohm"
    assert_only(check(substations=(hot, B)), "dissipative_above_internal", path, *words)
    assert check(substations=(station("A", 0.0, dissipative_resistance_ohm=0.12), B)) == []


def test_an_unknown_system(check):
    assert_only(check(system="dc3k"), "unknown_system", "supply.system", "'dc3k'", "allowed: dc3000")
    assert_only(check(limits=()), "unknown_system", "supply.system", "the limits table is empty")


def test_limits_that_lack_a_voltage(check):
    assert_only(check(limits=LIMITS[1:-1]), "missing_limit", "limits", "dc3000 lack u_min2, u_max2", "add the rows")


@pytest.mark.parametrize(("volts", "grid", "words"), [(4000, 1.0, ["4000 V without load;"]), (3800, 1.1, ["4180 V", "1.1 p.u."])])
def test_no_load_voltage_above_the_highest(check, volts, grid, words):
    high = station("A", 0.0, no_load_voltage_v=volts, grid_voltage_pu=grid)
    path = "supply.substations[A].no_load_voltage_v"
    assert_only(
        check(substations=(high, B)), "no_load_above_u_max2", path, "U_max2 = 3900 V of dc3000", *words, severity="warning"
    )


def test_no_load_voltage_between_the_two_highest_is_in_order(check):
    assert check(substations=(station("A", 0.0, no_load_voltage_v=3900), B)) == []


def test_fold_back_above_the_highest(check):
    problems = check(loads=(load(power_kw=-500.0, fold_back_from_v=3950),))
    assert_only(problems, "fold_back_above_u_max2", "supply.loads[x].fold_back_from_v", "3950 V", "3900 V", "hard ceiling")
    assert check(loads=(load(power_kw=-500.0, fold_back_from_v=3900, from_="00:01:00", to="00:02:00"),)) == []


def test_everything_is_told_at_once(check):
    problems = check(
        system="x", substations=(station("A", 99.0),), contact_lines=(wire(0.0, 5.0),), return_circuit=(rails(0.0, 4.0),)
    )
    assert codes(problems) == [
        "dead_load", "dead_stretch", "gap", "no_contact_line", "no_return_circuit", "off_track", "unknown_system",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("more", "warned"),
    [
        ({"units": 2}, True),
        ({}, False),
        ({"units": 2, "units_in_service": 1}, False),
        ({"units": 2, "units_in_service": 2}, False),
        ({"units": 2, "grid_resistance_ohm": 0.02}, False),
    ],
)
def test_units_without_effect(line, more, warned):
    supply = Supply(
        system="dc3000",
        substations=(station("A", 0.0, **more), B),
        contact_lines=(wire(),),
        return_circuit=(rails(),),
    )
    problems = check_supply(supply, line, LIMITS)
    assert [(problem.code, problem.path, problem.severity) for problem in problems] == (
        [("units_without_effect", "supply.substations[A].units", "warning")] if warned else []
    )


def test_units_that_an_event_takes_out_have_an_effect(line):
    event = {"time": 60.0, "device": "A", "units_in_service": 1}
    base = {"system": "dc3000", "contact_lines": (wire(),), "return_circuit": (rails(),)}
    supply = Supply.model_validate(base | {"substations": (station("A", 0.0, units=2), B), "switch_events": (event,)})
    assert check_supply(supply, line, LIMITS) == []

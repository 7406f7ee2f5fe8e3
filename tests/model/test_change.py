"""Changes by path: what they reach, what they refuse, and the law that the present value changes nothing."""

import json
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.errors import InputError, Problem
from tractionpower.model.base import format_time, parse_time
from tractionpower.model.change import apply_change, apply_changes, model_path, parse_scalar


def refused(scenario, *changes) -> Problem:
    with pytest.raises(InputError) as caught:
        apply_changes(scenario, changes)
    assert len(caught.value.problems) == 1
    return caught.value.problems[0]


def reach(scenario, path):
    value = scenario
    for name, key in re.findall(r"\.?([a-z_]+)|\[([^\]]+)\]", path):
        if name:
            value = getattr(value, name)
        elif isinstance(value, dict):
            value = value[key]
        else:
            value = next((item for item in value if getattr(item, "id", None) == key), None) or value[int(key)]
    return value


@pytest.mark.parametrize(
    ("change", "value"),
    [
        ("supply.substations[A].internal_resistance_ohm=0.2", 0.2),
        ("supply.section_cabins[C].state=bypassed", "bypassed"),
        ("supply.loads[train].km=2", 2.0),
        ("supply.contact_lines[0].resistance_ohm_per_km=0.06", 0.06),
        ("supply.contact_lines[0].tracks[1]=1", "1"),
        ("supply.section_cabins[C].tracks=null", None),
        ("supply.section_cabins[C].tracks=2 1", ("2", "1")),
        ("line.stations[B.2=x].km=19.5", 19.5),
        ("line.stations[A].stop_km[1]=0.2", 0.2),
        ("limits[0].value=3.1e3", 3100.0),
        ("clock.end=00:05:00", 300.0),
        (" seed = 7 ", 7),
        ("name='7'", "7"),
    ],
)
def test_a_change_reaches_its_place_and_nothing_else(scenario, change, value):
    changed = apply_change(scenario, change)
    path = re.fullmatch(r"\s*((?:\[[^\]]*\]|[^=])+?)\s*=.*", change)[1]
    assert reach(changed, path) == value
    before, after = dict(leaves(scenario)), dict(leaves(changed))
    differing = {key for key in before.keys() | after.keys() if before.get(key) != after.get(key)}
    assert all(key.startswith(path) for key in differing)
    assert differing
    assert scenario.input_hash != changed.input_hash


def leaves(scenario):
    """Return path and plain value of everything in a scenario that is neither a list nor a dictionary."""

    def walk(value, location):
        if isinstance(value, dict):
            for key, item in value.items():
                yield from walk(item, (*location, key))
        elif isinstance(value, list | tuple):
            for index, item in enumerate(value):
                yield from walk(item, (*location, index))
        else:
            yield model_path(plain, location), value

    plain = scenario.model_dump(by_alias=True)
    return walk(plain, ())


def test_a_change_to_the_present_value_gives_an_equal_scenario(scenario):
    paths = dict(leaves(scenario))
    assert len(paths) > 80
    for path, value in paths.items():
        changed = apply_change(scenario, f"{path}={json.dumps(value)}")
        assert changed == scenario, path
        assert changed.input_hash == scenario.input_hash, path


def test_alias_is_the_name_of_the_files(scenario):
    assert apply_change(scenario, "supply.loads[train].from=00:02:00").supply.loads[0].from_ == 120.0
    assert "'from'" in refused(scenario, "supply.loads[train].from_=00:02:00").remedy


def test_a_batch_is_validated_once_at_the_end(scenario):
    changed = apply_changes(scenario, ["supply.loads[x].power_kw=4000", "supply.loads[x].current_a=null"])
    assert (changed.supply.loads[1].power_kw, changed.supply.loads[1].current_a) == (4000.0, None)
    problem = refused(scenario, "supply.loads[x].power_kw=4000")
    assert (problem.code, problem.path) == ("bad_value", "supply.loads[x]")
    assert "one of power_kw, current_a, profile" in problem.found


def test_later_changes_win_and_none_is_no_change(scenario):
    assert apply_changes(scenario, ["seed=2", "seed=3"]).seed == 3
    assert apply_changes(scenario, []) == scenario


@pytest.mark.parametrize(
    ("change", "found", "allowed", "remedy"),
    [
        ("supply.substation[A].km=1", "no 'substation' in supply", "substations", "'substations'"),
        ("supply.substations[a].km=1", "no 'a' in supply.substations", "A, B", "'A'"),
        ("supply.substations[2].km=1", "no '2' in supply.substations", "A, B", ""),
        ("supply.substations[A].internal_resistance=1", "no 'internal_resistance'", "id, km, ", "'internal_resistance_ohm'"),
        ("suply.system=x", "no 'suply' in the scenario", "supply", "'supply'"),
        ("supply.contact_lines[1].from_km=1", "no '1' in supply.contact_lines", "0", ""),
        ("supply.section_points[P].state=open", "no 'P'", "empty", ""),
        ("clock.end.hour=1", "clock.end is a single value", "", "set clock.end itself"),
        ("supply..km=1", "is not a path", "[id]", ""),
        ("supply.loads[x]km=1", "is not a path", "[id]", ""),
    ],
)
def test_a_wrong_path_names_the_nearest_and_what_exists(scenario, change, found, allowed, remedy):
    problem = refused(scenario, change)
    assert (problem.code, problem.path) == ("unknown_path", change.split("=")[0])
    assert found in problem.found
    assert allowed in problem.allowed
    assert remedy in problem.remedy
    assert bool(remedy) == bool(problem.remedy)


def test_what_exists_is_shortened(scenario):
    stations = tuple(scenario.line.stations[1].model_copy(update={"id": f"S{number}"}) for number in range(50))
    many = scenario.model_copy(update={"line": scenario.line.model_copy(update={"stations": stations})})
    problem = refused(many, "line.stations[Q].km=1")
    assert "... (50 in all)" in problem.allowed
    assert len(problem.allowed) < 100


@pytest.mark.parametrize("change", ["supply.system", "supply.system=", "=3", "", "supply.loads[x]=", 'name="open', "name='a'b'"])
def test_what_is_no_change_is_refused(scenario, change):
    assert refused(scenario, change).code == "bad_change"


@pytest.mark.parametrize(
    ("change", "found"),
    [
        ("supply.substations[A].internal_resistance_ohm=-1", "-1: Input should be greater than 0"),
        ("supply.substations[A].km=ten", "'ten': Input should be a valid number"),
        ("supply.section_cabins[C].state=shut", "'closed', 'bypassed' or 'open'"),
        ("clock.start=7", "a time is HH:MM"),
        ("supply.loads[train].from=1 o'clock", "a time is HH:MM"),
        ("name=12", "valid string"),
        ("supply.loads=3", "valid tuple"),
    ],
)
def test_a_bad_value_gives_the_complaint_of_the_model(scenario, change, found):
    problem = refused(scenario, change)
    assert (problem.code, problem.path) == ("bad_value", change.split("=")[0])
    assert found in problem.found


def test_all_wrong_paths_are_told_at_once(scenario):
    with pytest.raises(InputError) as caught:
        apply_changes(scenario, ["nane=1", "seed=2", "supply.lods[x].km=2"])
    assert [problem.path for problem in caught.value.problems] == ["nane", "supply.lods[x].km"]


def test_two_items_of_one_id_are_ambiguous(scenario):
    both = apply_change(scenario, "supply.loads[x].id=train")
    assert refused(both, "supply.loads[train].km=3").code == "ambiguous_path"


# --- trains

RUN = {
    "route": [{"track": "1", "from_km": 0.0, "to_km": 20.0}],
    "calls": [{"station": "A", "departure": "00:05:00"}, {"station": "B", "arrival": "00:20:00"}],
}
CURVE = [{"current_a": 100.0, "emf_vs_per_rev": 10.0}, {"current_a": 200.0, "emf_vs_per_rev": 20.0}]


@pytest.fixture
def with_trains(scenario):
    vehicle = {"mass_t": 84.0, "length_m": 19.0, "max_speed_kmh": 160.0, "rotating_mass_factor": 1.2, "resistance": {}}
    series = {
        "kind": "series_motors", "motors": 4, "groupings": [{"series": 4, "parallel": 1}], "starting_current_a": 400.0,
        "motor_resistance_ohm": 0.1, "magnetisation": CURVE, "gear_ratio": 2.0, "wheel_diameter_m": 1.25, "gear_efficiency": 0.97,
    }  # fmt: skip
    inverter = {"kind": "inverter", "starting_effort_kn": 300.0, "power_kw": 5000.0, "efficiency": 0.87}
    trains = [
        {"id": "x", "vehicles": [{"id": "ep09"}, {"id": "coach", "count": 10}, {"id": "ep09"}]},
        {"id": "y", "vehicles": [{"id": "unit"}]},
    ]
    more = {
        "timetable": {"trains": [{"id": "7", "train": "x", **RUN}, {"id": "1", "train": "y", **RUN}]},
        "trains": trains,
        "vehicles": [
            {"id": "coach", "kind": "coach", **vehicle},
            {"id": "ep09", "kind": "locomotive", **vehicle, "drive": series},
            {"id": "unit", "kind": "multiple_unit", **vehicle, "drive": inverter},
        ],
    }
    return type(scenario).model_validate(scenario.model_dump(by_alias=True) | more)


@pytest.mark.parametrize(
    ("change", "read", "value"),
    [
        ("vehicles[ep09].mass_t=85", lambda s: s.vehicles[1].mass_t, 85.0),
        ("vehicles[ep09].drive.magnetisation[1].current_a=250", lambda s: s.vehicles[1].drive.magnetisation[1].current_a, 250.0),
        ("vehicles[unit].drive.power_kw=6000", lambda s: s.vehicles[2].drive.power_kw, 6000.0),
        ("vehicles[coach].drive=null", lambda s: s.vehicles[0].drive, None),
        ("timetable.trains[7].calls[0].departure=00:06:00", lambda s: s.timetable.trains[0].calls[0].departure, 360.0),
        ("timetable.trains[1].train=x", lambda s: s.timetable.trains[1].train, "x"),
        ("trains[x].vehicles[0].count=12", lambda s: [part.count for part in s.trains[0].vehicles], [12, 10, 1]),
        ("trains[x].vehicles[2].powered=false", lambda s: [part.powered for part in s.trains[0].vehicles], [True, True, False]),
        ("trains[x].vehicles[coach].count=12", lambda s: [part.count for part in s.trains[0].vehicles], [1, 12, 1]),
        ("trains[y].vehicles[0].load_percent=60", lambda s: s.trains[1].vehicles[0].load_percent, 60.0),
    ],
)  # fmt: skip
def test_changes_of_trains(with_trains, change, read, value):
    changed = apply_change(with_trains, change)
    assert read(changed) == value
    assert changed.input_hash != with_trains.input_hash or read(with_trains) == value


@pytest.mark.parametrize(
    ("change", "code", "path", "told"),
    [
        ("vehicles[ep09].mass_t=-85", "bad_value", "vehicles[ep09].mass_t", "greater than 0"),
        ("vehicles[ep09].drive.magnetisation[1].current_a=50", "bad_value", "vehicles[ep09].drive", "[1] does not rise"),
        ("vehicles[ep09].drive.gear_ratio=-1", "bad_value", "vehicles[ep09].drive.gear_ratio", "greater than 0"),
        ("vehicles[unit].drive.kind=steam", "bad_value", "vehicles[unit].drive", "does not match any of the expected tags"),
        ("vehicles[unit].drive.gear_ratio=2", "unknown_path", "vehicles[unit].drive.gear_ratio", "no 'gear_ratio' in"),
        ("vehicles[ep9].mass_t=85", "unknown_path", "vehicles[ep9].mass_t", "no 'ep9' in"),
        ("trains[x].vehicles[ep09].count=2", "ambiguous_path", "trains[x].vehicles[ep09].count", "2 items"),
        ("trains[x].vehicles[3].count=2", "unknown_path", "trains[x].vehicles[3].count", "no '3' in"),
        ("trains[x].vehicles[0].count=0", "bad_value", "trains[x].vehicles[0].count", "greater than or equal to 1"),
        ("timetable.trains[0].train=y", "unknown_path", "timetable.trains[0].train", "no '0' in"),  # ids are numbers here
        ("timetable.trains[7].train=null", "bad_value", "timetable.trains[7]", "either train or vehicles, found neither"),
        ("vehicles[ep09].adhesive_mass_t=90.5", "bad_value", "vehicles[ep09]", "greater than mass_t: 90.5 t and 84 t"),
    ],
)
def test_changes_of_trains_that_are_refused(with_trains, change, code, path, told):
    problem = refused(with_trains, change)
    assert (problem.code, problem.path) == (code, path)
    assert told in problem.found


def test_present_values_of_trains_change_nothing(with_trains):
    for path, value in dict(leaves(with_trains)).items():
        assert apply_change(with_trains, f"{path}={json.dumps(value)}") == with_trains, path


def test_a_mapping_or_a_list_is_json(with_trains):
    driving = apply_change(with_trains, 'timetable.trains[7].driving={"kind": "reserve", "percent": 5}').timetable.trains
    assert next(run.driving for run in driving if run.id == "7").percent == 5.0
    days = apply_change(with_trains, 'timetable.trains[7].days=["mon", "sat"]').timetable.trains
    assert next(run.days for run in days if run.id == "7") == ("mon", "sat")


@pytest.mark.parametrize("text", ["{kind: reserve}", "[1, 2", '{"percent": NaN]'])
def test_what_is_not_json_is_refused(with_trains, text):
    problem = refused(with_trains, f"timetable.trains[7].driving={text}")
    assert (problem.code, problem.path) == ("bad_change", "timetable.trains[7].driving")
    assert "is not JSON" in problem.found


@pytest.mark.parametrize(
    ("text", "value"),
    [("1", 1), ("-1.5", -1.5), (".5", 0.5), ("1e3", 1000.0), ("true", True), ("False", False), ("~", None), ("null", None),
     ("n", "n"), ("12:30", "12:30"), ('"a\\"b"', 'a"b'), ("'it''s'", "it's"), ("1_000", "1_000"), ("nan", "nan")],
)  # fmt: skip
def test_values_read_as_in_yaml(text, value):
    assert parse_scalar(text) == value
    assert type(parse_scalar(text)) is type(value)


def test_model_path_of_places_that_do_not_exist():
    assert model_path({"a": [1]}, ("a", 3, "b", 0)) == "a[3].b[0]"


@given(st.floats(0, 3.59e6))
@settings(derandomize=True, deadline=None)
def test_a_time_reads_back_as_the_same_number(seconds):
    time = round(seconds, 6)
    assert parse_time(format_time(time)) == time
    assert abs(time - seconds) < 1e-6


def test_a_star_means_every_item(scenario):
    changed = apply_change(scenario, "supply.substations[*].grid_voltage_pu=0.9")
    assert {station.grid_voltage_pu for station in changed.supply.substations} == {0.9}
    assert apply_change(scenario, "supply.loads[*].km=3").supply.loads[0].km == 3


def test_a_star_in_an_empty_list_means_nothing_and_is_told(scenario):
    with pytest.raises(InputError, match="empty"):
        apply_change(scenario, "supply.switches[*].state=open")


def test_a_plus_adds_an_item(scenario):
    change = 'supply.feeders[+]={"at": "A", "track": "1", "side": "high_km", "state": "open"}'
    changed = apply_changes(scenario, [change, change.replace("high", "low")])
    assert [row.side for row in changed.supply.feeders[-2:]] == ["high_km", "low_km"]
    assert len(scenario.supply.feeders) == len(changed.supply.feeders) - 2


def test_what_is_added_obeys_the_model(scenario):
    with pytest.raises(InputError, match="side"):
        apply_change(scenario, 'supply.feeders[+]={"at": "A", "track": "1", "side": "top"}')
    with pytest.raises(InputError, match=r"no '\+' in supply.feeders"):
        apply_change(scenario, "supply.feeders[+].state=open")


# --- paths whose beginning is missing


@pytest.mark.parametrize(
    ("change", "meant"),
    [
        ("substations[A].km=1", "supply.substations[A].km"),
        ("internal_resistance_ohm=1", "supply.substations[A].internal_resistance_ohm"),
        ("supply.internal_resistance_ohm=1", "supply.substations[A].internal_resistance_ohm"),
        ("step_s=1", "clock.step_s"),
    ],
)
def test_a_path_without_its_beginning_is_told_with_it(scenario, change, meant):
    remedy = refused(scenario, change).remedy
    assert meant in remedy
    path = remedy.removeprefix("did you mean ").removesuffix("?").split(" or ")[0]
    assert apply_change(scenario, f"{path}={change.split('=')[1]}") is not None

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
    assert "either power_kw or current_a" in problem.found


def test_later_changes_win_and_none_is_no_change(scenario):
    assert apply_changes(scenario, ["seed=2", "seed=3"]).seed == 3
    assert apply_changes(scenario, []) == scenario


@pytest.mark.parametrize(
    ("change", "found", "allowed", "remedy"),
    [
        ("supply.substation[A].km=1", "supply has no 'substation'", "substations", "'substations'"),
        ("supply.substations[a].km=1", "supply.substations has no 'a'", "A, B", "'A'"),
        ("supply.substations[0].km=1", "supply.substations has no '0'", "A, B", ""),
        ("supply.substations[A].internal_resistance=1", "no 'internal_resistance'", "id, km, ", "'internal_resistance_ohm'"),
        ("suply.system=x", "the scenario has no 'suply'", "supply", "'supply'"),
        ("supply.contact_lines[1].from_km=1", "supply.contact_lines has no '1'", "0", ""),
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

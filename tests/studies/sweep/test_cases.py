"""Grids, lists and samples."""

import itertools
import math

import numpy as np
import pytest

from tractionpower.errors import InputError, UsageError
from tractionpower.model.change import split_change
from tractionpower.studies.sweep.cases import as_cases, crossed, drawn, grid, number_of, short_names
from tractionpower.studies.sweep.cases_file import given_cases, read_cases
from tractionpower.studies.sweep.keys import Range, Varied
from tractionpower.studies.sweep.study import plan_sweep


class _Seeded:
    seed = 7


def columns(cases):
    return {path: [float(case[path]) for case in cases] for path in cases[0]}


def test_a_grid_is_the_product_of_its_values():
    found = grid([Varied("a", ("1", "2")), Varied("b", ("x", "y", "z")), Varied("c", ("0",))])
    assert [tuple(case.values()) for case in found] == list(itertools.product("12", "xyz", "0"))
    with pytest.raises(InputError, match="1000000 cases"):
        grid([Varied(name, tuple(map(str, range(100)))) for name in "abc"])


def test_a_sample_is_even_and_within_its_range():
    ranges = [Range("plain", 2.0, 4.0), Range("log", 0.01, 1.0, is_log=True), Range("whole", 1.0, 3.0, is_integer=True)]
    found = columns(drawn(ranges, 3000, seed=5))
    assert 2.0 <= min(found["plain"]) < max(found["plain"]) <= 4.0
    assert np.mean(found["plain"]) == pytest.approx(3.0, abs=0.05)
    assert np.mean(np.log10(found["log"])) == pytest.approx(-1.0, abs=0.05)
    assert {value: pytest.approx(1000, abs=120) for value in (1.0, 2.0, 3.0)} == {
        value: found["whole"].count(value) for value in (1.0, 2.0, 3.0)
    }


def test_a_sample_depends_on_its_seed_and_not_on_the_order_of_ranges():
    ranges = [Range("b", 0.0, 1.0), Range("a", 0.0, 1.0)]
    first = drawn(ranges, 20, seed=1)
    assert first == [dict(reversed(case.items())) for case in drawn(ranges[::-1], 20, seed=1)]
    assert drawn(ranges, 30, seed=1)[:20] == first
    assert drawn(ranges, 20, seed=2) != first
    assert columns(first)["a"] != columns(first)["b"]


def test_lists_are_crossed_and_a_path_in_two_of_them_is_told():
    assert crossed([{"a": "1"}, {"a": "2"}], [], [{"b": "3"}]) == [{"a": "1", "b": "3"}, {"a": "2", "b": "3"}]
    with pytest.raises(InputError, match="two ways") as raised:
        crossed([{"a": "1", "b": "1"}], [{"a": "2"}], [{"b": "3"}])
    assert [problem.path for problem in raised.value.problems] == ["a", "b"]


def test_cases_begin_with_the_base_and_can_be_repeated_by_their_changes():
    cases = as_cases([{"supply.substations[A].units": "2", "name": '"x, y"'}] * 3)
    assert [case.id for case in cases] == ["base", "01", "02", "03"]
    assert cases[0].base
    assert cases[0].changes == ()
    assert dict(map(split_change, cases[1].changes)) == {"supply.substations[A].units": "2", "name": '"x, y"'}
    assert cases[1].subject == 'A units=2, name="x, y"'


def test_short_names_tell_paths_apart():
    paths = ["supply.substations[A].units", "supply.loads[A].units", "supply.substations[a.b].km", "supply.feeders[+]"]
    short = short_names(paths)
    assert short[paths[0]] == paths[0]
    assert short[paths[2]] == "a.b km"
    assert short[paths[3]] == paths[3]
    assert len(set(short.values())) == 4


def test_numbers_of_values():
    assert [number_of(text) for text in ("2", "0.5", "true", "null", "open", '"3"', "[1]", '"')] == [2.0, 0.5, *[None] * 6]


def test_a_plan_needs_something_to_vary_and_a_sample_its_ranges():
    for told, words in (({}, "nothing to vary"), ({"sample": 3}, "needs both"), ({"ranges": [Range("a", 0, 1)]}, "needs both")):
        with pytest.raises(UsageError, match=words):
            plan_sweep(_Seeded, **told)
    plan = plan_sweep(_Seeded, [Varied("a", ("1", "2"))], ranges=[Range("b", 0.0, 1.0)], sample=4)
    assert (len(plan.cases), plan.sample, plan.seed) == (9, 4, 7)
    other = plan_sweep(_Seeded, [Varied("a", ("1", "2"))], ranges=[Range("b", 0.0, 1.0)], sample=4, seed=8)
    assert other.cases[0] == plan.cases[0]
    assert other.cases[1] != plan.cases[1]


def test_a_list_in_python_may_have_names():
    values, names = given_cases([{"case": "strong", "a": 1}, {"case": "weak", "b": None}])
    assert (values, names) == ([{"a": "1"}, {"b": "null"}], ["strong", "weak"])
    with pytest.raises(InputError) as raised:
        given_cases([{"case": "x"}, {"case": "x", "a": 1}, {"case": "base", "a": 1}])
    assert [problem.path for problem in raised.value.problems] == ["cases[1]", "cases[2]", "cases[0]"]


@pytest.mark.parametrize(
    "text",
    [
        'case,supply.substations[A].units,name\nstrong,3,\nweak,1,"x, y"\n',
        "case;supply.substations[A].units;name\nstrong;3;\nweak;1;x, y\n",
    ],
)
def test_a_file_of_cases(tmp_path, text):
    file = tmp_path / "cases.csv"
    file.write_text(text, encoding="utf-8-sig")
    path = "supply.substations[A].units"
    assert read_cases(file) == ([{path: "3"}, {path: "1", "name": "x, y"}], ["strong", "weak"])


def test_a_decimal_comma_in_a_file_with_semicolons(tmp_path):
    (tmp_path / "cases.csv").write_text("a;b\n0,5;1,2,3\n", encoding="utf-8")
    assert read_cases(tmp_path / "cases.csv") == ([{"a": "0.5", "b": "1,2,3"}], [])


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("", ["empty_file"]),
        ("case\nx\n", ["no_path", "no_change"]),
        ("a\n", ["no_cases"]),
        ("a,a\n1,2\n3\n", ["duplicate_column", "ragged_row"]),
        ("case,a,b\nx,1,\nx,2,\nbase,3,\n,4,\ny,,\n", ["bad_name"] * 3 + ["no_change"]),
        ("a,b\n0,5,1\n", ["ragged_row"]),
    ],
)
def test_all_that_is_wrong_with_a_file_is_told_with_its_line(tmp_path, text, codes):
    file = tmp_path / "cases.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as raised:
        read_cases(file)
    assert [problem.code for problem in raised.value.problems] == codes
    assert all(problem.place.startswith(str(file)) for problem in raised.value.problems)


def test_values_are_told_with_six_digits():
    values = [float(case["a"]) for case in drawn([Range("a", 1.0, math.e)], 50, 1)]
    assert all(float(f"{value:.6g}") == value for value in values)

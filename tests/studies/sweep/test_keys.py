"""What is varied, as it is written."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_studies import load, make_scenario

from tractionpower.errors import InputError, UsageError
from tractionpower.io.library import change
from tractionpower.model.change import parse_scalar
from tractionpower.studies.sweep.keys import Varied, parse_ranges, parse_varied, range_of, split_values, text_of, varied_of


def told(call, *arguments):
    with pytest.raises(InputError) as raised:
        call(*arguments)
    return [(problem.path, problem.found) for problem in raised.value.problems]


def test_values_are_split_at_commas_outside_brackets_and_quotes():
    assert parse_varied(["supply.loads[a,b].power_kw=1, 2,3"]) == (Varied("supply.loads[a,b].power_kw", ("1", "2", "3")),)
    assert split_values('{"kind": "to_time", "x": [1, 2]},flat_out') == ['{"kind": "to_time", "x": [1, 2]}', "flat_out"]
    assert split_values("\"a, b\",'c, d',o'clock,x") == ['"a, b"', "'c, d'", "o'clock", "x"]
    assert split_values(r'"say \", or not",2') == [r'"say \", or not"', "2"]


ITEMS = st.one_of(st.integers(), st.none(), st.booleans(), st.text())


@given(st.lists(ITEMS | st.lists(ITEMS) | st.dictionaries(st.text(), ITEMS), min_size=1))
def test_values_written_as_json_are_split_again(values):
    texts = [json.dumps(value) for value in values]
    assert split_values(", ".join(texts)) == texts


def test_all_that_cannot_be_read_is_told_at_once():
    problems = told(parse_varied, ["a", "b=", "c=1,,2", "d=1,1", "e=1", "e=2"])
    assert [path for path, _ in problems] == ["a", "b", "c", "d", "e"]
    problems = told(parse_ranges, ["a=3", "b=2..1", "c=x..1", "d=log:0..1", "e=1..2", "e=1..2", "f=true..2", "g"])
    assert [path for path, _ in problems] == ["a", "b", "c", "d", "f", "g", "e"]


@pytest.mark.parametrize(
    "value", [2, 0.1, 1e-12, None, True, "bypassed", "3", "null", " blank ", "", "[x", "a, b", "'q'", [1, "x"]]
)
def test_a_value_of_python_comes_back_from_its_text(value):
    scenario = make_scenario(load("tap"), name="base")
    text = text_of(value)
    if isinstance(value, str):
        assert change(scenario, [f"name={text}"]).name == value
    elif not isinstance(value, list):
        assert parse_scalar(text) == value
    assert varied_of({"name": [value]})[0].values == (text,)


def test_values_of_numpy_are_numbers():
    assert text_of(np.float64(0.25)) == "0.25"
    assert text_of(np.int32(3)) == "3"
    with pytest.raises(UsageError, match="nan"):
        text_of(float("nan"))


def test_single_values_and_repeated_ones_are_told():
    assert [path for path, _ in told(varied_of, {"a": "bypassed", "b": [], "c": [1, 1], "d": [1]})] == ["a", "b", "c"]


def test_ranges_know_whole_numbers_and_logarithms():
    whole, plain, log = parse_ranges(["a=1..4", "b=1..4.5", "c=log:1e-3..0.1"])
    assert whole.is_integer
    assert not plain.is_integer
    assert (log.low, log.high, log.is_log, log.is_integer) == (0.001, 0.1, True, False)
    assert range_of("c", (0.001, 0.1, "log")) == log == range_of("c", "log:0.001..0.1")
    with pytest.raises(UsageError, match="'exp'"):
        range_of("c", (1, 2, "exp"))

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from fake_cases import measure_and_note, measure_load
from small_studies import load, make_scenario

from tractionpower.model.scenario import Clock
from tractionpower.studies.runner.identity import key_of, program, work_identity

SCENARIO = make_scenario(load("depot"))


def test_the_name_and_the_arguments_of_work_tell_it_apart():
    works = [
        measure_load,
        measure_and_note,
        partial(measure_load, rows=3),
        partial(measure_load, rows=4),
        partial(measure_load, clock=Clock(start=0.0, end=1.0)),
        partial(measure_and_note, folder=Path("a")),
    ]
    assert len({work_identity(work) for work in works}) == len(works)
    assert work_identity(partial(measure_load, rows=3, a=1)) == work_identity(partial(measure_load, a=1, rows=3))
    assert work_identity(measure_load) == "fake_cases.measure_load"


def test_an_argument_that_cannot_be_told_apart_is_refused():
    with pytest.raises(TypeError, match="no plain value"):
        work_identity(partial(measure_load, rows=np.arange(3)))


def test_the_key_hangs_on_program_work_and_inputs(monkeypatch):
    key = key_of(SCENARIO, "a")
    assert key == key_of(make_scenario(load("depot")), "a")
    other = make_scenario(load("depot", km=6.0))
    assert len({key, key_of(SCENARIO, "b"), key_of(other, "a")}) == 3
    monkeypatch.setattr("tractionpower.studies.runner.identity.program", lambda: program() | {"numpy": "0"})
    assert key_of(SCENARIO, "a") != key

"""Changes by options of a command: refused as files are refused, told at the option, and remembered as what a value came from."""

import pytest

from tractionpower.errors import InputError, Problem
from tractionpower.io.changes import Change, changed, changes_of
from tractionpower.io.dynamics_files import load_case
from tractionpower.io.provenance import Mark, Provenance


@pytest.fixture(scope="module")
def loaded():
    return load_case("emergency-stop")


def refused(scenario, *changes, root=""):
    with pytest.raises(InputError) as caught:
        changed(scenario, changes, root=root)
    return caught.value.problems


def test_a_value_is_refused_in_the_words_of_files(loaded):
    step = Change("case.run.step_s", "0", "--step-s")
    method = Change("case.run.method", "simplectic", "--method")
    first, second = refused(loaded.scenario, step, method)
    assert first == Problem("out_of_bounds", "case.run.step_s", "0", "a number [s] above 0 and at most 10", place="--step-s")
    assert (second.path, second.found, second.place) == ("case.run.method", "'simplectic'", "--method")
    assert (second.allowed, second.remedy) == ("symplectic | rk4 | euler | variable", "did you mean symplectic?")


def test_a_wrong_path_is_told_at_its_option(loaded):
    first, second = refused(loaded.scenario, *changes_of(["start.speed_kmh=30"]), Change("case.run.steps", "1", "--steps"))
    assert (first.place, first.remedy) == ("--set", "did you mean case.start.speed_kmh?")
    assert (second.place, second.remedy) == ("--steps", "did you mean 'step_s'?")


def test_what_is_no_change_is_told_at_the_option_too():
    with pytest.raises(InputError) as caught:
        changes_of(["case.name", "case.name=x", "=3"])
    assert [problem.place for problem in caught.value.problems] == ["--set", "--set"]


def test_stations_are_changed_with_the_beginning_of_their_messages_and_without():
    loaded = load_case("traindyn-three-stations")
    for path in ("case.run.period_s", "run.period_s"):
        other = loaded.changed([Change(path, "0.5", "--set")])
        assert other.scenario.run.period_s == 0.5
        assert other.provenance.locate("case.run.period_s") == "--set"
    (problem,) = refused(loaded.scenario, Change("traffic.trains", "0", "--set"), root="case")
    assert (problem.path, problem.place) == ("case.traffic.trains", "--set")


def test_an_overridden_value_comes_from_the_option_and_its_neighbours_from_the_file(loaded):
    other = loaded.changed([Change("case.run.step_s", "0.004", "--step-s")])
    assert other.provenance.locate("case.run.step_s") == "--step-s"
    assert other.provenance.locate("case.run.duration_s").startswith("case.yaml:")
    assert loaded.provenance.locate("case.run.step_s") != "--step-s"


@pytest.mark.parametrize(
    ("path", "asked", "place"),
    [
        ("rows[b].x", "rows[b].x", "--o"),
        ("rows[b].x", "rows[a].x", "f:2"),
        ("rows[1].x", "rows[b].x", "--o"),
        ("rows[*].x", "rows[a].x", "--o"),
        ("rows[b]", "rows[b].x", "--o"),
        ("rows[b].y.z", "rows[b].y.z", "--o"),
        ("rows[b].y.z", "rows[b].y", "f:3"),
    ],
)
def test_paths_are_overlaid(path, asked, place):
    rows = Mark("f", 1, {0: Mark("f", 2), 1: Mark("f", 3)}, {"a": 0, "b": 1})
    provenance = Provenance(Mark("f", 0, {"rows": rows}))
    assert provenance.overlaid([(path, "--o")]).locate(asked) == place
    assert provenance.locate(asked).startswith("f:")

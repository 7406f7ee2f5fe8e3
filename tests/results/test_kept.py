"""What was computed is kept with its results, each kind as what it is."""

import hashlib

import pytest
from fake_dynamics import fake_scenario
from small_studies import make_scenario

from tractionpower.errors import UsageError
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.scenario import Scenario
from tractionpower.results.kept import SCENARIO_FILE, canonical_json, input_hash_of, read_scenario_file
from tractionpower.results.store import RunWriter


def test_the_hash_is_that_of_the_text_that_is_kept(tmp_path):
    writer = RunWriter(tmp_path / "run", "fake", input_hash_of(fake_scenario()), kind="dynamics", scenario=fake_scenario())
    text = (writer.running / SCENARIO_FILE).read_bytes()
    assert hashlib.sha256(text).hexdigest() == input_hash_of(fake_scenario())
    assert input_hash_of(make_scenario()) == make_scenario().input_hash


@pytest.mark.parametrize(
    ("kind", "made", "model"),
    [("", make_scenario(), Scenario), ("size", make_scenario(), Scenario), ("dynamics", fake_scenario(), DynamicsScenario)],
)
def test_the_kind_says_what_it_is(tmp_path, kind, made, model):
    path = tmp_path / SCENARIO_FILE
    path.write_text(canonical_json(made), encoding="utf-8")
    read = read_scenario_file(path, kind)
    assert type(read) is model
    assert read == made


def test_what_this_version_does_not_understand_is_refused(tmp_path):
    path = tmp_path / SCENARIO_FILE
    path.write_text(canonical_json(make_scenario()), encoding="utf-8")
    with pytest.raises(UsageError, match="not a scenario of this version"):
        read_scenario_file(path, "dynamics")
    with pytest.raises(UsageError, match="not a scenario of this version"):
        read_scenario_file(tmp_path / "missing.json")

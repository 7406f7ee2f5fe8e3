"""What notebooks and scripts use: the public names, and the example of the README."""

import re
from pathlib import Path

import pandas as pd
import pytest

import tractionpower as tp

README = Path(__file__).parents[1] / "README.md"
NAMES = [
    "DynTrain", "InputError", "OutputError", "Polyline", "Problem", "Results", "Scenario", "Selection", "TractionPowerError",
    "TrainCharacteristics", "TrainDynamics", "UsageError", "change", "check", "compare", "contingency", "feasibility", "journeys",
    "load", "load_case", "save", "select", "simulate",
    "simulate_case", "size", "sweep",
]  # fmt: skip


def test_the_public_names():
    assert tp.__all__ == NAMES
    assert dir(tp) == NAMES
    for name in NAMES:
        assert getattr(tp, name).__doc__, name
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        tp.simulat  # noqa: B018


def test_all_errors_are_of_one_family():
    assert all(issubclass(error, tp.TractionPowerError) for error in (tp.InputError, tp.OutputError, tp.UsageError))


def test_load_change_check_simulate_save(tmp_path):
    scenario = tp.load("two-substations")
    assert isinstance(scenario, tp.Scenario)
    assert tp.check(scenario) == []
    changed = tp.change(scenario, ["supply.section_cabins[C].state=bypassed", "clock.end=00:01:00"])
    tp.save(changed, tmp_path / "study")
    assert tp.load(tmp_path / "study") == changed

    told = []
    memory = tp.simulate(changed)
    disk = tp.simulate(changed, tmp_path / "out", progress=lambda done, total: told.append(done))
    assert told[-1] == disk.run["steps"] == 60
    assert memory.tables == disk.tables
    for name in memory.tables:
        assert isinstance(memory.table(name), pd.DataFrame)
        pd.testing.assert_frame_equal(memory.table(name), disk.table(name))
    assert memory.key_figures == disk.key_figures
    assert memory.run["input_hash"] == disk.run["input_hash"] == changed.input_hash
    pd.testing.assert_frame_equal(tp.Results.open(tmp_path / "out").table("trains"), disk.table("trains"))
    assert memory.key_figure("lowest_voltage_v") > 2000.0


def test_a_scenario_with_errors_is_not_simulated_and_leaves_nothing(tmp_path):
    wrong = tp.change(tp.load("two-substations"), ["supply.substations[A].km=-1"])
    assert tp.check(wrong)
    for folder in (None, tmp_path / "deep" / "out"):
        with pytest.raises(tp.InputError, match=r"supply.substations"):
            tp.simulate(wrong, folder)
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_simulation_keeps_its_parts(tmp_path):
    def interrupt(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tp.simulate(tp.load("two-substations"), tmp_path / "out", progress=interrupt)
    (note,) = (tmp_path / "out").glob(".running/*/run.json")
    assert '"interrupted"' in note.read_text(encoding="utf-8")


def test_an_interrupted_feasibility_study_keeps_its_parts(tmp_path):
    def interrupt(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tp.feasibility(tp.load("y-junction"), tmp_path / "out", progress=interrupt)
    partial = tp.Results.open(tmp_path / "out", partial=True)
    assert partial.run["status"] == "interrupted"
    assert partial.run["steps"] > 0
    assert "feasibility" not in partial.run


def test_the_examples_of_the_readme_run(tmp_path, monkeypatch):
    blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert blocks, "README.md shows no ```python block"
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, str(README), "exec"), names)
    assert any(isinstance(value, tp.Results) for value in names.values())

"""The page of TrainDyn: its example runs, and the tests that it names exist."""

import re
from pathlib import Path

import pytest
from point_trains import add, characteristics, run_to

from tractionpower.dynamics.traindyn.core import TrainDynamics

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "dynamics-traindyn.md"


def test_the_example_runs(capsys):
    (block,) = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    names = {}
    exec(compile(block, str(PAGE), "exec"), names)
    assert capsys.readouterr().out.startswith("IC 1 stands at 5000.0 m since 2")
    assert names["core"].trains == ()
    assert names["env"].now == 600.0


def test_the_tests_that_it_names_exist():
    named = set(re.findall(r"`(test_\w+)(?:\.py)?`", PAGE.read_text(encoding="utf-8")))
    files = [*(ROOT / "tests").rglob("test_*.py")]
    known = {path.stem for path in files}
    for path in files:
        known.update(re.findall(r"def (test_\w+)", path.read_text(encoding="utf-8")))
    assert len(named) > 3
    assert named <= known, named - known


@pytest.mark.parametrize(("method", "seconds"), [("euler", 116.8), ("fine", 117.0)])
def test_the_running_times_that_it_tells(method, seconds):
    core = TrainDynamics(method=method)
    train = add(core, characteristics(resistance={"a_n_per_kn": 1.6, "c_n_per_kn_per_kmh2": 0.00044}))
    train.accelerate(speed_kmh=80.0)
    train.stop(at_m=1500.0)
    run_to(core, 200.0)
    assert train.stood_since_s == pytest.approx(seconds, abs=0.05)


def test_sine_and_tangent_of_its_steepest_gradient():
    tangent = 0.040
    assert 1.0 - 1.0 / (1.0 + tangent**2) ** 0.5 == pytest.approx(0.0008, abs=5e-6)

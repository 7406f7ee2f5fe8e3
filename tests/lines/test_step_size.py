"""The shipped lines at the default step against a twentieth of it: the step does not decide what a run finds."""

from pathlib import Path

import pytest
from small_studies import run_in_memory

import tractionpower

LINES = Path(__file__).parents[2] / "lines"
FINE_S = 0.05
SPANS = {
    "two-substations": ("00:00:00", "00:10:00"),
    "cmk": ("07:00:00", "08:00:00"),  # an hour of the morning peak
    "y-junction": ("06:00:00", "07:10:00"),
}
HIGHEST = {"running_time_s": 1e-3, "journey_time_s": 1e-3, "energy_taken_kwh": 2e-3}
"""Greatest difference as a share of the value."""
VOLTS = {"lowest_10_s_mean_voltage_v": 5.0, "lowest_pantograph_voltage_v": 25.0}
"""Greatest difference of voltages [V]: lowest mean over 10 s, lowest sample."""


def in_steps_of(line, step_s):
    scenario = tractionpower.load(LINES / line)
    start, end = SPANS[line]
    plain = scenario.model_dump(mode="json", by_alias=True)
    plain["clock"] = {"start": start, "end": end, "step_s": step_s}
    plain["output"] = {"tables": []}
    results, outcome, _ = run_in_memory(type(scenario).model_validate(plain))
    assert outcome.run["status"] == "complete"
    return results


@pytest.fixture(scope="module", params=SPANS)
def both(request):
    return in_steps_of(request.param, 1.0), in_steps_of(request.param, FINE_S)


def pairs(both, name):
    """Yield place, value in steps of 1 s and value in short steps of every train's figure."""
    coarse, fine = ({each["place"]: each["value"] for each in run.key_figures if each["name"] == name} for run in both)
    assert set(coarse) == set(fine)
    assert len(coarse) >= 4
    for place, value in fine.items():
        yield place, coarse[place], value


@pytest.mark.parametrize("name", HIGHEST)
def test_times_and_energies_of_every_train(both, name):
    for place, coarse, fine in pairs(both, name):
        assert coarse == pytest.approx(fine, rel=HIGHEST[name], abs=1e-6), place


@pytest.mark.parametrize("name", VOLTS)
def test_lowest_voltages_of_every_train(both, name):
    for place, coarse, fine in pairs(both, name):
        assert abs(coarse - fine) < VOLTS[name], place


def test_energies_of_the_run(both):
    coarse, fine = (run.run["ledgers"]["electric"] for run in both)
    for name in ("source_kwh", "train_kwh"):
        assert coarse[name] == pytest.approx(fine[name], rel=1e-3)
    assert coarse["conductor_kwh"] == pytest.approx(fine["conductor_kwh"], rel=5e-3)  # means of squares of fewer steps


def test_trains_are_at_the_same_stations(both):
    coarse, fine = ({each["train"]: each["status"] for each in run.run["trains"]} for run in both)
    assert coarse == fine
    assert list(fine.values()).count("left") >= 4

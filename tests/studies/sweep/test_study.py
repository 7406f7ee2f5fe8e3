"""A sweep as a whole: the same figures as single runs, resumed, told when it cannot run."""

import pandas as pd
import pytest
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.errors import InputError, UsageError
from tractionpower.io.library import change
from tractionpower.results.results import Results
from tractionpower.studies.runner.store import CaseStore
from tractionpower.studies.sweep import study as module
from tractionpower.studies.sweep.study import sweep

SCENARIO = make_scenario(load("tap", 4.0), load("depot", 14.0, "2"), name="taps", seed=3)
R, STATE = "supply.substations[A].internal_resistance_ohm", "supply.section_cabins[C].state"


@pytest.fixture(scope="module")
def results():
    return sweep(SCENARIO, {R: [0.06, 0.12, 0.3], STATE: ["closed", "open", "sideways"]})


def test_each_case_is_the_run_with_its_changes(results):
    cases = results.table("cases").set_index("case")
    changes = results.table("case_changes").astype(str).groupby("case")
    assert list(cases.index) == ["base", *(f"0{k}" for k in range(1, 10))]
    for name, row in cases[cases["status"] == "complete"].iterrows():
        told = changes.get_group(name) if name != "base" else pd.DataFrame(columns=["path", "value"])
        own = simulate(change(SCENARIO, [f"{path}={value}" for path, value in zip(told["path"], told["value"], strict=True)]))
        assert row["lowest_voltage_v"] == pytest.approx(own.key_figure("lowest_voltage_v"), abs=1e-3)  # float32 in tables
        energy = sum(own.key_figure("energy_kwh", f"substation {one}") for one in "AB")
        assert row["energy_kwh"] == pytest.approx(energy, rel=1e-9)


def test_refused_values_are_rows_with_their_reason_and_equal_inputs_are_told(results):
    cases = results.table("cases").set_index("case").astype({"reason": str, "status": str})
    assert list(cases.index[cases["status"] == "refused"]) == ["03", "06", "09"]
    assert cases.loc["03", "reason"].startswith(f"{STATE}: 'sideways'")
    assert cases.loc["04", "reason"] == "same inputs as case base"
    assert results.run["status"] == "complete"
    assert results.run["cases"] == {"all": 10, "complete": 7, "flagged": 0, "refused": 3, "failed": 0, "reused": 0}


def test_differences_are_those_of_the_cases(results):
    cases = results.table("cases").set_index("case")
    for row in results.table("differences").to_dict("records"):
        base, value = (float(cases.loc[case, row["figure"]]) for case in ("base", row["case"]))
        assert row["difference"] == pytest.approx(value - base, abs=2e-4 * max(1.0, abs(base) * 1e-3))
    same = results.table("differences")
    assert (same[same["case"] == "04"]["difference"] == 0.0).all()


def test_the_note_has_keys_and_extremes(results):
    note = results.run["sweep"]
    assert results.run["kind"] == "sweep"
    assert note["keys"] == {R: ["0.06", "0.12", "0.3"], STATE: ["closed", "open", "sideways"]}
    low = results.table("cases")["lowest_voltage_v"]
    assert note["extremes"]["lowest_voltage_v"]["worst"]["value"] == pytest.approx(low.min(), abs=1e-3)
    assert note["sample"] is None


def test_a_sample_is_repeated_by_its_seed():
    def ask(**how):
        found = sweep(SCENARIO, sample=4, ranges={R: (0.05, 0.3, "log")}, **how)
        return list(found.table("case_changes")["value"]), found.run["sweep"]["sample"]

    first, note = ask()
    assert note == {"count": 4, "seed": 3}
    assert ask()[0] == first
    assert ask(seed=4)[0] != first


def test_a_folder_and_whole_results_of_each_case(tmp_path):
    study = module.SweepStudy(SCENARIO, module.plan_sweep(SCENARIO, module.varied_of({R: [0.06]})), study="taps")
    writer = module.RunWriter(tmp_path / "out", "taps", SCENARIO.input_hash, scenario=SCENARIO)
    outcome = module.run_into(study, writer, full_tables=tmp_path / "whole")
    assert outcome.run["cases"]["complete"] == 2
    assert Results.open(tmp_path / "out").row_count("cases") == 2
    assert {"base", "01"} == {path.name for path in (tmp_path / "whole").iterdir()}
    assert "substations" in Results.open(tmp_path / "whole" / "01").tables


def test_what_was_interrupted_goes_on_and_runs_nothing_twice(tmp_path, monkeypatch):
    measured = []
    real = module.measure

    def counted(scenario):
        measured.append(scenario.input_hash)
        if len(measured) == 3:
            raise KeyboardInterrupt
        return real(scenario)

    counted.__qualname__, counted.__module__ = real.__qualname__, real.__module__
    monkeypatch.setattr(module, "measure", counted)
    vary = {R: [0.05, 0.06, 0.07, 0.08]}
    with pytest.raises(KeyboardInterrupt):
        sweep(SCENARIO, vary, folder=tmp_path / "out")
    assert len(measured) == 3
    partial = Results.open(tmp_path / "out", partial=True)
    assert partial.run["status"] == "interrupted"
    assert partial.row_count("cases") == 2
    results = sweep(SCENARIO, vary, folder=tmp_path / "out")
    assert results.run["cases"]["reused"] == 2
    assert results.row_count("cases") == 5
    assert len(measured) == 6
    whole = sweep(SCENARIO, vary)
    pd.testing.assert_frame_equal(whole.table("cases"), results.table("cases"))


def test_a_base_with_errors_and_wrong_paths_leave_nothing(tmp_path):
    wrong = change(SCENARIO, ["supply.substations[A].km=-50"])
    with pytest.raises(InputError):
        sweep(wrong, {R: [0.1]}, folder=tmp_path / "out")
    with pytest.raises(InputError, match="did you mean 'internal_resistance_ohm'"):
        sweep(SCENARIO, {"supply.substations[A].internal_resistance": [0.1]}, folder=tmp_path / "out")
    with pytest.raises(UsageError, match="nothing to vary"):
        sweep(SCENARIO, folder=tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_trains_of_a_case_know_what_was_added_to_their_lateness(tmp_path):
    from tractionpower.io.scenario_files import load as load_study  # noqa: PLC0415

    scenario = change(load_study("two-substations"), ["clock.end=00:10:00"])
    results = sweep(scenario, {"supply.substations[A].no_load_voltage_v": [3300]})
    trains = results.table("case_trains")
    assert set(trains["case"]) == {"base", "01"}
    base = trains[trains["case"] == "base"]
    assert (base["added_late_s"].isna() | (base["added_late_s"] == 0.0)).all()
    assert CaseStore().folder is None


def test_a_variant_of_a_limit_is_judged_by_its_own_limit():
    plants = [{"id": name, "km": km, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12, "rated_current_a": 1000.0}
              for name, km in (("A", 0.0), ("B", 20.0))]  # fmt: skip
    scenario = make_scenario(load("tap", 4.0), substations=plants)
    used = float(sweep(scenario, {R: [0.12]}).table("cases")["utilisation_percent"].iloc[0])
    assert 50.0 < used < 100.0
    low, high = round(used - 10.0), round(used + 10.0)
    results = sweep(scenario, {"sizing.utilisation_percent": [low, high]})
    cases = results.table("cases").set_index("case").astype({"fails": str})
    assert dict(cases["fails"]) == {"base": "", "01": "overload", "02": ""}
    told = next(each for each in results.run["verdicts"] if each["name"] == "utilisation of devices")
    assert (told["met"], told["limit_value"], told["place"]) == (False, low, "01: A unit")
    generous = sweep(change(scenario, [f"sizing.utilisation_percent={low}"]), {"sizing.utilisation_percent": [high]})
    told = next(each for each in generous.run["verdicts"] if each["name"] == "utilisation of devices")
    assert (told["met"], told["limit_value"], told["place"]) == (False, low, "base: A unit")
    assert list(generous.table("cases").astype({"fails": str})["fails"]) == ["overload", ""]

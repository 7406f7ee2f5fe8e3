"""The recorder of useful voltages against the rows that a run writes, its key figures, and laws."""

import numpy as np
import pytest
from coupled import couple, run

from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.cosimulation.run import Run
from tractionpower.cosimulation.useful_voltage_recorder import UsefulVoltageRecorder
from tractionpower.model.sizing import Sizing
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter

RUNS = (run("E"), run("F", "series_motors", track="2", low=20.0, high=0.0, time=100.0), run("G", "table", low=4.0, time=200.0))
PLANTS = [
    {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1} for name, km in (("X", 2.0), ("Z", 17.0))
]


def asking(scenario, warm_up=None, **useful_voltage):
    sizing = Sizing.model_validate({"useful_voltage": useful_voltage})
    return scenario.model_copy(update={"sizing": sizing, "clock": scenario.clock.model_copy(update={"warm_up": warm_up})})


def recorded(scenario, **how):
    """Return recorder and results of one run."""
    memory = MemoryWriter()
    whole = Run(scenario, memory)
    recorder = UsefulVoltageRecorder(scenario, whole.compiled.movement, **how)
    whole.recorder.watches.append(recorder)
    outcome = whole.execute()
    return recorder, Results(outcome.run, outcome.key_figures, memory.tables(), scenario)


@pytest.fixture(scope="module")
def three():
    scenario = couple(*RUNS, substations=PLANTS, end_s=900.0)
    return recorded(asking(scenario, warm_up=120.0, windows=[{"from": "00:05", "to": "00:10"}], shortest_stay_s=100.0))


def test_zones_against_the_rows_of_the_trains(three):
    recorder, results = three
    rows = results.table("trains")
    rows = rows[rows["time_s"] >= 120.0]
    edges = {"X low_km": (0.0, 2.0), "X–Z": (2.0, 17.0), "Z high_km": (17.0, 20.001)}
    found = recorder.useful_voltage().to_pandas()
    left_out = 0
    for window, (begin, end) in {"run": (120.0, 900.0), "given": (300.0, 600.0)}.items():
        for zone, (low, high) in edges.items():
            at = rows["position_km"]
            mine = rows[(rows["time_s"] >= begin) & (rows["time_s"] < end) & (at >= low) & (at < high)]
            stays = mine.groupby("train", observed=True).size()
            kept = mine[mine["train"].isin(stays[stays >= 100.0].index)]
            row = found[(found["subject"] == zone) & (found["window"] == window)]
            if not len(row):
                assert not len(mine)
                continue
            row = row.iloc[0]
            assert (row["trains"], row["left_out"]) == ((stays >= 100).sum(), (stays < 100).sum())
            left_out += row["left_out"]
            charge = kept["current_a"].abs() / stays.loc[kept["train"]].to_numpy()
            if len(kept):
                assert row["current_weighted_v"] == pytest.approx((kept["voltage_v"] * charge).sum() / charge.sum(), rel=1e-6)
                assert row["time_mean_v"] == pytest.approx(kept["voltage_v"].mean(), rel=1e-6)
            else:
                assert np.isnan(row["current_weighted_v"])
                assert row["met"] == ""
    assert left_out > 0


def test_trains_are_those_of_the_run_and_the_dimensioning_one_is_the_lowest(three):
    recorder, results = three
    found = recorder.useful_voltage().to_pandas()
    mine = found[(found["kind"] == "train") & (found["window"] == "run")].set_index("subject")
    figures = {f["place"]: f["value"] for f in results.key_figures if f["name"] == "mean_useful_voltage_current_weighted_v"}
    assert set(mine.index) == {"E", "F", "G"}
    for name, volts in mine["current_weighted_v"].items():
        assert volts == pytest.approx(figures[f"train {name}"], rel=1e-6)
    lowest = recorder.lowest("train")
    assert lowest.subject == mine["current_weighted_v"].idxmin()
    assert lowest.value_v == pytest.approx(mine["current_weighted_v"].min())
    assert (mine["limit_v"] == 2700.0).all()
    assert (mine["met"] == "yes").all()


def test_the_means_follow_from_the_sums_in_the_table(three):
    found = three[0].useful_voltage().to_pandas()
    weighted = 1000.0 * found["power_sum_kw"] / found["current_sum_a"].where(found["current_sum_a"] > 0.0)
    mean = found["voltage_time_vs"] / found["counted_s"].where(found["counted_s"] > 0.0)
    for quotient, name in ((weighted, "current_weighted_v"), (mean, "time_mean_v")):
        assert (quotient.isna() == found[name].isna()).all()
        np.testing.assert_allclose(quotient.dropna(), found[name].dropna(), rtol=1e-7)
    assert len(weighted.dropna()) > 3


def test_without_a_shortest_stay_zones_are_those_of_the_key_figures():
    recorder, results = recorded(asking(couple(*RUNS, end_s=900.0), shortest_stay_s=0.0), whole_run_only=True)
    (means,) = recorder.means()
    for name, volts in (("current_weighted", means.zones.current_weighted_v), ("time_mean", means.zones.time_mean_v)):
        assert volts[0] == pytest.approx(results.key_figure(f"mean_useful_voltage_{name}_v", "zone A–B"), rel=1e-14)


def test_durations_are_those_of_the_rows(three):
    recorder, results = three
    rows = results.table("trains")
    rows = rows[rows["time_s"] >= 120.0]
    frame = recorder.voltage_durations().to_pandas()
    for name, mine in rows.groupby("train", observed=True):
        own = frame[frame["train"] == name].set_index("band")["total_s"]
        assert own.sum() == len(mine)
        assert own["U_n to U_max1"] == ((mine["voltage_v"] >= 3000.0) & (mine["voltage_v"] <= 3600.1)).sum()
    assert frame[frame["train"] == ""]["total_s"].sum() == len(rows)


def test_blocks_of_steps_do_not_matter(monkeypatch):
    scenario = asking(couple(*RUNS, end_s=400.0), windows=[{"from": 90.0, "to": 200.0}])
    tables = []
    for block in (7, 400):
        monkeypatch.setattr("tractionpower.cosimulation.quiet.STEPS", block)
        quiet = QuietRun(scenario)
        recorder = UsefulVoltageRecorder(scenario, quiet.movement)
        quiet.watches.append(recorder)
        quiet.execute()
        tables.append((recorder.useful_voltage(), recorder.voltage_durations()))
    assert tables[0][0].equals(tables[1][0])
    assert tables[0][1].equals(tables[1][1])


def test_the_class_of_the_line_chooses_the_limit_of_the_recorder_and_of_the_verdicts():
    recorder, results = recorded(asking(couple(run("E"), end_s=60.0), line_class="high_speed"))
    assert recorder.limit.value == 2800.0
    assert set(recorder.useful_voltage().to_pandas()["limit_v"]) == {2800.0}
    verdicts = [verdict for verdict in results.run["verdicts"] if verdict["name"].startswith("mean useful voltage")]
    assert verdicts
    assert {verdict["limit_value"] for verdict in verdicts} == {2800.0}


def test_a_study_without_trains_has_zones_without_values():
    recorder, _ = recorded(couple(end_s=30.0))
    frame = recorder.useful_voltage().to_pandas()
    assert frame["subject"].tolist() == ["A–B"]
    assert frame["met"].tolist() == [""]
    assert recorder.voltage_durations().num_rows == 0
    assert recorder.lowest("zone").subject == ""

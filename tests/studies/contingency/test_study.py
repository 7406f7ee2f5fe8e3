"""The study of outages as a whole: its tables against those of the cases, what it says, and that it goes on where it stopped."""

import numpy as np
import pytest
from coupled import couple, run

import tractionpower
from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.model.contingency import Contingency
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.study import OutageStudy, contingency
from tractionpower.studies.runner.into_folder import run_into

LEAKY = [{"from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.02, "leakage_s_per_km": 0.1}]


def scenario_of(**wish):
    """Return two trains on a weak line, one of which has little time, and substations with rated units."""
    plants = [
        {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.3, "units": 2, "rated_current_a": 400.0}
        for name, km in (("A", 0.0), ("B", 20.0))
    ]
    runs = [
        run("x", calls=[{"station": "B", "arrival": 655.0}]),
        run("y", "series_motors", "2", 20.0, 0.0, time=60.0, calls=[{"station": "A", "arrival": 1000.0}]),
    ]
    made = couple(*runs, end_s=1100.0, step_s=2.0, substations=plants, return_circuit=LEAKY)
    kinds = {"kinds": ["unit", "substation", "section_cabin"], "grid_voltages": ["normal", "low"]}
    return made.model_copy(update={"contingency": Contingency.model_validate(kinds | wish)})


@pytest.fixture(scope="module")
def scenario():
    return scenario_of()


@pytest.fixture(scope="module")
def results(scenario):
    return contingency(scenario)


def frames(results, table):
    """Return the rows of a table by case, texts as plain texts."""
    rows = results.table(table)
    texts = [name for name in rows if rows[name].dtype == "category"]
    return rows.astype(dict.fromkeys(texts, str))


def test_rows_are_what_is_measured_of_the_changed_inputs(scenario, results):
    cases = frames(results, "cases").set_index("case")
    assert list(cases.index[:3]) == ["base", "base, grid low", "A unit 1 of 2 in service"]
    study = OutageStudy(scenario)
    for case in study.cases[1:5]:
        figures = measure(apply_changes(scenario, case.changes)).figures
        for name in ("lowest_voltage_v", "useful_zone_v", "utilisation_percent", "worst_late_s", "energy_kwh"):
            assert cases.loc[case.id, name] == pytest.approx(figures[name], rel=1e-6), (case.id, name)


def test_the_changes_of_each_case_are_told(scenario, results):
    changes = frames(results, "case_changes")
    for case in OutageStudy(scenario).cases:
        mine = changes[changes["case"] == case.id]
        assert tuple(f"{path}={value}" for path, value in zip(mine["path"], mine["value"], strict=True)) == case.changes


@pytest.mark.parametrize(("quantity", "table"), [("voltage", "case_profile"), ("rail_potential", "case_rails")])
def test_the_envelope_is_the_worst_of_all_cases(results, quantity, table):
    cases, envelope = frames(results, table), frames(results, "envelope").query("quantity == @quantity")
    if quantity == "voltage":
        cases["value"] = cases["lowest_voltage_v"]
        worst = cases.groupby(["track", "km"])["value"].min()
    else:
        cases["value"] = np.maximum(cases["lowest_potential_v"].abs(), cases["highest_potential_v"].abs())
        worst = cases.groupby(["track", "km"])["value"].max()
    found = envelope.set_index(["track", "km"])
    assert list(found.index) == list(worst.index)
    np.testing.assert_array_equal(found["worst_v"], worst)
    by_case = cases.set_index(["case", "track", "km"])["value"]
    assert all(by_case[row.case, row.track, row.km] == row.worst_v for row in envelope.itertuples())
    base = by_case["base"]
    assert all(row.base_v == base[row.track, row.km] for row in envelope.itertuples() if (row.track, row.km) in base.index)
    assert envelope["base_v"].notna().any()


def test_the_envelope_of_devices_is_the_worst_of_all_cases(results):
    cases, envelope = frames(results, "case_devices"), frames(results, "device_envelope").set_index("device")
    worst = cases.groupby("device")[["utilisation_percent", "peak_a"]].max()
    for device, row in envelope.iterrows():
        np.testing.assert_equal(row["utilisation_percent"], worst.loc[device, "utilisation_percent"])
        assert row["peak_a"] == worst.loc[device, "peak_a"]
        mine = cases[cases["device"] == device].set_index("case")
        assert mine.loc[row["peak_case"], "peak_a"] == row["peak_a"]
        assert row["met"] == ("no" if "no" in set(mine["met"]) else "yes" if "yes" in set(mine["met"]) else "")
        if row["case"]:
            np.testing.assert_array_equal(
                mine.loc[row["case"], ["load_a", "permitted_a", "window_s"]].astype(float),
                row[["load_a", "permitted_a", "window_s"]].astype(float),
            )
            assert row["base_percent"] == mine.loc["base", "utilisation_percent"]
    assert {"A unit", "B unit"} <= set(envelope.index[envelope["met"] != ""])


def test_delays_are_added_to_those_of_the_base_at_the_same_grid_voltage(results):
    late = frames(results, "case_trains").set_index(["case", "train"])
    for case, train in late.index:
        base = "base, grid low" if case.endswith("grid low") else "base"
        assert late.loc[(case, train), "added_late_s"] == pytest.approx(
            late.loc[(case, train), "late_s"] - late.loc[(base, train), "late_s"], abs=1e-3
        )
    assert late.loc[("A bypassed", "x"), "added_late_s"] > 5.0


def test_what_run_json_says(results):
    told, cases = results.run["contingency"], frames(results, "cases")
    outages = cases[cases["kind"] != "base"]
    assert results.run["kind"] == "contingency"
    assert results.run["cases"] == {"all": 12, "complete": 12, "flagged": 0, "refused": 0, "failed": 0, "reused": 0}
    late = set(outages["case"][outages["worst_late_s"] > 1.0])
    over = set(outages["case"][outages["utilisation_percent"] > 100.0])
    low = set(outages["case"][outages["lowest_voltage_v"] < 2000.0 - 0.1])
    useful = set(outages["case"][(outages["useful_zone_v"] < 2699.9) | (outages["useful_train_v"] < 2699.9)])
    by_word = {
        word: {row["case"] for row in told["worst"] if word in row["fails"]} for row in told["worst"] for word in row["fails"]
    }
    assert by_word.get("late trains", set()) == late != set()
    assert by_word.get("overload", set()) == over != set()
    assert by_word.get("low voltage", set()) == low
    assert by_word.get("useful voltage", set()) == useful
    assert told["failing"] == len(late | over | low | useful)
    assert told["verdict"] == "fails"
    verdict = next(each for each in results.run["verdicts"] if each["name"] == "lowest voltage")
    assert verdict["value"] == pytest.approx(cases["lowest_voltage_v"].min(), rel=1e-6)
    assert verdict["status"] == "secondary"
    assert {row["device"] for row in told["devices"]} == set(frames(results, "device_envelope").query("met == 'no'")["device"])
    assert sum(kind["cases"] for kind in told["kinds"]) == len(outages)


def test_without_a_violation_all_holds():
    generous = scenario_of(kinds=["section_cabin"], grid_voltages=["normal"])
    plants = tuple(plant.model_copy(update={"rated_current_a": 5000.0}) for plant in generous.supply.substations)
    easy = generous.model_copy(
        update={"supply": generous.supply.model_copy(update={"substations": plants}),
                "feasibility": generous.feasibility.model_copy(update={"tolerance_s": 900.0})}
    )  # fmt: skip
    told = tractionpower.contingency(easy).run
    assert (told["contingency"]["verdict"], told["contingency"]["failing"]) == ("holds", 0)
    assert all(verdict["met"] for verdict in told["verdicts"])


def test_it_goes_on_where_it_was_stopped_and_comes_to_the_same(tmp_path, scenario, results):
    def stop(now):
        if now.done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        contingency(scenario, tmp_path / "out", progress=stop)
    partial = Results.open(tmp_path / "out", partial=True)
    assert partial.run["status"] == "interrupted"
    assert len(partial.table("cases")) == 5
    seen = []
    again = contingency(scenario, tmp_path / "out", progress=seen.append)
    assert again.run["cases"]["reused"] == 5
    assert again.run["status"] == "complete"
    for table in results.tables:
        assert again.table(table).equals(results.table(table)), table
    assert not (tmp_path / "out" / ".running").exists()
    fewer = scenario_of(kinds=["unit"], grid_voltages=["normal"])
    assert contingency(fewer, tmp_path / "out").run["cases"] == results.run["cases"] | {"all": 3, "complete": 3}


def test_a_case_that_is_refused_is_a_row_with_its_reason():
    """A by-pass switch that closes lies across the contact line of a bypassed substation: currents would not be defined."""
    ends = [{"track": "1", "km": 10.0, "side": side} for side in ("low_km", "high_km")]
    by_pass = {"id": "by-pass", "from": ends[0], "to": ends[1], "state": "open"}
    event = {"time": 5.0, "device": "by-pass", "state": "closed"}
    made = couple(run("x"), end_s=60.0, switches=[by_pass], switch_events=[event])
    middle = {"id": "M", "km": 10.0, "feeder_resistance_ohm": 0.01}
    plants = (*made.supply.substations, made.supply.substations[0].model_copy(update=middle))
    supply = made.supply.model_copy(update={"substations": plants, "section_cabins": ()})
    wish = Contingency(kinds=("substation",), grid_voltages=("normal",))
    found = contingency(made.model_copy(update={"supply": supply, "contingency": wish}))
    told = found.run["contingency"]
    assert [(row["case"], row["status"]) for row in told["not_computed"]] == [("M bypassed", "refused")]
    assert "by-pass" in told["not_computed"][0]["reason"]
    assert found.run["status"] == "flagged"
    assert set(frames(found, "cases")["status"]) == {"complete", "refused"}


def test_a_base_with_errors_is_refused_at_once():
    with pytest.raises(InputError):
        OutageStudy(couple(run("x", high=60.0)))


def test_another_folder_of_a_failed_study_leaves_no_trace(tmp_path, scenario):
    writer = RunWriter(tmp_path / "out", "s", scenario.input_hash)
    with pytest.raises(RuntimeError):
        run_into(OutageStudy(scenario_of(kinds=["unit"])), writer, progress=_break)
    assert not (tmp_path / "out" / ".running" / scenario.input_hash[:16]).exists()


def _break(now):
    raise RuntimeError("broken")

"""Comparison of folders: matched figures, differences, what is told of folders that do not fit."""

import math

import pandas as pd
import pytest
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.errors import UsageError
from tractionpower.io.library import change
from tractionpower.results.results import Results
from tractionpower.results.store import RUNNING, RunWriter
from tractionpower.studies.compare.figures import compared
from tractionpower.studies.compare.folders import Variant
from tractionpower.studies.compare.study import compare, compare_folders
from tractionpower.studies.sweep.study import sweep

BASE = make_scenario(load("tap"), load("depot", 14.0, "2"), name="taps")
STRONG = change(BASE, ["supply.substations[A].internal_resistance_ohm=0.06"])


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    place = tmp_path_factory.mktemp("runs")
    for name, scenario in (("base", BASE), ("strong", STRONG)):
        simulate(scenario, place / name)
    return place


def test_figures_are_matched_by_name_and_place(folders):
    results = compare([folders / "base", folders / "strong"])
    rows = results.table("compare").astype({"figure": str, "place": str, "folder": str})
    own = {name: Results.open(folders / name) for name in ("base", "strong")}
    energy = rows[(rows["figure"] == "energy_kwh") & (rows["place"] == "substation A")].set_index("folder")
    for name, run in own.items():
        assert energy.loc[name, "value"] == run.key_figure("energy_kwh", "substation A")
    difference = energy.loc["strong", "value"] - energy.loc["base", "value"]
    assert energy.loc["strong", "difference"] == difference > 0.0
    assert energy.loc["strong", "percent"] == pytest.approx(100.0 * difference / energy.loc["base", "value"])
    assert math.isnan(energy.loc["base", "difference"])
    assert set(energy["unit"]) == {"kWh"}
    count = len({(figure["name"], figure["place"]) for run in own.values() for figure in run.key_figures})
    assert len(rows.groupby(["figure", "place"])) <= count


def test_verdicts_inputs_and_profiles_stand_side_by_side(folders):
    results = compare([folders / "base", folders / "strong"])
    verdicts = results.table("compare_verdicts")
    told = Results.open(folders / "base").run["verdicts"]
    assert list(verdicts[verdicts["folder"] == "base"]["figure"]) == [verdict["name"] for verdict in told]
    inputs = results.table("compare_inputs").to_dict("records")
    path = "supply.substations[A].internal_resistance_ohm"
    assert inputs == [{"folder": "strong", "path": path, "base": "0.12", "value": "0.06"}]
    profile = results.table("compare_profile")
    lowest = profile.groupby("folder", observed=True)["lowest_voltage_v"].min()
    assert lowest["base"] < lowest["strong"]
    assert results.run["compare"]["folders"][1]["inputs"] == [f"{path}: 0.12 -> 0.06"]
    assert results.scenario == BASE


def test_the_base_may_be_any_of_them_by_folder_or_name(folders):
    for base in ("better", str(folders / "strong"), folders / "strong"):
        found = compare_folders([str(folders / "base"), f"better={folders / 'strong'}"], base)
        assert [variant.name for variant in found.variants] == ["better", "base"]
    added = compare_folders([folders / "base"], folders / "strong")
    assert [variant.name for variant in added.variants] == ["strong", "base"]


def fake(name, *figures, **run):
    keys = ("name", "place", "value", "time")
    return Variant(name, None, Results({"study": "x", **run}, [dict(zip(keys, one, strict=True)) for one in figures], {}))


def test_a_figure_that_wanders_is_matched_by_its_name_and_tells_where():
    low = ("lowest_voltage_v", "train 1, track 2, km 7.50", 2800.0, "08:00:00")
    rows = compared([
        fake("a", low, ("energy_kwh", "substation A", 5.0, "")),
        fake("b", ("lowest_voltage_v", "train 9, track 1, km 2.10", 2700.0, "09:00:00"), ("energy_kwh", "substation B", 6.0, "")),
    ])  # fmt: skip
    wandered = [row for row in rows if row["figure"] == "lowest_voltage_v"]
    assert [(row["place"], row["at"]) for row in wandered] == [
        ("", "train 1, track 2, km 7.50, 08:00:00"), ("", "train 9, track 1, km 2.10, 09:00:00"),
    ]  # fmt: skip
    assert wandered[1]["difference"] == -100.0
    energy = [row for row in rows if row["figure"] == "energy_kwh"]
    assert {row["place"] for row in energy} == {"substation A", "substation B"}  # another substation is another figure
    assert all(math.isnan(row["difference"]) for row in energy)


def test_a_figure_of_many_trains_does_not_wander():
    rows = compared([
        fake("a", ("highest_speed_kmh", "train 1", 100.0, ""), ("highest_speed_kmh", "train 2", 120.0, "")),
        fake("b", ("highest_speed_kmh", "train 2", 110.0, "")),
    ])  # fmt: skip
    assert {(row["place"], row["folder"]): row["value"] for row in rows} == {
        ("train 1", "a"): 100.0, ("train 2", "a"): 120.0, ("train 2", "b"): 110.0,
    }  # fmt: skip


def test_ratings_of_devices_are_compared(folders):
    ratings = pd.DataFrame({
        "device": ["A unit", "A unit", "B unit"], "kind": "unit", "utilisation_percent": [80.0, 60.0, math.nan],
        "ruling": [True, False, True],
    })  # fmt: skip

    class Sized(Results):
        def table(self, name):
            return ratings

    rows = compared([Variant("a", None, Sized({"kind": "size"}, [], {"ratings": ()})), fake("b")])
    assert [(row["figure"], row["place"], row["value"]) for row in rows] == [("utilisation_percent", "unit A unit", 80.0)]


def test_studies_of_many_cases_are_compared_case_by_case(tmp_path):
    vary = {"supply.section_cabins[C].state": ["open", "bypassed"]}
    sweep(BASE, vary, folder=tmp_path / "before")
    sweep(STRONG, vary, folder=tmp_path / "after")
    rows = compare([tmp_path / "before", tmp_path / "after"]).table("compare")
    low = rows[(rows["figure"] == "lowest_voltage_v") & (rows["folder"] == "after")].set_index("place")["difference"]
    assert set(low.index) == {"case base", "case 01", "case 02"}
    assert (low >= 0.0).all()  # with the cabin open the lowest voltage may lie on the side of B
    assert low["case base"] > 1.0


def test_folders_that_do_not_fit_are_told_all_at_once(folders, tmp_path):
    (tmp_path / "empty").mkdir()
    unfinished = RunWriter(tmp_path / "broken", "taps", BASE.input_hash, scenario=BASE)
    assert (tmp_path / "broken" / RUNNING).is_dir()
    with pytest.raises(UsageError) as raised:
        compare([folders / "base", tmp_path / "nowhere", tmp_path / "empty", unfinished.folder, folders / "base"])
    told = str(raised.value)
    for words in ("nowhere: there is no such folder", "empty: no results", "interrupted", "named twice"):
        assert words in told
    with pytest.raises(UsageError, match="at least two"):
        compare([folders / "base"])
    with pytest.raises(UsageError, match="two folders are called 'x'"):
        compare([f"x={folders / 'base'}", f"x={folders / 'strong'}"])


def test_folders_of_one_name_are_told_apart_by_the_one_above(folders, tmp_path):
    simulate(STRONG, tmp_path / "base")
    names = [variant.name for variant in compare_folders([folders / "base", tmp_path / "base"]).variants]
    assert names == [f"{folders.name}/base", f"{tmp_path.name}/base"]


def test_what_is_to_be_said_of_the_folders(folders, tmp_path):
    simulate(change(BASE, ["name=another"]), tmp_path / "other")
    simulate(BASE, tmp_path / "again")
    notes = compare_folders([folders / "base", tmp_path / "other", tmp_path / "again"]).notes
    assert any("another study, 'another' and not 'taps'" in note for note in notes)
    assert any(note == "again: no input differs from base" for note in notes)


def test_a_comparison_is_written_and_is_itself_not_compared(folders, tmp_path):
    out = tmp_path / "out"
    results = compare([folders / "base", folders / "strong"], out)
    assert results.run["kind"] == "compare"
    assert {"compare", "compare_inputs", "compare_profile", "compare_verdicts"} == set(results.tables)
    compare([folders / "base", folders / "strong"], out)  # the same study: replaced
    with pytest.raises(UsageError, match="comparison itself"):
        compare([folders / "base", out])

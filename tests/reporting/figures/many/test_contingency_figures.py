"""Figures of outages: what they show is what the tables say, and it can be read."""

import numpy as np
import pytest
from fake_results import make_case
from fake_sizing import outages

from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.figures.many import contingency_figures
from tractionpower.reporting.figures.many.outage_map import MAP, MOST_ROWS, _grid, outage_maps
from tractionpower.reporting.figures.of_run import OUTAGES, write_outage_figures
from tractionpower.results.results import Results

A4 = 11.8
"""Longest side of a figure [inches]."""


@pytest.fixture(scope="module")
def seen():
    scenario = make_case()[1]
    return Outages(outages(scenario), scenario)


@pytest.fixture(scope="module")
def many():
    scenario = make_case(substations=20)[1]
    return Outages(outages(scenario, grids=("normal",)), scenario)


def test_the_envelope_is_that_of_the_table(seen):
    figure = contingency_figures.envelope_voltage(seen, "Study")
    rows = seen.table("envelope")
    for axes, track in zip(figure.axes, "12", strict=True):
        own = rows[(rows["track"] == track) & (rows["quantity"] == "voltage")].sort_values("km")
        worst = next(line for line in axes.lines if line.get_label() == "worst of all cases")
        known = np.isfinite(worst.get_xdata())
        np.testing.assert_allclose(worst.get_ydata()[known], own["worst_v"])
        np.testing.assert_allclose(worst.get_xdata()[known], own["km"])
        assert "[V]" in axes.get_ylabel()
    assert figure.axes[-1].child_axes[0].get_xlabel().endswith("[km]")


def test_the_strip_names_the_case_that_rules(seen):
    figure = contingency_figures.envelope_voltage(seen, "Study")
    figure.canvas.draw()
    texts = [text.get_text() for sub in figure.subfigs for text in sub.texts]
    ruling = seen.table("envelope").query("quantity == 'voltage'")["case"].unique()
    for case in ruling:
        assert any(text.endswith(f"  {seen.told(case)}") for text in texts)


def test_rail_potentials_show_the_touch_voltage_only_when_near(seen):
    rows = seen.table("envelope").copy()
    far = contingency_figures.envelope_rails(seen, "Study")
    assert not any("touch" in str(line.get_label()) for line in far.axes[0].lines)
    near = Outages(seen.results, seen.scenario)
    rows.loc[rows["quantity"] == "rail_potential", "worst_v"] *= (
        110.0 / rows.query("quantity == 'rail_potential'")["worst_v"].max()
    )
    near._read["envelope"] = rows
    assert any("touch" in str(line.get_label()) for line in contingency_figures.envelope_rails(near, "Study").axes[0].lines)


def test_lowest_voltages_stand_at_their_values(seen):
    axes = contingency_figures.outage_voltages(seen, "Study").axes[0]
    names = [label.get_text() for label in axes.get_yticklabels()]
    for line in axes.lines[: len(seen.grids)]:
        grid = str(line.get_label()).split()[0]
        for volts, row in zip(line.get_xdata(), line.get_ydata(), strict=True):
            case = next(c for c in seen.by_id.values() if c["words"] == names[int(row)] and c["grid"] == grid)
            assert volts == pytest.approx(case["lowest_voltage_v"] if case["status"] != "failed" else np.nan, nan_ok=True)


def test_with_many_outages_the_worst_and_the_base_are_shown(many, no_overlap):
    figure = contingency_figures.outage_voltages(many, "Study")
    names = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert names[0] == "nothing is out"
    assert len(names) == contingency_figures.MOST_ROWS + 1
    shown = many.cases[many.cases["words"].isin(names)]["lowest_voltage_v"]
    assert shown.iloc[1:].max() <= many.cases[~many.cases["words"].isin(names)]["lowest_voltage_v"].min()
    assert "worst of" in figure._suptitle.get_text()
    no_overlap(figure, figure.axes[0].get_yticklabels())


def test_delays_show_every_train(seen):
    figure = contingency_figures.outage_delays(seen, "Study")
    rows = seen.table("case_trains")
    dots = sum(len(line.get_xdata()) for line in figure.axes[0].lines)
    assert dots == (rows["added_late_s"] > seen.tolerance_s).sum()


def test_devices_are_shown_from_the_most_loaded_on(seen):
    figure = contingency_figures.worst_utilisation(seen, "Study")
    rows = seen.table("device_envelope").sort_values("utilisation_percent", ascending=False)
    names = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert names[0] == rows["device"].iloc[0]
    assert any(f"{rows['utilisation_percent'].iloc[0]:.0f} %" in text.get_text() for text in figure.axes[0].texts)


def test_the_map_holds_the_lowest_voltage_of_all_tracks(seen):
    profile = seen.table("case_profile")
    cases = list(profile["case"].unique()[:5])
    edges, volts = _grid(profile, cases, 0.25, 39.75)
    for row, case in enumerate(cases):
        for column in (0, 17, 79):
            inside = profile[
                (profile["case"] == case) & profile["km"].between(edges[column], edges[column + 1], inclusive="left")
            ]
            assert volts[row, column] == pytest.approx(inside["lowest_voltage_v"].min(), nan_ok=True)


def test_many_outages_become_a_map_for_each_kind(seen, many):
    assert [name for name, _ in outage_maps(seen, "Study")] == [MAP, f"{MAP}_low"]
    drawn = dict(outage_maps(many, "Study"))
    assert list(drawn) == [f"{MAP}_{kind}" for kind in ("unit", "substation", "feeder", "section_cabin")]
    for figure in drawn.values():
        assert len(figure.axes[0].get_yticks()) <= MOST_ROWS + 1
        assert max(figure.get_size_inches()) <= A4
    assert f"the {MOST_ROWS} with the lowest voltages of 80" in drawn[f"{MAP}_feeder"].get_suptitle()


def test_figures_are_written_and_stale_ones_go(seen, tmp_path):
    (tmp_path / f"{MAP}_old.png").write_bytes(b"")
    (tmp_path / "other.png").write_bytes(b"")
    paths = write_outage_figures(seen.results, seen.scenario, tmp_path)
    assert {path.stem for path in paths} == {*OUTAGES, MAP, f"{MAP}_low"}
    assert not (tmp_path / f"{MAP}_old.png").exists()
    assert (tmp_path / "other.png").exists()


def test_without_tables_there_are_no_figures(seen):
    empty = Outages(Results({}, [], {}, seen.scenario), seen.scenario)
    assert [draw(empty, "Study") for draw in OUTAGES.values()] == [None] * len(OUTAGES)
    assert list(outage_maps(empty, "Study")) == []

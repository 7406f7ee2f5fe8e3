"""Figures and workbook of a sweep, made from hand-made tables."""

import math

import matplotlib as mpl
import numpy as np
import pytest
from openpyxl import load_workbook
from read_workbook import read_table, texts
from small_studies import load, make_scenario

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.figures.many.sweep_figures import sweep_figures
from tractionpower.reporting.reports import write_reports
from tractionpower.results.results import Results
from tractionpower.studies.runner.outcomes import rows_table
from tractionpower.studies.sweep.cases import as_cases, grid
from tractionpower.studies.sweep.differences import differences, extremes
from tractionpower.studies.sweep.keys import Varied

SCENARIO = make_scenario(load("tap"), name="taps $5")
R = Varied("supply.substations[A].internal_resistance_ohm", ("0.3", "0.05", "0.1"))
STATE = Varied("supply.section_cabins[C].state", ("closed", "open"))
LENGTH = Varied("supply.contact_lines[0].resistance_ohm_per_km", ("0.05", "0.06"))


def results_of(*varied, refused=()):
    """Return a sweep whose lowest voltage falls with the first value, the losses with the number of the case."""
    cases = as_cases(grid(varied))
    rows = []
    for number, case in enumerate(cases):
        found = {"case": case.id, "kind": case.kind, "subject": case.subject, "grid": "normal", "status": "complete"}
        if case.id in refused:
            rows.append(found | {"status": "refused", "reason": "=because"})
            continue
        value = float(case.changes[0].rpartition("=")[2]) if number else 0.12
        rows.append(found | {"lowest_voltage_v": 3000.0 - 1000.0 * value, "line_loss_kwh": 10.0 + number, "late_trains": 0})
    keys = {item.path: list(item.values) for item in varied}
    told = [(case.id, *change.rsplit("=", 1)) for case in cases for change in case.changes]
    changes = [dict(zip(("case", "path", "value"), one, strict=True)) for one in told]
    tables = {
        "cases": rows_table("cases", rows),
        "case_changes": rows_table("case_changes", changes),
        "differences": rows_table("differences", differences(rows, rows[0])),
    }
    measured = [row for row in rows if row["status"] == "complete"]
    counts = {"all": len(rows), "complete": len(measured), "refused": len(rows) - len(measured), "flagged": 0, "failed": 0}
    note = {"keys": keys, "extremes": extremes(measured), "sample": None}
    run = {"kind": "sweep", "status": "complete", "study": "taps", "cases": counts, "sweep": note, "verdicts": []}
    return Results(run, [], tables, SCENARIO)


def test_one_input_is_drawn_as_curves_over_its_rising_values():
    (figure,) = sweep_figures(results_of(R), SCENARIO).values()
    low, loss = figure.axes
    line = low.get_lines()[0]
    assert list(line.get_xdata()) == [0.05, 0.1, 0.3]
    assert list(line.get_ydata()) == pytest.approx([2950.0, 2900.0, 2700.0])
    assert low.get_lines()[1].get_ydata()[0] == pytest.approx(2880.0)  # the base
    assert loss.get_xlabel() == "substation A: internal resistance [Ω]"


def test_a_refused_value_is_marked():
    (figure,) = sweep_figures(results_of(R, refused=("02",)), SCENARIO).values()
    marks = [line for line in figure.axes[-1].get_lines() if line.get_label() == "refused or failed"]
    assert [list(line.get_xdata()) for line in marks] == [[0.05]]


def test_two_inputs_are_drawn_as_maps_with_their_values():
    drawn = sweep_figures(results_of(R, STATE, refused=("01",)), SCENARIO)
    assert set(drawn) == {"sweep_maps", "sweep_curves", "sweep_differences"}
    figure, curves = drawn["sweep_maps"], drawn["sweep_curves"].axes[0].get_lines()
    assert [line.get_label() for line in curves[:2]] == ["section cabin C: state closed", "section cabin C: state open"]
    assert list(curves[0].get_xdata()) == [0.05, 0.1]  # the third was refused
    maps = [axes for axes in figure.axes if axes.images]
    shown = np.ma.filled(maps[0].images[0].get_array(), np.nan)
    assert shown.shape == (2, 3)  # two states down, three resistances across
    assert [label.get_text() for label in maps[0].get_xticklabels()] == ["0.05", "0.1", "0.3"]
    assert shown[:, 0] == pytest.approx([2950.0, 2950.0])
    assert math.isnan(shown[0, 2])
    assert sum(text.get_text() == "none" for text in maps[0].texts) == 1


def test_many_inputs_are_drawn_as_bars_and_clouds():
    drawn = sweep_figures(results_of(R, STATE, LENGTH), SCENARIO)
    assert set(drawn) == {"sweep_differences", "sweep_scatter"}
    bars = drawn["sweep_differences"].axes[0]
    widths = [bar.get_width() for bar in bars.patches]
    assert widths == sorted(widths, reverse=True)  # the worst, lowest voltage, above
    assert min(widths) == pytest.approx(-180.0)
    assert len({patch.get_facecolor() for patch in bars.patches}) == 2
    assert ": 0.3, " in bars.get_yticklabels()[-1].get_text()
    points = drawn["sweep_scatter"].axes[0].get_lines()[0]
    assert len(points.get_xdata()) == 12


def test_nothing_is_drawn_where_nothing_differs():
    results = results_of(R)
    results.run["sweep"]["extremes"] = {}
    assert sweep_figures(results, SCENARIO) == {}


def test_texts_that_are_values_keep_their_order():
    data = SweepData(results_of(R, STATE), SCENARIO)
    assert data.keys == {R.path: ["0.05", "0.1", "0.3"], STATE.path: ["closed", "open"]}
    assert data.names[STATE.path] == "section cabin C: state"
    assert list(data.changes.columns) == [R.path, STATE.path]


def test_all_reports_and_the_values_in_them(tmp_path):
    mpl.rcdefaults()
    results = results_of(R, STATE, refused=("03",))
    paths = write_reports(results, SCENARIO, tmp_path)
    assert {path.name for path in paths} == {"sweep_maps.png", "sweep_curves.png", "sweep_differences.png", "report.xlsx"}
    book = load_workbook(tmp_path / "report.xlsx", data_only=True)
    rows = {row["case"]: row for row in read_table(book["Variants"])}
    assert len(rows) == 7
    assert rows["02"]["substation A: internal resistance [Ω]"] == 0.3
    assert rows["base"]["substation A: internal resistance [Ω]"] == SCENARIO.supply.substations[0].internal_resistance_ohm
    assert rows["02"]["section cabin C: state"] == "open"
    assert rows["02"]["lowest voltage [V]"] == pytest.approx(2700.0)
    assert rows["03"]["reason"] == "=because"
    assert rows["03"]["lowest voltage [V]"] is None
    changed = {row["case"]: row for row in read_table(book["Differences"])}
    assert set(changed) == {"01", "02", "04", "05", "06"}
    assert changed["04"]["lowest voltage [V]"] == pytest.approx(70.0)
    assert changed["04"]["lowest voltage [%]"] == pytest.approx(7000.0 / 2880.0, rel=1e-6)
    written = load_workbook(tmp_path / "report.xlsx")["Variants"]
    assert [cell.data_type for line in written for cell in line if cell.value == "=because"] == ["s"]
    assert any("1 refused" in text for text in texts(book["Cover"]))
    (tmp_path / "figures" / "sweep_scatter.png").write_bytes(b"old")
    write_reports(results, SCENARIO, tmp_path)
    assert not (tmp_path / "figures" / "sweep_scatter.png").exists()


def test_lowest_voltages_of_the_cases_are_laid_over_each_other():
    results = results_of(R)
    rows = [
        {"case": case, "track": "1", "km": km, "lowest_voltage_v": 3000.0 - n}
        for n, case in enumerate(("base", "01", "02", "03"))
        for km in (1.0, 1.5)
    ]
    results._source["case_profile"] = rows_table("case_profile", rows)
    figure = sweep_figures(results, SCENARIO)["sweep_voltage"]
    lines = {line.get_label(): list(line.get_ydata()) for line in figure.axes[0].get_lines()}
    assert lines["base"] == [3000.0, 3000.0]
    assert lines["02: internal resistance 0.05 Ω"] == [2998.0, 2998.0]

"""A run beside a measurement: errors of known series, doubts about units and signs, places instead of times."""

import numpy as np
import pyarrow as pa
import pytest
from measured_files import COUNT, MAP, START, current_at, make_run, rows_of, step_means, voltage_at, write_pair

from tractionpower.errors import InputError, UsageError
from tractionpower.results.results import Results
from tractionpower.studies.measured.errors import Compared, errors_of, smoothed
from tractionpower.studies.measured.study import compare_measured


def compare(tmp_path, rows, text=MAP, run=None):
    return compare_measured(run or make_run(), *write_pair(tmp_path, rows, text))


def test_a_perfect_model_has_no_error_whatever_the_clock(tmp_path):
    found = compare(tmp_path, rows_of(shift_s=-63.72, every=0.2))
    assert found.shift.shift_s == pytest.approx(-63.72, abs=0.01)
    voltage, current, power = found.series
    assert voltage.errors["rms_error"] < 0.2
    assert abs(current.errors["mean_error"]) < 0.05
    assert abs(power.errors["energy_error_percent"]) < 0.05  # power of row means, not mean of powers
    assert found.problems == ()


def test_errors_of_a_level_and_a_scale(tmp_path):
    """Computed voltages 40 V too high, currents 10 % too small: known errors, energies by a fine integral."""
    run = make_run(voltage=step_means(voltage_at) + 40.0, current=0.9 * step_means(current_at))
    found = compare(tmp_path, rows_of(shift_s=12.5, every=0.5), run=run)
    voltage, current, power = (each.errors for each in found.series)
    assert voltage["mean_error"] == pytest.approx(40.0, abs=0.2)
    assert voltage["rms_error"] == pytest.approx(40.0, abs=0.2)
    assert voltage["relative_percent"] == pytest.approx(100.0 * 40.0 / voltage["rms_measured"], rel=1e-3)
    assert current["correlation"] == pytest.approx(1.0, abs=1e-5)
    assert current["energy_measured"] != current["energy_measured"]  # a current is no energy
    first, last = START + 30.0, START + 1149.5
    fine = np.linspace(first, last, 200_001)
    exact = np.trapezoid(voltage_at(fine) * current_at(fine), fine) / 3.6e6
    assert power["energy_measured"] == pytest.approx(exact, rel=2e-3)
    wrong = np.trapezoid((voltage_at(fine) + 40.0) * 0.9 * current_at(fine), fine) / 3.6e6
    assert power["energy_error_percent"] == pytest.approx(100.0 * (wrong / exact - 1.0), abs=0.1)
    highest = START + np.argmax(step_means(current_at)[30:1149]) + 30.0
    assert current["highest_measured_at"] == pytest.approx(highest, abs=1.0)
    assert current["highest_computed"] == pytest.approx(0.9 * current_at(highest), rel=1e-3)


def test_rows_at_intervals_stand_for_their_interval(tmp_path):
    means = step_means(current_at)
    whole = compare(tmp_path, rows_of(every=0.5)).series[2].errors["energy_measured"]
    run = make_run()
    table = run._source["substations"]
    seldom = Results(run.run, [], {"substations": table.take(np.flatnonzero(np.arange(2 * COUNT) // 2 % 5 == 0))})
    found = compare(tmp_path, rows_of(every=0.5, shift_s=3.0), run=seldom)
    assert found.shift.shift_s == pytest.approx(3.0, abs=0.05)
    assert found.series[2].compared.every_s == 5.0
    assert found.series[2].errors["energy_measured"] == pytest.approx(whole, rel=5e-3)
    assert len(means) == COUNT


def test_a_given_shift_is_taken_and_smoothing_quietens_noise(tmp_path):
    text = MAP + "shift_s: 20\n"
    noisy = compare(tmp_path, rows_of(shift_s=20.0, noise=50.0), text)
    assert noisy.shift.shift_s == 20.0
    assert noisy.run["measured"]["shift_found"] is False
    quiet = compare(tmp_path, rows_of(shift_s=20.0, noise=50.0), text.replace("current_a", "current_a, smoothing_s: 15"))
    assert noisy.series[1].errors["rms_error"] > 35.0
    assert quiet.series[1].errors["rms_error"] < 16.0


def test_gaps_are_not_compared(tmp_path):
    lines = rows_of().splitlines()
    found = compare(tmp_path, "\n".join(lines[:300] + lines[500:]) + "\n")
    one = found.series[0]
    assert one.errors["rows"] == pytest.approx(1118 - 200, abs=2)
    assert one.errors["share_percent"] == pytest.approx(100.0 * 919 / COUNT, abs=0.3)
    row = found.tables()["measured_errors"].to_pandas().iloc[0]
    assert (row["gaps"], row["longest_gap_s"]) == (1, 201.0)
    dark = found.tables()["measured"].to_pandas().query("series == 'substation A voltage_v' and measured != measured")
    assert len(dark) > 200


@pytest.mark.parametrize(
    ("rows", "change", "words"),
    [
        (rows_of(factor=0.001), ("", ""), "it looks like kV, where the map says V"),
        (rows_of(), ("voltage_v", "voltage_v, unit: kV"), "it looks like V, where the map says kV"),
        (rows_of(factor=1000.0, separator=";"), ("", ""), "a decimal sign was lost"),
        (rows_of(), ("current_a", "current_a, sign: -1"), "run against each other"),
    ],
)
def test_units_and_signs_that_do_not_fit_are_told(tmp_path, rows, change, words):
    text = MAP.replace(*change) if change[0] else MAP
    problems = compare(tmp_path, rows, text).problems
    told = [problem for problem in problems if problem.path.startswith("series[")]
    assert any(words in f"{problem.found} {problem.remedy}" for problem in told), problems
    assert all(problem.place.startswith("map.yaml:") and problem.severity == "warning" for problem in told)


def test_thousands_that_are_taken_for_decimals_are_told(tmp_path):
    """3,312 with a decimal comma is 3.312: only the computed value says that it means 3312."""
    lines = ["t;U;I"]
    for t in START + np.arange(0.0, 900.0):
        lines.append(f"{t:.0f};{voltage_at(t):,.0f};{int(current_at(t))}")
    found = compare(tmp_path, "\n".join(lines) + "\n")
    (problem,) = [p for p in found.problems if p.code == "unit"]
    assert "or the sign in '3," in problem.remedy
    assert "say decimal: point" in problem.remedy


def test_what_the_run_does_not_have_is_told_at_once(tmp_path):
    text = MAP.replace("substation A, quantity: voltage_v", "substation Lodz, quantity: voltage_v").replace(
        "current_a", "curent_a"
    )
    text += "  - {column: P, of: train 2, quantity: power_kw}\n"
    with pytest.raises(InputError) as caught:
        compare(tmp_path, rows_of(), text)
    problems = caught.value.problems
    assert [(p.code, p.place) for p in problems] == [
        ("no_subject", "map.yaml:4"), ("no_quantity", "map.yaml:5"), ("no_table", "map.yaml:6"),
    ]  # fmt: skip
    assert "Łódź" in problems[0].allowed
    assert "current_a" in problems[1].remedy


def test_times_that_do_not_meet(tmp_path):
    found = compare(tmp_path, rows_of(shift_s=9000.0))
    assert all(each.errors["rows"] == 0 for each in found.series)
    assert [p.code for p in found.problems] == ["shift", "apart"]
    assert "the run from " in found.problems[1].found
    assert "say shift_s in the map: 8970 if" in found.problems[1].remedy, "rows begin 30 s into the run"
    assert "shift_range_s" in found.problems[1].remedy
    assert np.isnan(found.tables()["measured_errors"].to_pandas()["mean_error"]).all()


def test_results_without_such_tables(tmp_path):
    with pytest.raises(UsageError, match="no tables of a run"):
        compare(tmp_path, "", run=Results({}, [], {}))


TRAIN_MAP = """format: 1
align: distance
every_m: 50
time: {column: t}
series:
  - {column: km, of: train 1, quantity: position_km}
  - {column: v, of: train 1, quantity: speed_kmh, unit: m/s}
"""


def train_run(backwards):
    """Return a run of a train that gains speed, slows down and stops, row by row in closed form."""
    time_s = START + np.arange(600.0)
    part = np.arange(600.0) / 600.0
    way_m = 12_000.0 * (part - np.sin(2.0 * np.pi * part) / (2.0 * np.pi))
    speed = 20.0 * (1.0 - np.cos(2.0 * np.pi * part))
    km = 15.0 - way_m / 1000.0 if backwards else 3.0 + way_m / 1000.0
    columns = {"time_s": time_s, "train": ["1"] * 600, "position_km": km, "speed_kmh": 3.6 * speed}
    return Results({"step_s": 1.0}, [], {"trains": pa.table(columns)}), time_s, km, speed


@pytest.mark.parametrize("backwards", [False, True])
def test_trains_are_compared_by_place_whatever_their_time(tmp_path, backwards):
    """The measured train waits for a minute on its way and has another clock: at the same places it is as fast."""
    run, time_s, km, speed = train_run(backwards)
    late = time_s + np.where(np.arange(600) > 300, 60.0, 0.0) + 777.0
    lines = ["t,km,v", *(f"{t:.2f},{place:.5f},{v:.4f}" for t, place, v in zip(late, km, speed, strict=True))]
    found = compare(tmp_path, "\n".join(lines) + "\n", TRAIN_MAP + "gap_s: 90\n", run)
    place, moving = found.series
    assert moving.errors["rows"] == 240  # 12 km in pieces of 50 m
    assert moving.errors["rms_error"] < 0.05
    assert place.errors["rms_error"] < 1e-4
    assert np.isnan(moving.compared.every_s)
    table = found.tables()["measured"].to_pandas()
    assert table["time_s"].isna().all()
    assert table["position_km"].between(3.0, 15.0).all()
    row = found.tables()["measured_errors"].to_pandas().iloc[1]
    assert row["highest_measured_km"] == pytest.approx(9.0, abs=0.1)
    assert np.isnan(row["highest_measured_s"])
    assert "measured_shift" not in found.tables()


def test_a_place_that_was_not_measured_is_a_gap(tmp_path):
    run, time_s, km, speed = train_run(backwards=False)
    kept = (km < 6.0) | (km > 7.0)
    rows = zip(time_s[kept], km[kept], speed[kept] + 1.0, strict=True)
    lines = ["t,km,v", *(f"{t:.2f},{place:.5f},{v:.4f}" for t, place, v in rows)]
    moving = compare(tmp_path, "\n".join(lines) + "\n", TRAIN_MAP, run).series[1]
    dark = moving.compared.at[~np.isfinite(moving.compared.measured)]
    assert 5.95 < dark.min() < 6.1
    assert 6.9 < dark.max() < 7.05
    assert moving.errors["mean_error"] == pytest.approx(-3.6, abs=0.02)


def test_errors_of_nothing_and_of_a_few():
    nothing = Compared(np.arange(3.0), np.full(3, np.nan), np.arange(3.0), 1.0)
    assert errors_of(nothing, is_power=True)["rows"] == 0
    few = Compared(np.arange(3.0), np.array([1.0, np.nan, 3.0]), np.array([2.0, 9.0, 5.0]), 3600.0)
    found = errors_of(few, is_power=True)
    assert (found["mean_error"], found["rms_error"]) == (1.5, pytest.approx(np.sqrt(2.5)))
    assert (found["energy_measured"], found["energy_error_percent"]) == (4.0, 75.0)
    assert found["highest_computed_at"] == 2.0


def test_smoothing_is_a_centred_mean_that_leaves_gaps():
    values = np.array([0.0, 3.0, 6.0, np.nan, 9.0])
    assert smoothed(values, 3).tolist()[:3] == [1.5, 3.0, 4.5]
    assert np.isnan(smoothed(values, 3)[3])
    assert smoothed(values, 1) is values

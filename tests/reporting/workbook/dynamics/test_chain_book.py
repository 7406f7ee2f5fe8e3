"""The workbook of train dynamics: forces held against what couplings endure, sums that add up, words in both languages."""

import numpy as np
import pytest
from fake_dynamics import fake_results, fake_scenario
from openpyxl import load_workbook
from read_workbook import read_table, texts

from tractionpower.model.report import SHEETS, Report
from tractionpower.reporting.texts import language, recorded
from tractionpower.reporting.workbook import write_workbook


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("chain"))


@pytest.fixture(scope="module")
def paths(results, tmp_path_factory):
    folder = tmp_path_factory.mktemp("books")
    chosen = ("en", "pl")
    return {one: write_workbook(results, fake_scenario(), folder / f"{one}.xlsx", Report(language=one)) for one in chosen}


@pytest.fixture(scope="module")
def book(paths):
    return load_workbook(paths["en"], data_only=True)


@pytest.fixture(scope="module")
def formulas(paths):
    return load_workbook(paths["en"])


def test_all_sheets_are_known_by_name(book):
    assert set(book.sheetnames) <= set(SHEETS)
    assert {"Cover", "Acceptance", "Coupling forces", "Stops", "Energy", "Rainflow", "Inputs couplings", "Not covered"} <= set(
        book.sheetnames
    )


def test_the_greatest_force_of_a_kind_is_a_formula_and_is_judged(book, formulas, results):
    (kind,) = read_table(book["Coupling forces"], 2)
    extremes = results.table("coupling_extremes")
    for side, limit in (("tension", 850.0), ("compression", 60.0)):
        most = extremes[f"greatest_{side}_kn"]
        assert kind[f"greatest {side} [kN]"] == pytest.approx(most.max())
        assert kind[f"endurable {side} [kN]"] == limit
    assert kind["tension at coupling"] == extremes["coupling"][extremes["greatest_tension_kn"].argmax()]
    assert kind["used of endurable tension [%]"] == pytest.approx(100.0 * extremes["greatest_tension_kn"].max() / 850.0)
    (row,) = [row for row in read_table(formulas["Coupling forces"], 2)]
    assert row["greatest tension [kN]"].startswith("=SUMPRODUCT(MAX(")
    verdicts = {row["what is judged"]: row for row in read_table(book["Acceptance"])}
    assert {row["verdict"] for row in verdicts.values()} == {"met"}
    assert verdicts["greatest compression of couplings linear-5"]["limit value"] == 60.0
    assert "=coupling_compression_1" in [row["found"] for row in read_table(formulas["Acceptance"])]


def test_a_force_beyond_its_limit_is_violated(tmp_path):
    coupling = fake_scenario().couplings[0].model_copy(update={"endurable_tension_kn": 100.0})
    scenario = fake_scenario().model_copy(update={"couplings": (coupling,)})
    results = fake_results(tmp_path / "run")
    found = results.run["verdicts"][0]
    results.run["verdicts"][0] = found | {"limit_value": 100.0, "met": False}
    book = load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"), data_only=True)
    verdicts = {row["what is judged"]: row["verdict"] for row in read_table(book["Acceptance"])}
    assert verdicts == {
        "greatest tension of couplings linear-5": "violated", "greatest compression of couplings linear-5": "met"
    }  # fmt: skip
    assert max(row["used of endurable tension [%]"] for row in read_table(book["Coupling forces"])) > 100.0


def test_warnings_of_the_run_are_evidence(tmp_path):
    results = fake_results(tmp_path / "run")
    warning = "warning: case.run.record_every_s: every 2nd step is recorded"
    results.run["warnings"] = [warning]
    book = load_workbook(write_workbook(results, fake_scenario(), tmp_path / "report.xlsx"), data_only=True)
    assert warning in texts(book["Solver evidence"])
    rows = {row[0].value: row[1].value for row in book["Solver evidence"].iter_rows(max_col=2)}
    assert rows["largest gap by the energy put in that closes"] == 1e-6


def test_a_stop_backwards_has_magnitudes_and_is_told(tmp_path):
    results = fake_results(tmp_path / "run")
    (stop,) = results.run["stops"]
    results.run["stops"] = [
        stop | {"braked_at_m": 100.0, "stopped_at_m": 90.0, "stopping_distance_m": 10.0, "mean_deceleration_mps2": None}
    ]
    book = load_workbook(write_workbook(results, fake_scenario(), tmp_path / "report.xlsx"), data_only=True)
    (row,) = read_table(book["Stops"])
    assert row["stopping distance [m]"] == 10.0
    assert row["mean deceleration over the distance, v²/2s [m/s²]"] is None
    assert "Stop, backwards" in texts(book["Cover"])
    assert not [text for text in texts(book["Cover"]) if "nan" in text.split()]


def test_stops_and_energies_are_those_of_the_run(book, results):
    (stop,) = read_table(book["Stops"])
    for heading, name in (("stopping distance [m]", "stopping_distance_m"), ("stopping time [s]", "stopping_time_s"),
                          ("mean deceleration over the distance, v²/2s [m/s²]", "mean_deceleration_mps2")):  # fmt: skip
        assert stop[heading] == pytest.approx(results.key_figure(name))
    parts = read_table(book["Energy"])
    put_in, taken = (sum(row["energy [kWh]"] for row in parts if row["side"] == side) for side in ("put in", "taken"))
    assert put_in == pytest.approx(taken, rel=1e-9)
    assert put_in == pytest.approx(results.key_figure("traction_energy_kwh"))


def test_shares_of_the_time_come_to_all_of_it(book):
    for table in (1, 2):
        assert sum(row["sum [%]"] for row in read_table(book["Distributions"], table)) == pytest.approx(100.0)
    for table in (3, 4):
        rows = read_table(book["Distributions"], table)
        assert rows[-1]["share up to here [%]"] == pytest.approx(100.0)
        assert np.diff([row["share up to here [%]"] for row in rows]).min() >= 0.0


def test_cycles_are_all_there(book, results):
    rows = results.table("rainflow")
    told = {row["vehicles"]: row for row in read_table(book["Rainflow"])}
    for name, own in rows.groupby("coupling", observed=True):
        assert told[name]["cycles"] == pytest.approx(own["cycles"].sum())
    assert max(row["damage, relative"] for row in told.values()) == 1.0
    damage = results.table("coupling_extremes").set_index("coupling")["damage"]
    assert [row["damage, relative"] for row in told.values()] == pytest.approx(damage.to_list())


def test_extracts_have_a_sensible_number_of_rows_and_the_ends(book, results):
    rows = read_table(book["Course of the train"])
    assert len(rows) <= 600
    assert (rows[0]["time [s]"], rows[-1]["time [s]"]) == (0.0, results.run["end_s"])
    force = results.table("couplings").query("coupling == '1-2'")["force_kn"]
    assert max(row["force of 1-2 [kN]"] for row in read_table(book["Course of couplings"])) == pytest.approx(force.max())


def test_it_says_what_it_does_not_prove(book):
    told = " ".join(texts(book["Not covered"]))
    assert "Benchmarking" in told
    assert "UIC" in told
    assert "no certification is claimed" in " ".join(texts(book["Cover"]))


def test_everything_recorded_has_polish_words(results):
    with language("pl"):
        for figure in results.key_figures:
            assert recorded(figure["definition"]) != figure["definition"], figure["name"]
            assert not figure["place"] or recorded(figure["place"]) != figure["place"]


def test_the_polish_book_speaks_of_couplings_as_railways_do(paths):
    book = load_workbook(paths["pl"], data_only=True)
    words = " ".join(text for sheet in book for text in texts(sheet))
    assert "sprzęg" in words
    assert "przewodzie głównym" in words
    assert "greatest tension of" not in words


@pytest.fixture(scope="module")
def imperial(tmp_path_factory):
    gradient = {"from_m": 820.4000000000001, "to_m": 1746.397525437186, "permille": 1}
    case = {"units": "imperial", "track": {"gradients": [gradient]}}
    folder = tmp_path_factory.mktemp("imperial")
    return load_workbook(write_workbook(fake_results(folder, **case), fake_scenario(**case), folder / "x.xlsx"), data_only=True)


def test_a_case_in_other_units_is_told_in_both(imperial, book, results):
    cover = " ".join(texts(imperial["Cover"]))
    assert "The case asks for mph, kip, in, psi" in cover
    most = results.table("coupling_extremes")["greatest_tension_kn"].max()
    assert f"{most / 4.4482216152605:.1f} kip ({most:.1f} kN)" in cover
    figures = {row["figure"]: row for row in read_table(imperial["Key figures"])}
    assert figures["greatest tension"]["in the units of the case"] == pytest.approx(most / 4.4482216152605)
    stop = figures["stopping distance"]
    assert stop["in the units of the case"] == pytest.approx(stop["value"] / 0.3048)
    assert [figures[name]["unit of the case"] for name in ("greatest tension", "stopping distance")] == ["kip", "ft"]
    rows = read_table(imperial["Coupling forces"], 1)
    assert max(row["tension [kip]"] for row in rows) == pytest.approx(most / 4.4482216152605)
    assert "Units" not in texts(book["Cover"])
    assert "in the units of the case" not in read_table(book["Key figures"])[0]


def test_inputs_have_no_digits_of_a_conversion(imperial):
    (row,) = read_table(imperial["Inputs track"])
    assert (row["from [m]"], row["to [m]"]) == (820.4, 1746.398)


def test_the_loop_follows_every_row_and_cuts_no_corner(book, results):
    rows = read_table(book["Course of couplings"], 2)
    extremes = results.table("coupling_extremes").set_index("coupling")
    name = extremes[["greatest_tension_kn", "greatest_compression_kn"]].max(axis=1)
    table = results.table("couplings").query(f"coupling == '{name.idxmax()}'").set_index("time_s")
    x, y = table["deflection_mm"].to_numpy(float), table["force_kn"].to_numpy(float)
    kept = np.searchsorted(table.index.to_numpy(), [row["time [s]"] - 1e-6 for row in rows])
    assert kept[0] == 0
    assert kept[-1] == len(x) - 1
    at = np.clip(np.searchsorted(kept, np.arange(len(x)), side="right") - 1, 0, len(kept) - 2)
    away = [abs(values - values[kept[at]]) / np.ptp(values) for values in (x, y)]
    behind = [abs(values - values[kept[at + 1]]) / np.ptp(values) for values in (x, y)]
    assert max(np.minimum(*(np.maximum(*each) for each in (away, behind)))) < 0.05


def test_both_axes_of_speeds_and_levels_begin_with_nothing(book, formulas):
    chart = formulas["Charts"]._charts[0]
    speeds, levels = chart, chart._charts[1]
    assert speeds.y_axis.scaling.min == 0.0
    assert levels.y_axis.scaling.min == 0.0
    rows = read_table(book["Course of the train"])
    fastest = max(value for row in rows for key, value in row.items() if key.startswith("speed of"))
    assert speeds.y_axis.scaling.max >= fastest

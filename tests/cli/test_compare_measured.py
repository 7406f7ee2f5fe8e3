"""``tractionpower compare DIR --measured FILE --map MAP.yaml``: tables, reports, exit codes, what is told."""

import json
from pathlib import Path

import pytest
from openpyxl import load_workbook
from read_workbook import read_table, texts
from small_files import write_small_study

from tractionpower.cli import main
from tractionpower.cosimulation.simulate import simulate
from tractionpower.io.scenario_files import load_scenario
from tractionpower.results.results import Results
from tractionpower.studies.measured.study import compare_measured

LINE = Path(__file__).parents[2] / "lines" / "two-substations"
MAP = """format: 1
name: Busbar of Łódź
time: {column: t}
shift_s: 0
series:
  - {column: U, of: substation Łódź, quantity: voltage_v, unit: kV}
  - {column: I, of: feeder A 1 high_km, quantity: current_a}
"""


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    """Return the folder of a run without reports; not to be written into."""
    folder = tmp_path_factory.mktemp("runs")
    study = write_small_study(folder / "small")
    assert main(["run", str(study), "--out", str(folder / "out"), "--no-reports"]) == 0
    return folder / "out"


@pytest.fixture
def compare(run_folder, tmp_path, monkeypatch):
    """Return a function that compares the run with rows of time, voltage [kV], current, in the working folder `tmp_path`."""
    monkeypatch.chdir(tmp_path)

    def command(rows, *options, text=MAP):
        Path("m.csv").write_text("t;U;I\n" + rows, encoding="utf-8")
        Path("map.yaml").write_text(text, encoding="utf-8")
        return main(["compare", str(run_folder), "--measured", "m.csv", "--map", "map.yaml", *options])

    return command


ROWS = "".join(f"{t};3,5;{400 + t}\n" for t in range(60))


def test_tables_and_reports_are_written_and_told(compare, run_folder, tmp_path, capsys):
    assert compare(ROWS) == 0
    told = capsys.readouterr()
    assert "as the map says" in told.out
    assert "substation Łódź voltage_v" in told.out
    folder = tmp_path / "reports" / "small-measured"
    assert f"results: {folder.relative_to(tmp_path)}" in told.err
    results = Results.open(folder)
    assert results.tables == ["measured", "measured_errors"]
    assert (results.run["kind"], results.run["measured"]["file"]) == ("measured", "m.csv")
    row = results.table("measured_errors").iloc[0]
    station = Results.open(run_folder).table("substations").query("substation == 'Łódź'")
    assert row["mean_measured"] == pytest.approx(3500.0)
    assert row["mean_error"] == pytest.approx(station["voltage_v"].astype(float).mean() - 3500.0)
    assert {path.name for path in (folder / "figures").iterdir()} == {
        "substation %C5%81%C3%B3d%C5%BA voltage_v.png",
        "feeder A 1 high_km current_a.png",
    }
    assert compare(ROWS, "--no-reports") == 0  # the same comparison may be replaced
    before = (folder / "compare.xlsx").stat().st_mtime_ns
    assert main(["report", str(folder)]) == 0
    assert (folder / "compare.xlsx").stat().st_mtime_ns != before


def test_json_has_no_words_around_it(compare, capsys):
    assert compare(ROWS, "--json", "--no-reports", "--out", "out") == 0
    document = json.loads(capsys.readouterr().out)
    assert document["format"] == 1
    assert [each["unit"] for each in document["series"]] == ["V", "A"]
    assert document["series"][0]["energy_measured"] is None
    assert not Path("out/compare.xlsx").exists()


def test_faults_are_told_with_file_and_line_and_nothing_is_written(compare, tmp_path, capsys):
    assert compare(ROWS.replace(";3,5;", ";x;")) == 1
    told = capsys.readouterr().err
    assert "m.csv:2" in told
    assert "60 cells of 60 in column 'U' no number, the first 'x'" in told
    assert compare(ROWS, text=MAP.replace("Łódź, q", "Lodz, q").replace("unit: kV", "unit: A")) == 1
    assert "map.yaml:6" in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


def test_warnings_do_not_change_the_exit_code(compare, capsys):
    assert compare(ROWS.replace("3,5", "3500"), "--no-reports") == 0
    assert "it looks like V, where the map says kV" in capsys.readouterr().err


def test_nothing_to_compare_is_not_completed(compare, capsys):
    assert compare("9000;3,5;1\n9001;3,5;2\n") == 3
    assert "no measured value falls on a computed one" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--measured", "m.csv"], "needs both"),
        (["--map", "map.yaml"], "needs both"),
    ],
)
def test_wrong_usage(run_folder, tmp_path, monkeypatch, capsys, options, words):
    monkeypatch.chdir(tmp_path)
    assert main(["compare", str(run_folder), *options]) == 2
    assert words in capsys.readouterr().err


def test_the_run_itself_is_not_replaced(compare, run_folder, capsys):
    assert compare(ROWS, "--out", str(run_folder), "--force") == 2
    assert "holds the run itself" in capsys.readouterr().err
    assert "loads" in Results.open(run_folder).tables


def test_the_shipped_measurement_and_its_clock(tmp_path):
    """It was made with 20 V less and a slightly worse contact line, by a clock 37.3 s ahead, with a gap of 12 s."""
    found = compare_measured(simulate(load_scenario(LINE).scenario), LINE / "measured.csv", LINE / "measured-map.yaml")
    assert found.shift.shift_s == pytest.approx(-37.3, abs=0.5)
    assert found.shift.doubts == ()
    assert [problem.code for problem in found.problems] == ["gap"]
    errors = {each.id: each.errors for each in found.series}
    assert 20.0 < errors["train 2 voltage_v"]["mean_error"] < 40.0
    assert errors["train 2 speed_kmh"]["rms_error"] < 1.0
    assert abs(errors["train 2 power_kw"]["energy_error_percent"]) < 1.0


def test_the_workbook_has_errors_values_and_charts(compare, tmp_path):
    assert compare(ROWS.replace("3,5", "3500"), "--out", "out") == 0
    book = load_workbook(tmp_path / "out" / "compare.xlsx", data_only=True)
    assert book.sheetnames == ["Errors", "Charts", "Values"]
    errors = read_table(book["Errors"])
    assert ("measurement", "Busbar of Łódź") in list(book["Errors"].iter_rows(max_col=2, values_only=True))
    table = Results.open(tmp_path / "out").table("measured_errors")
    assert [row["bias (mean error)"] for row in errors] == pytest.approx(table["mean_error"].tolist())
    assert any("it looks like V" in text for text in texts(book["Errors"]))
    values = read_table(book["Values"])
    assert len(values) == 60
    assert any(value == pytest.approx(400.5) for value in values[0].values())
    assert len(book["Charts"]._charts) == 2

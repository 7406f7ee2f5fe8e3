"""The pages of feasibility and imports: their examples work, and what they name exists."""

import re
from pathlib import Path

import pytest
from openpyxl import load_workbook
from typer.main import get_command

from tractionpower.cli import app, main
from tractionpower.io.imports.kinds import KINDS
from tractionpower.io.imports.tables.headings import HEADINGS, field_of
from tractionpower.io.scenario_files import load_scenario

DOCS = Path(__file__).parents[1] / "docs"
FEASIBILITY, IMPORTS = ((DOCS / f"{page}.md").read_text(encoding="utf-8") for page in ("feasibility", "imports"))
TABLES = re.findall(r"```csv\n(.*?)```", IMPORTS + FEASIBILITY, re.DOTALL)


@pytest.mark.parametrize("number", range(len(TABLES)))
def test_the_timetables_of_the_pages_are_imported_and_check(number, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("plan.csv").write_text(TABLES[number], encoding="utf-8")
    assert main(["import", "timetable", "plan.csv", "my-study", "--line", "two-substations"]) == 0
    assert main(["check", "my-study"]) == 0
    assert "no problems" in capsys.readouterr().out
    runs = load_scenario("my-study").scenario.runs
    assert [run.id for run in runs] == ["R 11", "IC 13"]
    assert [run.train for run in runs] == ["en57", "ed250"]


def test_three_timetables_are_shown():
    assert len(TABLES) == 3


def test_commands_and_options_of_the_pages_exist():
    commands = get_command(app).commands
    for name, arguments in re.findall(r"^tractionpower (\S+)(.*)$", FEASIBILITY + IMPORTS, re.MULTILINE):
        known = {option for parameter in commands[name].params for option in parameter.opts}
        assert set(re.findall(r"--[a-z-]+", arguments.partition('"')[0])) <= known
    options = {option for name in ("feasibility", "import") for each in commands[name].params
               for option in (*each.opts, *each.secondary_opts)}  # fmt: skip
    assert set(re.findall(r"`(--[a-z-]+)", FEASIBILITY + IMPORTS)) - {"--set"} <= options


def test_every_kind_is_described():
    rows = "".join(re.findall(r"^\| `.*$", IMPORTS, re.MULTILINE))
    assert set(re.findall(r"`(\w+)`", rows.replace("timetable.yaml", ""))) >= set(KINDS)


def test_headings_of_the_page_stand_for_their_fields():
    section = IMPORTS.partition("### Headings")[2].partition("###")[0]
    rows = re.findall(r"^\| (\w+)[^|]*\| ([^|]+) \|$", section, re.MULTILINE)
    told = {name: words for name, words in rows if name in HEADINGS}
    assert set(HEADINGS) - set(told) == {"km", "departure"}  # departure stands beside arrival
    for name, words in told.items():
        for word in re.split(r"[,;] ", words.partition("; cells")[0]):
            assert field_of(word) in {name, "departure" if name == "arrival" else name}, word


def test_the_sheets_and_figures_that_the_page_names_exist():
    from tractionpower.reporting.figures.of_run import GRAPHS, SINGLE  # noqa: PLC0415

    named = {name.removesuffix(".png") for name in re.findall(r"`(\w+\.png)`", FEASIBILITY)}
    assert named == {"delay_graph", "lost_time", "delays_by_cause"}
    assert named <= {*GRAPHS, *SINGLE}


def test_excel_and_csv_of_a_timetable_are_the_same(tmp_path, monkeypatch):
    from openpyxl import Workbook  # noqa: PLC0415

    monkeypatch.chdir(tmp_path)
    book = Workbook()
    for row in TABLES[0].splitlines():
        book.active.append(row.split(";"))
    book.save("plan.xlsx")
    assert load_workbook("plan.xlsx").active.max_row == 7
    Path("plan.csv").write_text(TABLES[0], encoding="utf-8")
    for kind in ("xlsx", "csv"):
        assert main(["import", "timetable", f"plan.{kind}", kind, "--line", "two-substations"]) == 0
    assert load_scenario("xlsx").scenario.timetable == load_scenario("csv").scenario.timetable

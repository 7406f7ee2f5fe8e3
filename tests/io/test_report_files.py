import ast
from pathlib import Path

import pytest
from PIL import Image

import tractionpower
from tractionpower.errors import InputError
from tractionpower.io.report_files import REPORT_FILE, errors_of_figures, is_edited, keep_report, kept_report, read_report
from tractionpower.io.scenario_files import load_scenario, read_scenario, save_scenario
from tractionpower.io.templates import write_template
from tractionpower.model.report import FIGURES, SHEETS, Document, Report, ReportFigures
from tractionpower.reporting.figures.registry import figure_names


def problems(path):
    with pytest.raises(InputError) as caught:
        read_report(path)
    return caught.value.problems


@pytest.fixture
def template(tmp_path):
    """Return a function that writes a template."""

    def write(text):
        path = tmp_path / "office.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def logo(tmp_path):
    path = tmp_path / "pictures" / "logo.png"
    path.parent.mkdir()
    Image.new("RGB", (60, 20), "navy").save(path)
    return path


def test_a_template_is_read_and_its_logo_found_beside_it(template, logo):
    read = read_report(template("company: Office & Sons\nlogo: pictures/logo.png\nlanguage: pl\ndocument: {number: 7-A}\n"))
    assert read.problems == ()
    assert (read.report.company, read.report.language, read.report.document.number) == ("Office & Sons", "pl", "7-A")
    assert Path(read.report.logo).samefile(logo)


def test_all_that_is_wrong_is_told_at_once_with_its_line(template):
    text = """company: Office
logo: none.png
langage: pl
paper: a5
sheets: [Cover, Acceptence]
document: {revison: B}
figures: {formats: [png, gif]}
language: fr
"""
    told = {(problem.place.rpartition(":")[2], problem.code) for problem in problems(template(text))}
    lines = {line for line, _ in told}
    assert lines == {"2", "3", "4", "5", "6", "7", "8"}
    assert {("2", "missing_file"), ("3", "unknown_key"), ("5", "unknown_sheet"), ("6", "unknown_key")} <= told
    by_line = {problem.place.rpartition(":")[2]: problem for problem in problems(template(text))}
    assert "language" in by_line["3"].remedy
    assert "Acceptance" in by_line["5"].remedy
    assert by_line["8"].allowed == "en | pl"
    assert all(problem.found and problem.allowed for problem in by_line.values())


def test_an_unknown_sheet_is_a_warning_that_names_those_known(template):
    (problem,) = read_report(template("leave_out: [Trains, Trainz, acceptance]\n")).problems
    assert (problem.severity, problem.path) == ("warning", "report.leave_out[1]")
    assert "did you mean Trains?" in problem.remedy
    assert "Trains" in problem.allowed
    assert len(problem.allowed) < 150  # and not the names of all sheets, for each mistake


def test_an_unknown_figure_is_told_with_its_line(template):
    text = "figures:\n  names:\n    - train_graph\n    - train_grap\n    - trains/7\n    - curves_ed250\n    - demand_2\n"
    (problem,) = read_report(template(text)).problems
    assert (problem.severity, problem.place.rpartition(":")[2]) == ("warning", "4")
    assert problem.remedy == "did you mean train_graph?"


def test_what_hinders_figures_is_an_error_before_anything_is_computed(template):
    read = read_report(template("figures: {names: [train_grap, trains/7, trains/8]}\n"))
    errors = errors_of_figures(read.report, read.problems, ["7", "70"])
    assert [(error.found, error.severity) for error in errors] == [("'train_grap'", "error"), ("'trains/8'", "error")]


def test_every_figure_that_the_program_names_is_known():
    assert set(figure_names()) <= set(FIGURES), "put them into FIGURES of tractionpower.model.report"
    schema = Report.model_json_schema()
    assert schema["properties"]["sheets"]["examples"] == [list(SHEETS)]
    assert schema["$defs"]["ReportFigures"]["properties"]["names"]["examples"] == [list(FIGURES)]


@pytest.mark.parametrize("date", ["2026-11-22", "22.11.2026", "22 listopada 2026 r.", "Q4 2026"])
def test_a_date_is_written_as_the_office_does(template, date):
    assert read_report(template(f"document: {{date: {date}}}\n")).report.document.date == date


@pytest.mark.parametrize("date", ["tomorrow", "2026-02-30", "22.11.26"])
def test_what_has_no_year_and_a_day_that_is_none_are_no_dates(template, date):
    assert [problem.path for problem in problems(template(f"document: {{date: {date}}}\n"))] == ["report.document.date"]


def test_an_empty_list_of_sheets_is_a_mistake(template):
    assert [problem.path for problem in problems(template("sheets: []\nleave_out: [Cover]\n"))] == ["report.sheets"]


def test_names_in_another_language_are_left_to_the_reports_unless_they_look_misspelt(template):
    read = read_report(template("language: pl\nsheets: [Pociągi, Acceptence]\n"))
    assert [problem.found for problem in read.problems] == ["'Acceptence'"]


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("logo.png", b"no picture at all", "not_a_picture"),
        ("logo.png", b"\x89PNG\r\n\x1a\n then nothing", "not_a_picture"),
        ("logo.png", b"", "not_a_picture"),
        ("logo.svg", b"<svg xmlns='http://www.w3.org/2000/svg'/>", "not_a_picture"),
        ("logo.png", b"x" * 5_000_001, "file_too_large"),
    ],
)
def test_a_logo_that_no_cover_can_show_is_a_problem(template, tmp_path, name, content, code):
    (tmp_path / name).write_bytes(content)
    (problem,) = problems(template(f"logo: {name}\n"))
    assert (problem.code, problem.path, problem.place.rpartition(":")[2]) == (code, "report.logo", "1")


def test_a_picture_of_another_kind_and_a_broken_one_are_refused(template, tmp_path, logo):
    Image.new("RGB", (9, 9)).save(tmp_path / "logo.gif")
    (problem,) = problems(template("logo: logo.gif\n"))
    assert "GIF" in problem.found
    whole = logo.read_bytes()
    logo.write_bytes(whole[: len(whole) // 2])
    assert [problem.code for problem in problems(template("logo: pictures/logo.png\n"))] == ["not_a_picture"]


def test_a_folder_is_no_logo(template, logo):
    assert [problem.code for problem in problems(template("logo: pictures\n"))] == ["missing_file"]


def test_every_sheet_that_the_program_names_is_known():
    named = set()
    for file in (Path(tractionpower.__file__).parent / "reporting" / "workbook").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "page" and node.args:
                if isinstance(node.args[0], ast.Constant):
                    named.add(node.args[0].value)
    assert len(named) > 30
    assert named <= set(SHEETS), "put them into SHEETS of tractionpower.model.report"


def full_report(logo):
    return Report(
        company="=Office #1: & <Sons>",
        logo=str(logo),
        language="pl",
        document=Document(title='A "title"', made_by="no"),
        assumptions=("Line one\nline two", "- dash"),
        sheets=("Cover", "Trains"),
        figures=ReportFigures(formats=("svg",), names=("train_graph",)),
    )


def test_a_kept_template_and_its_logo_are_the_same_when_read_again(tmp_path, logo):
    report, folder = full_report(logo), tmp_path / "results"
    assert keep_report(report, folder)
    logo.unlink()
    read = kept_report(folder).report
    assert Path(read.logo).parent == folder
    assert read.model_copy(update={"logo": report.logo}) == report
    assert keep_report(read, folder), "its own logo is not copied onto itself"
    assert kept_report(folder).report == read


def test_what_someone_has_edited_stays(tmp_path, logo):
    keep_report(full_report(logo), tmp_path)
    file = tmp_path / REPORT_FILE
    assert not is_edited(file)
    file.write_text(file.read_text(encoding="utf-8").replace("Trains", "Events"), encoding="utf-8")
    assert is_edited(file)
    assert not keep_report(Report(company="Other"), tmp_path)
    assert kept_report(tmp_path).report.sheets == ("Cover", "Events")


def test_without_a_template_none_is_kept_and_one_of_before_goes(tmp_path, logo):
    assert kept_report(tmp_path) is None
    keep_report(full_report(logo), tmp_path)
    assert keep_report(Report(), tmp_path)
    assert kept_report(tmp_path) is None


@pytest.fixture
def study(tmp_path):
    write_template(tmp_path / "study")
    return tmp_path / "study"


def test_the_template_of_a_study_is_no_part_of_its_scenario(study, tmp_path):
    before = load_scenario(study)
    assert before.report == Report()
    (study / "report.yaml").write_text("company: Office\n", encoding="utf-8")
    after = load_scenario(study)
    assert after.report == Report(company="Office")
    assert after.scenario.input_hash == before.scenario.input_hash
    save_scenario(after.scenario, tmp_path / "saved")
    assert load_scenario(tmp_path / "saved").report is None


def test_a_wrong_template_of_a_study_is_told_with_the_rest(study):
    (study / "report.yaml").write_text("company: Office\nlanguage: xx\nsheets: [Nonsense]\n", encoding="utf-8")
    (study / "line.yaml").write_text("formt: 1\n", encoding="utf-8")
    loaded, found = read_scenario(study)
    assert loaded is None
    assert {"report.yaml:2", "report.yaml:3", "line.yaml:1"} <= {problem.place for problem in found}


def test_a_template_that_is_not_there_is_told_where_it_is_named(study):
    (study / "report.yaml").unlink()
    _, (problem,) = read_scenario(study)
    assert problem.code == "missing_file"
    assert problem.place.startswith("study.yaml:")

"""The options for the look of reports, the template that results keep, and which of several wins."""

import pytest

from tractionpower.cli.look import Look, look_of
from tractionpower.errors import InputError, UsageError
from tractionpower.io.report_files import REPORT_FILE, kept_report
from tractionpower.model.report import Report

OFFICE, STUDY = Report(company="Office"), Report(company="Study")


def edit(folder):
    (folder / REPORT_FILE).write_text("company: Edited\n", encoding="utf-8")


def test_without_anything_reports_are_english_and_nothing_is_kept(tmp_path):
    assert Look().report(tmp_path) == Report()
    assert list(tmp_path.iterdir()) == []


def test_new_results_follow_their_study_and_keep_its_template(tmp_path):
    assert Look().report(tmp_path, STUDY).company == "Study"
    assert kept_report(tmp_path).report == STUDY
    newer = Report(company="Study of today")
    assert Look().report(tmp_path, newer) == newer, "what was kept of an earlier run does not count"


def test_reports_made_later_look_as_before(tmp_path):
    Look(OFFICE).report(tmp_path, STUDY)
    assert Look().report(tmp_path, is_new=False) == OFFICE


@pytest.mark.parametrize("is_new", [True, False])
def test_what_someone_has_edited_in_the_results_wins_over_the_study(tmp_path, is_new):
    Look().report(tmp_path, STUDY)
    edit(tmp_path)
    assert Look().report(tmp_path, STUDY, is_new=is_new).company == "Edited"


def test_the_option_wins_over_everything_and_an_edited_file_stays(tmp_path, capsys):
    edit(tmp_path)
    assert Look(OFFICE).report(tmp_path, STUDY) == OFFICE
    assert kept_report(tmp_path).report.company == "Edited"
    assert "was edited and stays" in capsys.readouterr().err


def test_the_language_of_the_option_is_that_of_the_reports(tmp_path):
    assert Look(OFFICE, "pl").report(tmp_path).language == "pl"
    assert Look().report(tmp_path, is_new=False).language == "pl"


def test_reports_that_go_elsewhere_change_no_template(tmp_path):
    Look(OFFICE).report(tmp_path, keep=False)
    assert kept_report(tmp_path) is None


def test_a_mistake_is_told_before_anything_is_computed(tmp_path):
    with pytest.raises(UsageError, match="known are en, pl"):
        look_of(None, "fr")
    (tmp_path / "t.yaml").write_text("paper: a5\n", encoding="utf-8")
    with pytest.raises(InputError):
        look_of(tmp_path / "t.yaml", None)
    with pytest.raises(InputError, match="there is no file"):
        look_of(tmp_path / "none.yaml", None)

"""Every check of every reference case that ships, one test each."""

import pytest

from tractionpower.io.documents import read_document
from tractionpower.studies.validation import CASE_FILE, Case, Finding, find_cases, run_case

CASES = find_cases()
CHECKS = [(folder, check.title) for folder in CASES for check in read_document(folder / CASE_FILE, Case).checks]
_done: dict[str, list[Finding]] = {}


def findings_of(folder):
    if folder.name not in _done:
        _done[folder.name] = list(run_case(folder))
    return _done[folder.name]


@pytest.mark.parametrize(("folder", "title"), CHECKS, ids=[f"{folder.name}: {title}" for folder, title in CHECKS])
def test_check(folder, title):
    findings = [finding for finding in findings_of(folder) if finding.check == title]
    assert len(findings) > 1
    missed = [f"{f.figure} {f.form}: expected {f.expected}, computed {f.computed}" for f in findings if not f.met]
    assert missed == []


@pytest.mark.parametrize("folder", CASES, ids=lambda folder: folder.name)
def test_a_case_names_its_source(folder):
    text = (folder / "README.md").read_text(encoding="utf-8")
    case = read_document(folder / CASE_FILE, Case)
    assert len(text) > 100
    assert case.source
    titles = [check.title for check in case.checks]
    assert len(set(titles)) == len(titles)


@pytest.mark.parametrize(
    ("expected", "computed", "met"),
    [(1.0, 1.09, True), (1.0, 0.89, False), (1.0, float("nan"), False), ("complete", "flagged", False), ("a", "a", True)],
)  # fmt: skip
def test_a_finding_is_met_within_its_tolerance(expected, computed, met):
    assert Finding("case", "check", "figure", expected, computed, 0.1, "source").met is met

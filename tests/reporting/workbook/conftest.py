"""Workbooks of made-up results, written once and read back."""

import pytest
from fake_results import make_case
from openpyxl import load_workbook

from tractionpower.reporting.workbook import write_workbook


@pytest.fixture(scope="session")
def case():
    return make_case()


@pytest.fixture(scope="session")
def small_file(case, tmp_path_factory):
    return write_workbook(*case, tmp_path_factory.mktemp("small") / "report.xlsx")


@pytest.fixture(scope="session")
def small(small_file):
    return load_workbook(small_file)


@pytest.fixture(scope="session")
def small_values(small_file):
    """Return the same workbook with the values that its formulas come to."""
    return load_workbook(small_file, data_only=True)


@pytest.fixture(scope="session")
def nasty_file(tmp_path_factory):
    return write_workbook(*make_case(trains=8, nasty=True), tmp_path_factory.mktemp("nasty") / "report.xlsx")


@pytest.fixture
def write(tmp_path):
    """Return a function that writes results and reads the workbook back."""
    return lambda results, scenario: load_workbook(write_workbook(results, scenario, tmp_path / "report.xlsx"))

"""The workbook of a study of ratings, with its formulas and with what they come to."""

import pytest
from fake_results import make_case
from fake_sizing import sized
from openpyxl import load_workbook

from tractionpower.model.ratings import DutyRow
from tractionpower.reporting.workbook import write_workbook


@pytest.fixture(scope="session")
def study():
    results, scenario = make_case(substations=9, hours=2.0)
    multiples = {10.0: 3.0, 60.0: 2.0, 900.0: 1.7, 7200.0: 1.5, 0.0: 1.0}
    rows = [DutyRow(duty_class="VI", window_s=window, multiple=multiple) for window, multiple in multiples.items()]
    scenario = scenario.model_copy(update={"duty_classes": tuple(rows)})
    return sized(results, scenario), scenario


@pytest.fixture(scope="session")
def sized_file(study, tmp_path_factory):
    return write_workbook(*study, tmp_path_factory.mktemp("sized") / "report.xlsx")


@pytest.fixture(scope="session")
def formulas(sized_file):
    return load_workbook(sized_file)


@pytest.fixture(scope="session")
def book(sized_file):
    """Return the workbook with the values that its formulas come to."""
    return load_workbook(sized_file, data_only=True)

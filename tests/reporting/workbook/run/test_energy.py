import re

import pytest
from fake_results import LEDGERS
from openpyxl.utils import range_boundaries


def evaluate(sheet, cell):
    """Compute the few formulas that the sheet has."""
    formula = sheet[cell].value
    if match := re.fullmatch(r'=SUMIF\((\S+),"(\w+)",(\S+)\)', formula):
        sides, values = (
            [sheet.cell(row, left).value for row in range(top, bottom + 1)]
            for left, top, _, bottom in (range_boundaries(match[1]), range_boundaries(match[3]))
        )
        return sum(value for side, value in zip(sides, values, strict=True) if side == match[2])
    given, spent = re.fullmatch(r"=(C\d+)-(C\d+)", formula).groups()
    return evaluate(sheet, given) - evaluate(sheet, spent)


def sums(sheet):
    rows = [row for row in range(1, sheet.max_row + 1) if sheet.cell(row, 2).value in ("sum given", "sum spent", "gap")]
    return [evaluate(sheet, f"C{row}") for row in rows]


def test_sums_and_gaps_are_live(small):
    electric, pantograph, mechanical = LEDGERS["electric"], LEDGERS["pantograph_to_wheel"], LEDGERS["mechanical"]
    expected = [
        electric["source_kwh"], 100.0 + 1600.0 + 200.0 + 100.125, 0.0,
        pantograph["line_kwh"] + pantograph["recovered_kwh"], 1300.0 + 250.0 + 30.0 + 120.0, 0.0,
        mechanical["wheel_kwh"], 100.0 + 50.0 + 850.0 + 300.0, 0.0,
    ]  # fmt: skip
    assert sums(small["Energy"]) == pytest.approx(expected, abs=1e-9)


def test_a_ledger_without_trains_needs_no_trains(case, write):
    results, scenario = case
    ledger = {key: value for key, value in LEDGERS["electric"].items() if key != "train_kwh"} | {"load_kwh": 1800.0}
    run = results.run | {"ledgers": {"electric": ledger}}
    sheet = write(type(results)(run, results.key_figures, results._source), scenario)["Energy"]
    assert sums(sheet) == pytest.approx([2000.125, 2000.125, 0.0], abs=1e-9)

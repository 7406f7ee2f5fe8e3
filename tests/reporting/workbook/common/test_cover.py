import pytest
from fake_results import VERDICTS, changed
from read_workbook import texts

from tractionpower.reporting.workbook.common.cover import verdict_sentence

GREEN, RED = "C6EFCE", "FFC7CE"


def test_a_verdict_is_a_sentence():
    assert verdict_sentence(VERDICTS[1]) == (
        "Highest voltage: 3951 V (km 12.3, track 1, 06:12:33); limit U_max2 = 3900 V: violated. Checked against an editable"
        " value, secondary: from a source that quotes it (a page)."
    )


@pytest.mark.parametrize("status", ["secondary", "recalled", "user", "", None])
def test_a_value_that_is_not_verified_is_called_editable(status):
    sentence = verdict_sentence(VERDICTS[0] | {"status": status})
    assert "editable value" in sentence
    assert "compl" not in sentence.lower()


def test_a_verified_value_and_a_missing_one():
    assert "editable" not in verdict_sentence(VERDICTS[0] | {"status": "verified"})
    assert "not judged" in verdict_sentence(VERDICTS[0] | {"value": None, "met": None})


def test_the_cover_tells_the_violated_limit_in_red(small):
    cover = small["Cover"]
    told = {cell.value: cell.fill.start_color.rgb[-6:] for (cell,) in cover.iter_rows(min_col=2, max_col=2) if cell.value}
    assert told["1 of 3 limits violated: highest voltage"] == RED
    assert told[verdict_sentence(VERDICTS[0])] == GREEN
    assert told[verdict_sentence(VERDICTS[1])] == RED
    assert "4 trains: 3 left the line, 1 still on the line at the end." in told
    assert "2 times two trains were on the same place of a track" in told


def test_all_limits_met_is_said(case, write):
    results, scenario = case
    book = write(changed(results, verdicts=[VERDICTS[0], VERDICTS[2]]), scenario)
    assert "All 2 limits are met; 2 of their values are editable, not verified" in texts(book["Cover"])


@pytest.mark.parametrize(
    ("status", "words"), [("flagged", "Flagged: 3 of 1800 steps"), ("interrupted", "Interrupted after 1800")]
)
def test_a_run_that_is_not_complete_says_so_in_red(case, write, status, words):
    results, scenario = case
    cover = write(changed(results, status=status, flagged_steps=3), scenario)["Cover"]
    cell = next(cell for (cell,) in cover.iter_rows(min_col=2, max_col=2) if str(cell.value).startswith(words))
    assert cell.fill.start_color.rgb.endswith(RED)


def test_a_ledger_that_does_not_close_says_so(case, write):
    results, scenario = case
    open_ledger = {"electric": results.run["ledgers"]["electric"] | {"closes": False, "worst_gap_w": 12.0}}
    assert "Does not close: worst gap 12 W." in texts(write(changed(results, ledgers=open_ledger), scenario)["Cover"])


@pytest.mark.parametrize("volts", [2900, None])
def test_the_simplified_coupling_is_named_with_its_voltage(case, write, volts):
    results, scenario = case
    book = write(changed(results, coupling="constant_voltage", coupling_voltage_v=volts), scenario)
    assert any(f"constant voltage of {volts or 3000} V" in text and "simplification" in text for text in texts(book["Cover"]))


def test_links_lead_to_all_other_sheets(small):
    cover = small["Cover"]
    targets = [cell.hyperlink.location for (cell,) in cover.iter_rows(max_col=1) if cell.hyperlink]
    assert targets == [f"'{name}'!A1" for name in small.sheetnames[1:]]

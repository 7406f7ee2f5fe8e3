import pytest
from fake_results import LEDGERS, changed
from fake_sizing import outages, table
from read_workbook import exactly, read_table, texts

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.common import evidence
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.results.results import Results

SHEET = "Solver evidence"


def shown(results, scenario):
    """Return the sheet with the values that stand beside its formulas."""
    book = Book(Facts(results, scenario), Report())
    evidence.add(book)
    book.finish()
    sheet = book.workbook[SHEET]
    for place, value in book.cached[SHEET].items():
        sheet[place].value = value
    return sheet


def test_the_sheet_tells_residual_iterations_and_steps(small, case):
    rows = {row["what"]: row["value"] for row in read_table(small[SHEET], 1)}
    run = case[0].run
    assert rows["largest current that does not balance at a node, of all steps"] == run["worst_residual_a"]
    assert rows["mean number of iterations in a step"] == run["mean_iterations"]
    assert rows["time steps computed"] == run["steps"]


@pytest.mark.parametrize(("residual", "word"), [(3e-7, "accepted"), (2e-3, "flagged")])
def test_the_verdict_on_the_residual_is_a_formula_on_its_limit(case, small, residual, word):
    results, scenario = case
    assert word in texts(shown(changed(results, worst_residual_a=residual), scenario))
    assert any(str(cell).startswith("=IF(worst_residual_a<=residual_limit_a") for cell in texts(small[SHEET]))


def test_ledgers_are_summed_by_formulas(small, case):
    live = {row["ledger"]: row for row in read_table(small[SHEET], 3)}
    assert live["Electric"]["given [kWh]"].startswith("=SUM(")
    told = {row["ledger"]: row for row in read_table(shown(*case), 3)}
    electric = LEDGERS["electric"]
    spent = sum(electric[f"{name}_kwh"] for name in ("regulation", "train", "load", "conductor"))
    assert told["Electric"]["spent [kWh]"] == exactly(spent)
    assert told["Electric"]["gap of the sums [kWh]"] == electric["source_kwh"] - spent == 0.0
    assert (told["Electric"]["sums"], told["Electric"]["judged by the program"]) == ("in balance", "closes")
    assert (told["Mechanical"]["allowed"], told["Pantograph to wheel"]["allowed"]) == (1e-3, 1e-6)


def test_sums_that_differ_are_said_to(case):
    results, scenario = case
    electric = LEDGERS["electric"] | {"train_kwh": 1500.0, "closes": False}
    row = next(row for row in read_table(shown(changed(results, ledgers=LEDGERS | {"electric": electric}), scenario), 3))
    assert row["gap of the sums [kWh]"] == pytest.approx(100.0)
    assert row["gap / given"] == pytest.approx(100.0 / 2000.125)
    assert (row["sums"], row["judged by the program"]) == ("not in balance", "does not close")


def test_the_parts_are_those_of_run_json(small):
    rows = {row["ledger, part"]: row for row in read_table(small[SHEET], 2)}
    assert rows["Electric: sum of E I of the substations"]["given [kWh]"] == LEDGERS["electric"]["source_kwh"]
    assert rows["Mechanical: change of potential energy"]["spent [kWh]"] == 50.0
    assert rows["Pantograph to wheel: from the electric brake"]["given [kWh]"] == 100.0


def test_flagged_steps_are_listed_with_time_and_residual(case, sheets):
    results, scenario = case
    assert any(text.startswith("None: every step balances") for text in texts(sheets(evidence, results, scenario)[SHEET]))
    told = "06:06:40 to 06:06:41: a node balances within 0.25 A only; the best solution found is given"
    row = {"time_s": 22000.0, "kind": "not_converged", "subject": "network", "track": "", "position_km": float("nan")}
    row |= {"value": 0.25, "limit": 1e-3, "message": told}
    own = dict(results._source) | {"events": table("events", [row])}
    flagged = Results(results.run | {"status": "flagged", "flagged_steps": 1}, results.key_figures, own)
    sheet = sheets(evidence, flagged, scenario)[SHEET]
    (found,) = [row for row in read_table(sheet, 4)]
    assert (found["begins"] * 86400.0, found["found"], found["limit"], found["kind"]) == (22000.0, 0.25, 1e-3, "not converged")
    assert any(text.startswith("Flagged: the run is complete") for text in texts(sheet))


def test_files_can_be_matched(case, sheets):
    results, scenario = case
    files = {"trains.parquet": {"size": 123456, "sha256": "ab" * 32}, "events.parquet": {"size": 77, "sha256": "cd" * 32}}
    sheet = sheets(evidence, changed(results, files=files), scenario)[SHEET]
    rows = read_table(sheet, len(sheet.tables))
    assert [(row["file"], row["size [bytes]"], row["SHA-256"]) for row in rows] == [
        (name, told["size"], told["sha256"]) for name, told in sorted(files.items())
    ]
    assert any(scenario.input_hash in text for text in texts(sheet))


def test_an_interrupted_run_and_a_study_of_cases_say_so(case, sheets):
    results, scenario = case
    told = texts(sheets(evidence, changed(results, status="interrupted"), scenario)[SHEET])
    assert any(text.startswith("Interrupted: the run was stopped") for text in told)
    counts = {"all": 7, "complete": 5, "flagged": 1, "refused": 0, "failed": 1, "reused": 2}
    made = outages(scenario)
    sheet = sheets(evidence, Results(made.run | {"cases": counts}, made.key_figures, made._source), scenario)[SHEET]
    rows = {row["what"]: row["value"] for row in read_table(sheet, 1)}
    assert (rows["cases"], rows["failed"], rows["taken from an earlier study of the same inputs"]) == (7, 1, 2)

from fake_results import VERDICTS
from read_workbook import read_table


def test_verdicts_have_value_limit_source_and_status(small):
    rows = read_table(small["Limits"])
    assert [row["verdict"] for row in rows] == ["met", "violated", "met"]
    for row, verdict in zip(rows, VERDICTS, strict=True):
        assert (row["found"], row["limit value"]) == (verdict["value"], verdict["limit_value"])
        assert row["limit"].lower() == verdict["limit"]
        assert row["source of the limit"] == verdict["source"]
        assert row["status of the limit"].startswith(verdict["status"])


def test_verdicts_are_coloured_by_their_word(small):
    rules = {
        rule.formula[0]: rule.dxf.fill.bgColor.rgb[-6:]
        for rules in small["Limits"].conditional_formatting
        for rule in rules.rules
    }
    assert rules['"met"'] == "C6EFCE"
    assert rules['"violated"'] == "FFC7CE"


def test_limits_as_used_are_those_of_the_system(small, case):
    used = [limit for limit in case[1].limits if limit.system == "dc3000"]
    rows = read_table(small["Inputs limits"])
    assert [(row["name"], row["value"], row["source"]) for row in rows] == [(li.name, li.value, li.source) for li in used]

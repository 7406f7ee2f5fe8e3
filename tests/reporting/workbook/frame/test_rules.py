from openpyxl import Workbook

from tractionpower.reporting.workbook.frame.formulas import Names
from tractionpower.reporting.workbook.frame.rules import Rule


def test_a_rule_refers_to_a_name_or_else_to_its_value():
    sheet, names = Workbook().active, Names()
    rule = Rule(sheet, "C3:C9", "{cell}<{limit_u_min2}", "FFC7CE", {"limit_u_min2": 2000.0})
    rule.write(names)
    names.define("limit_u_min2", sheet, "A1")
    rule.write(names)
    found = [each.formula[0] for area in sheet.conditional_formatting for each in area.rules]
    assert found == ["AND(ISNUMBER(C3),C3<2000)", "AND(ISNUMBER(C3),ISNUMBER(limit_u_min2),C3<limit_u_min2)"]

"""Every formula of the workbook of a real run, computed by another program, and against the tables."""

from office import complaints, formulas_agree, needs_office


def test_nothing_to_repair(rich):
    assert complaints(rich.path) == []


@needs_office
def test_another_program_comes_to_the_same_values(rich):
    assert formulas_agree(rich.path) == []

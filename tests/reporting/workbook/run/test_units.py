import pytest
from read_workbook import read_table

from tractionpower.model.scenario import Scenario


def test_units_share_the_current_of_their_substation(rich):
    rows = {row["substation"]: row for row in read_table(rich.values["Units"])}
    for name, units in (("A", 2), ("M", 1), ("B", 2)):
        highest, rms = (rich.figure(f"{which}_current_a", f"substation {name}") for which in ("highest", "rms"))
        assert rows[name]["in service"] == units
        assert rows[name]["highest current of a unit [A]"] == pytest.approx(highest / units, rel=1e-12)
        assert rows[name]["RMS of its rated current [%]"] == pytest.approx(100.0 * rms / units / 800.0, rel=1e-12)


def test_units_that_events_switch_are_not_shared_out(rich, write):
    told = rich.scenario.model_dump()
    told["supply"]["switch_events"] = [{"time": 100.0, "device": "A", "units_in_service": 1}]
    rows = {row["substation"]: row for row in read_table(write(rich.results, Scenario.model_validate(told))["Units"])}
    assert rows["A"]["highest current of a unit [A]"] is None
    assert rows["B"]["highest current of a unit [A]"] is not None


def test_plants_without_units_have_no_sheet(small):
    assert "Units" not in small.sheetnames

import pytest
from fake_results import TRAIN_FIGURES
from openpyxl.utils import range_boundaries
from read_workbook import exactly, read_table

from tractionpower.model.line import Line
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Part
from tractionpower.reporting.workbook.run.trains import ENERGIES, formation_in_words, route_in_words

SHOWN = {
    "energy_taken_kwh": "energy taken [kWh]",
    "highest_current_a": "highest current [A]",
    "lowest_pantograph_voltage_v": "lowest voltage [V]",
    "mean_useful_voltage_current_weighted_v": "mean useful voltage [V]",
    "late_at_end_s": "late at end [s]",
    "length_km": "length [km]",
}


def test_figures_of_trains_are_those_of_the_run(small_values, case):
    rows = {row["train"]: row for row in read_table(small_values["Trains"])}
    for number in ("1000", "1003"):
        for name, heading in SHOWN.items():
            assert rows[number][heading] == exactly(case[0].key_figure(name, f"train {number}"))
        # a time is kept as a part of a day
        assert rows[number]["running time [h:min:s]"] == pytest.approx(
            case[0].key_figure("running_time_s", f"train {number}"), abs=0.5
        )


def test_every_energy_of_a_train_has_a_column():
    energies = {name for name in TRAIN_FIGURES if name.endswith("_kwh")}
    assert set(ENERGIES.values()) == energies


def test_a_row_says_from_where_to_where_and_what_became_of_it(small):
    row = read_table(small["Trains"])[1]
    assert (row["from"], row["to"], row["formation"]) == ("Łódź Bravo", "Alfa", "local")
    assert (row["entered"], row["left"], row["what became of it"]) == (22050.0, 23550.0, "left the line")


def test_low_voltages_are_coloured_by_the_limits_of_the_study(small):
    rules = [rule for area in small["Trains"].conditional_formatting for rule in area.rules]
    tests = {(rule.formula[0].split("<")[-1], rule.dxf.fill.bgColor.rgb[-6:]) for rule in rules if "<" in rule.formula[0]}
    assert ("limit_u_min2-N(tolerance_u_min2))", "FFC7CE") in tests
    assert not [colour for _, colour in tests if colour != "FFC7CE"]  # below the nominal voltage is nothing to warn of


def below(sheet):
    """Return the row of sums below the table, by heading."""
    (table,) = sheet.tables.values()
    left, top, right, bottom = range_boundaries(table.ref)
    heads, sums = (next(sheet.iter_rows(row, row, left, right, values_only=True)) for row in (top, bottom + 1))
    assert sums[0] == "sum"
    return dict(zip(heads, sums, strict=True))


def test_sums_of_energies_are_those_of_the_trains(rich):
    rows, found = rich.results.table("trains"), below(rich.values["Train energy"])
    power = rows["power_kw"].astype(float) / 3600.0
    assert found["taken [kWh]"] == pytest.approx(power.clip(lower=0.0).sum(), rel=1e-5)
    assert found["returned [kWh]"] == pytest.approx(-power.clip(upper=0.0).sum(), rel=1e-5)
    assert found["net [kWh]"] == pytest.approx(power.sum(), rel=1e-5)
    assert below(rich.formulas["Train energy"])["taken [kWh]"].startswith("=SUM(F")


def test_the_specific_energy_counts_the_mass_with_load(small_values, case):
    # 2 railcars of 100 t with half of 20 t each
    for row in read_table(small_values["Train energy"]):
        place = f"train {row['train']}"
        net = case[0].key_figure("energy_taken_kwh", place) - case[0].key_figure("energy_returned_kwh", place)
        assert row["mass [t]"] == pytest.approx(220.0)
        specific = 1000.0 * net / (220.0 * case[0].key_figure("length_km", place))
        assert row["net, specific [Wh/(t km)]"] == pytest.approx(specific)


def test_the_category_of_a_run_goes_before_that_of_its_train(rich):
    assert [row["category"] for row in read_table(rich.values["Train energy"])] == ["–", "express", "Express"]


def test_a_formation_in_words():
    parts = (Part(id="eu07"), Part(id="coach", count=7, load_percent=60.0), Part(id="en57", powered=False))
    assert formation_in_words(parts) == "1 × eu07 + 7 × coach, 60 % loaded + 1 × en57, hauled"


@pytest.mark.parametrize(
    ("from_km", "place"), [(10.0, "track 1, km 10"), (20.04, "Bravo"), (20.06, "track 1, km 20.06"), (30.0, "track 1, km 30")]
)
def test_a_route_without_calls_is_told_by_its_ends(from_km, place):
    route = [{"track": "1", "from_km": from_km, "to_km": 0.0}]
    run = TrainRun.model_validate({"id": "1", "train": "t", "route": route, "start": {"time": 0.0}})
    stations = [{"id": "A", "km": 0.0}, {"id": "B", "name": "Bravo", "km": 20.0}, {"id": "C", "km": 30.0, "tracks": ["2"]}]
    line = Line.model_validate({"tracks": [{"id": "1", "from_km": 0.0, "to_km": 40.0}], "stations": stations})
    assert route_in_words(run, line) == (place, "A")

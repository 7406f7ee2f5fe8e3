import pytest
from fake_results import TRAIN_FIGURES
from read_workbook import exactly, read_table

from tractionpower.model.line import Line
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Part
from tractionpower.reporting.workbook.run.trains import FIGURES, formation_in_words, route_in_words

SHOWN = {
    "energy_taken_kwh": "energy taken [kWh]",
    "highest_current_a": "highest current [A]",
    "lowest_pantograph_voltage_v": "lowest voltage [V]",
    "lowest_10_s_mean_voltage_v": "lowest mean voltage of 10 s [V]",
    "mean_useful_voltage_time_mean_v": "mean useful voltage time mean [V]",
    "late_at_end_s": "late at end [s]",
    "length_km": "length [km]",
}


def test_figures_of_trains_are_those_of_the_run(small, case):
    rows = {row["train"]: row for row in read_table(small["Trains"])}
    for number in ("1000", "1003"):
        for name, heading in SHOWN.items():
            assert rows[number][heading] == exactly(case[0].key_figure(name, f"train {number}"))
        # a time is kept as a part of a day
        assert rows[number]["running time [h:min:s]"] == pytest.approx(
            case[0].key_figure("running_time_s", f"train {number}"), abs=0.5
        )


def test_every_figure_of_a_train_has_a_column(small):
    assert set(FIGURES) == set(TRAIN_FIGURES)
    assert len(read_table(small["Trains"])[0]) == 7 + len(FIGURES)


def test_a_row_says_from_where_to_where_and_what_became_of_it(small):
    row = read_table(small["Trains"])[1]
    assert (row["from"], row["to"], row["formation"]) == ("Łódź Bravo", "Alfa", "local")
    assert (row["entered"], row["left"], row["what became of it"]) == (22050.0, 23550.0, "left the line")


def test_low_voltages_are_coloured_by_the_limits_of_the_study(small):
    sheet = small["Trains"]
    header = {cell.value: cell.column_letter for cell in sheet[int(sheet.freeze_panes[1:]) - 1]}
    letter = header["lowest voltage [V]"]
    rules = next(area.rules for area in sheet.conditional_formatting if str(area.sqref).startswith(letter))
    assert [(rule.formula[0].split("<")[1], rule.dxf.fill.bgColor.rgb[-6:]) for rule in rules] == [
        ("2000)", "FFC7CE"),
        ("3000)", "FFEB9C"),
    ]


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

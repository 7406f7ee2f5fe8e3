import pytest

from tractionpower.cosimulation.check import check_scenario
from tractionpower.errors import OutputError, UsageError
from tractionpower.io import templates
from tractionpower.io.scenario_files import load_scenario, read_scenario
from tractionpower.io.templates import template_texts, write_template
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle


def test_the_template_loads_without_problems(tmp_path):
    files = write_template(tmp_path / "new" / "study")
    folder = tmp_path / "new" / "study"
    assert [file.name for file in files[:4]] == ["README.md", "line.yaml", "supply.yaml", "timetable.yaml"]
    assert files[-1] == folder / "study.yaml"
    assert sorted(file for file in folder.rglob("*") if file.is_file()) == sorted(files)
    loaded, problems = read_scenario(tmp_path / "new" / "study")
    assert problems == []
    assert loaded is not None
    assert len(loaded.scenario.line.tracks) == 2
    assert [len(part) for part in (loaded.scenario.supply.substations, loaded.scenario.supply.section_cabins)] == [2, 1]
    assert len(loaded.scenario.supply.loads) == 1


def test_the_template_has_two_trains_of_its_own_vehicles(tmp_path):
    write_template(tmp_path)
    loaded = load_scenario(tmp_path)
    scenario = loaded.scenario
    assert [(run.id, run.train) for run in scenario.timetable.trains] == [("1001", "express"), ("2002", "local")]
    assert [train.id for train in scenario.trains] == ["express", "local"]
    assert [vehicle.id for vehicle in scenario.vehicles] == ["coach", "locomotive", "unit"]
    for vehicle in scenario.vehicles:
        assert "assumed" in vehicle.source
        assert loaded.provenance.locate(f"vehicles[{vehicle.id}]").startswith("rollingstock/vehicles/")
    assert check_scenario(scenario) == []


@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("line.yaml", Line),
        ("supply.yaml", Supply),
        ("timetable.yaml", Timetable),
        ("rollingstock/trains/local.yaml", Train),
        ("rollingstock/vehicles/coach.yaml", Vehicle),
    ],
)
def test_every_key_is_explained(name, model):
    text = template_texts()[name]
    for key in model.model_json_schema()["properties"]:
        assert f"\n{key}: " in text or f"\n{key}:\n" in text or f"\n#{key}: " in text


def test_comments_come_from_the_declarations():
    text = template_texts()["supply.yaml"]
    assert "#   no_load_voltage_v [V]: Voltage of the busbar without load. Required." in text
    told = "Slope of the external characteristic, (E - U)/I, with all units; left out: by unit_resistance_ohm."
    assert f"#   internal_resistance_ohm [Ω]: {told}\n" in text
    assert "#   unit: Type of its rectifier units, by the table of rectifier units.\n" in text
    assert "#   feeder_resistance_ohm [Ω]: Resistance of each feeder" in text
    assert "side. Default: 0.0." in text


def test_rows_within_rows_and_the_drive_that_is_meant_are_explained():
    texts = template_texts()
    assert "#     station: The station. Required." in texts["timetable.yaml"]
    locomotive, coach = (texts[f"rollingstock/vehicles/{name}.yaml"] for name in ("locomotive", "coach"))
    assert "#   starting_effort_kn [kN]: Greatest tractive effort at the wheel. Required." in locomotive
    assert "gear_ratio" not in locomotive
    assert "#   kind: Kind of drive. One of inverter | series_motors | table." in coach
    assert "# Kind of vehicle. One of locomotive | multiple_unit | coach | wagon." in coach


def test_keys_shown_as_comments_load_as_well(tmp_path):
    write_template(tmp_path)
    for file in tmp_path.rglob("*.yaml"):
        lines = (
            line[1:] if line.startswith("#") and not line.startswith("# ") else line for line in file.read_text().splitlines()
        )
        file.write_text("\n".join(lines), encoding="utf-8")
    assert load_scenario(tmp_path).problems == ()


def test_an_empty_folder_is_filled_and_a_full_one_refused(tmp_path):
    write_template(tmp_path)
    with pytest.raises(UsageError, match="not empty"):
        write_template(tmp_path)
    with pytest.raises(UsageError, match="is a file"):
        write_template(tmp_path / "study.yaml")


def test_nothing_half_written_is_left(tmp_path, monkeypatch):
    texts = {"README.md": "a", "README.md/study.yaml": "b"}
    monkeypatch.setattr(templates, "template_texts", lambda: texts)
    with pytest.raises(OutputError):
        write_template(tmp_path / "new")
    assert list((tmp_path / "new").iterdir()) == []

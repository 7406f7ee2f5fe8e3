import pytest

from tractionpower.errors import OutputError, UsageError
from tractionpower.io import templates
from tractionpower.io.scenario_files import load_scenario, read_scenario
from tractionpower.io.templates import template_texts, write_template
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply


def test_the_template_loads_without_problems(tmp_path):
    files = write_template(tmp_path / "new" / "study")
    assert [file.name for file in files] == ["README.md", "line.yaml", "supply.yaml", "study.yaml"]
    assert sorted(tmp_path.glob("new/study/*")) == sorted(files)
    loaded, problems = read_scenario(tmp_path / "new" / "study")
    assert problems == []
    assert loaded is not None
    assert len(loaded.scenario.line.tracks) == 2
    assert [len(part) for part in (loaded.scenario.supply.substations, loaded.scenario.supply.section_cabins)] == [2, 1]
    assert len(loaded.scenario.supply.loads) == 1


@pytest.mark.parametrize(("name", "model"), [("line.yaml", Line), ("supply.yaml", Supply)])
def test_every_key_is_explained(name, model):
    text = template_texts()[name]
    for key in model.model_json_schema()["properties"]:
        assert f"\n{key}: " in text or f"\n{key}:\n" in text or f"\n#{key}: " in text


def test_comments_come_from_the_declarations():
    text = template_texts()["supply.yaml"]
    assert "#   internal_resistance_ohm [Ω]: Slope of the external characteristic, (E - U)/I. Required." in text
    assert "#   feeder_resistance_ohm [Ω]: Resistance of each feeder" in text
    assert "side. Default: 0.0." in text


def test_keys_shown_as_comments_load_as_well(tmp_path):
    write_template(tmp_path)
    for name in ("study.yaml", "line.yaml", "supply.yaml"):
        file = tmp_path / name
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
    texts = {"README.md": "a", "missing/study.yaml": "b"}
    monkeypatch.setattr(templates, "template_texts", lambda: texts)
    with pytest.raises(OutputError):
        write_template(tmp_path / "new")
    assert list((tmp_path / "new").iterdir()) == []

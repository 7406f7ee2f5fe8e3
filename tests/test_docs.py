"""The reference pages are those that the declarations and a run give now; links and images of the pages exist."""

import importlib.util
import re
from pathlib import Path

import pytest
from small_studies import make_scenario, run_in_memory

import tractionpower
from tractionpower.io.conductor_files import CONDUCTORS
from tractionpower.io.documents import read_document
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.io.text_files import Source
from tractionpower.model.loads import Load
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.supply.conductor_checks import check_conductors
from tractionpower.supply.rating_checks import check_ratings

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *ROOT.glob("*/README.md"), *ROOT.glob("lines/*/README.md")])


@pytest.fixture(scope="module")
def reference():
    spec = importlib.util.spec_from_file_location("make_reference", ROOT / "docs" / "make_reference.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", ["inputs", "results", "conductors", "ratings"])
def test_the_reference_pages_are_up_to_date(page, reference):
    made = getattr(reference, f"{page}_page")()
    assert (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8") == made, "run `make docs`"


def test_what_is_not_described_is_an_error(reference):
    with pytest.raises(SystemExit, match=r"kinds.*\['tripped'\]"):
        reference._agree("kinds", ["stop"], ["stop", "tripped"])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#\s]+)\)", page.read_text(encoding="utf-8")):
        assert "://" in target or (page.parent / target).exists(), target


def test_the_examples_of_the_page_of_conductors_are_sound(tmp_path):
    page = (ROOT / "docs" / "conductors.md").read_text(encoding="utf-8")
    blocks = dict(re.findall(r"```(yaml|csv)\n(.*?)```", page, re.DOTALL))
    (tmp_path / "supply.yaml").write_text(f"format: 1\n{blocks['yaml']}", encoding="utf-8")
    (tmp_path / "own.csv").write_text(blocks["csv"], encoding="utf-8")
    rows, _ = CONDUCTORS.read(Source(tmp_path / "own.csv", "own.csv", "conductors"))
    assert len(rows) == 2
    supply = read_document(tmp_path / "supply.yaml", Supply)
    assert len(supply.contact_lines) == 4
    assert check_conductors(supply, CONDUCTORS.over_shipped(rows)) == []


def test_the_examples_of_the_page_of_ratings_are_sound(tmp_path):
    page = (ROOT / "docs" / "ratings.md").read_text(encoding="utf-8")
    blocks = dict(re.findall(r"```(yaml|csv)\n(.*?)```", page, re.DOTALL))
    (tmp_path / "own.csv").write_text(blocks["csv"], encoding="utf-8")
    rows, _ = DUTY_CLASSES.read(Source(tmp_path / "own.csv", "own.csv", "duty_classes"))
    (tmp_path / "supply.yaml").write_text(f"format: 1\n{blocks['yaml']}", encoding="utf-8")
    supply = read_document(tmp_path / "supply.yaml", Supply)
    parts = {"duty_classes": DUTY_CLASSES.over_shipped(rows), "rectifier_units": RECTIFIER_UNITS.shipped}
    scenario = make_scenario(**supply.model_dump(by_alias=True, exclude_unset=True, exclude={"format"}))
    assert check_ratings(Scenario(**{name: getattr(scenario, name) for name in Scenario.model_fields} | parts)) == []


def test_the_example_of_the_page_of_driving_is_sound(tmp_path):
    page = (ROOT / "docs" / "driving.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    (tmp_path / "timetable.yaml").write_text(f"format: 1\n{block}", encoding="utf-8")
    timetable = read_document(tmp_path / "timetable.yaml", Timetable)
    assert timetable.driving.kind == "to_time"
    assert timetable.trains[0].driving.coast_before_stops_km == 2.0


def keys_of(text):
    """Return the text of each key of a YAML document."""
    return {key: text for text, key in re.findall(r"^((\w+):.*\n(?:[ #].*\n)*)", text, re.MULTILINE)}


@pytest.fixture(scope="module")
def network_examples(tmp_path_factory):
    """Return the studies of the page of the network: each block of a supply over the first, with the line before it."""
    page = (ROOT / "docs" / "network.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```yaml\n# (line|supply)\.yaml\n(.*?)```", page, re.DOTALL)
    assert len(blocks) == page.count("```yaml")
    parts, first, studies = {}, {}, []
    for kind, text in blocks:
        parts[kind] = keys_of(text)
        assert "".join(parts[kind].values()) == text
        if kind == "supply":
            first = first or parts[kind]
            folder = tmp_path_factory.mktemp("example")
            (folder / "study.yaml").write_text('clock: {start: "06:00:00", end: "06:45:00"}\n', encoding="utf-8")
            (folder / "line.yaml").write_text("".join(parts["line"].values()), encoding="utf-8")
            (folder / "supply.yaml").write_text("".join((first | parts[kind]).values()), encoding="utf-8")
            studies.append(tractionpower.load(folder))
    return studies


def test_the_examples_of_the_page_of_the_network_are_sound(network_examples):
    assert len(network_examples) == 8
    shown = {key for study in network_examples for part in (study.line, study.supply) for key, rows in part if rows}
    assert {"feeders", "switches", "switch_events", "bonds", "earthing", "voltage_limiting_devices", "connections"} <= shown
    for study in network_examples:
        assert tractionpower.check(study) == []


def test_the_examples_of_the_page_of_the_network_run(network_examples):
    train = Load.model_validate({"id": "train", "track": "2", "km": 12.4, "current_a": 1000.0})
    for study in network_examples:
        supply = study.supply.model_copy(update={"loads": (*study.supply.loads, train)})
        results, outcome, _ = run_in_memory(study.model_copy(update={"supply": supply}))
        assert outcome.run["status"] == "complete"
        assert outcome.run["ledgers"]["electric"]["closes"]
        assert results.table("substations")["current_a"].max() > 400.0


@pytest.fixture(scope="module")
def timetable_examples(tmp_path_factory):
    """Return the studies of the page of the timetable: each timetable on its line and supply, on a Friday."""
    page = (ROOT / "docs" / "timetable.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```yaml\n# (line|supply|timetable)\.yaml\n(.*?)```", page, re.DOTALL)
    assert len(blocks) == page.count("```yaml")
    parts, studies = {kind: text for kind, text in blocks if kind != "timetable"}, []
    for text in (text for kind, text in blocks if kind == "timetable"):
        folder = tmp_path_factory.mktemp("timetable")
        clock = '"00:00:00", end: "24:00:00"' if "carry_over" in text else '"06:00:00", end: "07:05:00", warm_up: "00:05:00"'
        study = f"clock: {{start: {clock}}}\nday: fri\ntimetable: timetable.yaml\n"
        for kind, content in (parts | {"timetable": text, "study": study}).items():
            (folder / f"{kind}.yaml").write_text(content, encoding="utf-8")
        studies.append(tractionpower.load(folder))
    return studies


def test_the_examples_of_the_page_of_the_timetable_are_sound(timetable_examples):
    assert len(timetable_examples) == 8
    shown = {key for study in timetable_examples for key, value in study.timetable if value}
    assert {"trains", "services", "rotations", "joins", "splits", "carry_over"} <= shown
    for study in timetable_examples:
        assert tractionpower.check(study) == []
    names = [[run.id for run in study.runs] for study in timetable_examples]
    assert ["R1 06:00", "R1 06:20", "R1 06:40"] in names
    assert ["777", "R2 06:10", "R2 06:40"] in names
    assert ["N 23:50", "N 24:20", "N 23:50 (day before)", "N 24:20 (day before)"] in names


def test_the_examples_of_the_page_of_the_timetable_run(timetable_examples):
    for study in timetable_examples[:-1]:
        results, outcome, _ = run_in_memory(study)
        assert outcome.run["status"] == "complete"
        assert {each["status"] for each in results.run["trains"]} == {"left"}
        assert results.table("calls")["late_s"].max() < 5.0

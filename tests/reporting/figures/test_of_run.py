"""The figures of a run as files."""

import xml.etree.ElementTree as ET

import pytest
from fake_runs import small_run
from matplotlib.text import Text

from tractionpower.model.report import ReportFigures
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures import of_run as figures
from tractionpower.reporting.figures.base.drawing import drawing, wanted
from tractionpower.reporting.figures.base.style import finish, new_figure
from tractionpower.reporting.figures.of_run import write_figures
from tractionpower.reporting.figures.trains.run_graph import run_graphs

SINGLE = {
    "load_duration",
    "substation_currents",
    "substation_loads",
    "substation_power",
    "train_graph",
    "voltage_along_line",
    "voltage_histogram",
}
CURVES = {"curves_ed250", "curves_ep09-10-coaches"}
TRAINS = {"trains/1", "trains/2", "trains/3%2FIC", "trains/4"}


def names(folder):
    return {path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.png")}


@pytest.fixture
def quick(monkeypatch):
    """Let figures be empty: what they show is tested elsewhere, here it is their files that matter."""
    empty = lambda data: ((f"curves_{kind}", new_figure(1.0, 1.0)) for kind in data.kinds if wanted(f"curves_{kind}"))  # noqa: E731
    monkeypatch.setattr(figures, "run_curves", empty)
    monkeypatch.setattr(figures, "train_figures", lambda data, chosen: ((name, new_figure(1.0, 1.0)) for name in chosen))


def test_a_run_has_all_figures_and_all_are_pictures(tmp_path):
    run = small_run()
    paths = write_figures(run.results, run.scenario, tmp_path)
    assert names(tmp_path) == SINGLE | TRAINS | CURVES
    assert {path.relative_to(tmp_path).with_suffix("").as_posix() for path in paths} == SINGLE | TRAINS | CURVES
    assert all(path.stat().st_size > 20_000 for path in paths)
    assert not list(tmp_path.rglob("*.tmp"))


def test_a_missing_table_leaves_its_figures_out_and_those_of_an_earlier_run_go(tmp_path, quick):
    run = small_run()
    (tmp_path / "trains").mkdir()
    for name in ("train_graph_fine.png", "voltage_histogram.png", "mine.png", "trains/99.png"):
        (tmp_path / name).write_bytes(b"")
    write_figures(run.without("trains", "calls"), run.scenario, tmp_path)
    assert names(tmp_path) == {
        "load_duration",
        "substation_currents",
        "substation_loads",
        "substation_power",
        "voltage_along_line",
        "mine",
    }
    write_figures(run.without("profile", "substations"), run.scenario, tmp_path)
    assert names(tmp_path) == {"train_graph", "voltage_histogram", "substation_loads", "mine"} | TRAINS | CURVES


def test_chosen_trains_are_drawn_in_all_kinds_of_files_and_nothing_else(tmp_path, quick):
    run = small_run()
    with drawing(ReportFigures(formats=("svg", "pdf"), names=("trains/3/IC",))):
        paths = write_figures(run.results, run.scenario, tmp_path)
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == ["trains/3%2FIC.svg", "trains/3%2FIC.pdf"]
    with drawing(ReportFigures(names=("trains",))):
        write_figures(run.results, run.scenario, tmp_path)
    assert names(tmp_path) == TRAINS
    assert not [*tmp_path.rglob("*.svg"), *tmp_path.rglob("*.pdf")]


@pytest.mark.filterwarnings("ignore:Glyph .*missing")  # where the test itself measures texts
def test_whatever_names_are_written_they_do_no_harm(tmp_path):
    """Names of the study, of stations and of trains with markup, formulas, letters that no font has, and far too long."""
    run = small_run()
    called = ["<script>alert('x')</script>", "=cmd()|' /C calc'!A0 \U0001f525", "W" * 300]
    stations = [each.model_copy(update={"name": name}) for each, name in zip(run.scenario.line.stations, called, strict=True)]
    line = run.scenario.line.model_copy(update={"stations": tuple(stations)})
    scenario = run.scenario.model_copy(update={"name": "$x_1$ & Łódź " + "long " * 60, "line": line})
    with drawing(ReportFigures(formats=("png", "svg"), names=("train_graph", "trains/2")), "study " + "n" * 400):
        paths = write_figures(run.results, scenario, tmp_path)
    assert len(paths) == 4
    for path in paths[1::2]:
        root = ET.parse(path).getroot()
        assert not list(root.iter("{http://www.w3.org/2000/svg}script"))
    figure = run_graphs(RunData(run.results, scenario))["train_graph"]
    finish(figure)
    figure.canvas.draw()
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    assert max(text.get_window_extent().x1 for text in texts) <= figure.bbox.x1 + 1.0
    assert "train graph" in figure.get_suptitle().replace("\n", " ")

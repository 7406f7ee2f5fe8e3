"""The figures of a run as files."""

import pytest
from fake_runs import small_run

from tractionpower.reporting.figures import of_run as figures
from tractionpower.reporting.figures.base.style import new_figure
from tractionpower.reporting.figures.of_run import write_figures

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
    monkeypatch.setattr(figures, "run_curves", lambda data: ((f"curves_{kind}", new_figure(1.0, 1.0)) for kind in data.kinds))
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

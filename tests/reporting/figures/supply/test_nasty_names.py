"""Names of users can be anything: no figure of the supply breaks by them, and no text leaves its figure."""

import pytest
from fake_runs import small_run

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.style import finish
from tractionpower.reporting.figures.supply.power_figures import substation_currents, substation_power
from tractionpower.reporting.figures.supply.substation_figures import load_duration, substation_loads
from tractionpower.reporting.figures.supply.voltage_figures import voltage_along_line, voltage_histogram

NAMES = ("=cmd()|' /C calc'!A0", "<script>alert(1)</script> $\\frac{1}{2}$ _^{}", "long " * 60, "X" * 300)
FIGURES = (substation_power, substation_currents, substation_loads, load_duration, voltage_along_line, voltage_histogram)


def renamed(name):
    """Return a run whose study, first station and first substation have a name."""
    run = small_run()
    line, supply = run.scenario.line, run.scenario.supply
    stations = (line.stations[0].model_copy(update={"name": name}), *line.stations[1:])
    substations = (supply.substations[0].model_copy(update={"id": name}), *supply.substations[1:])
    scenario = run.scenario.model_copy(
        update={
            "name": name,
            "line": line.model_copy(update={"stations": stations}),
            "supply": supply.model_copy(update={"substations": substations}),
        }
    )
    rows = run.results.table("substations")
    rows["substation"] = rows["substation"].cat.rename_categories({"A": name})
    return RunData(run.results, scenario, {"substations": rows})


@pytest.mark.parametrize("name", NAMES, ids=["formula", "markup", "many words", "one word"])
@pytest.mark.parametrize("draw", FIGURES, ids=lambda draw: draw.__name__)
def test_no_text_leaves_its_figure(draw, name):
    figure = draw(renamed(name))
    finish(figure)
    figure.canvas.draw()
    width, height = figure.get_size_inches()
    box = figure.get_tightbbox()
    assert -0.01 <= box.x0 < box.x1 <= width + 0.01
    assert -0.01 <= box.y0 < box.y1 <= height + 0.01
    assert figure.get_suptitle()[:3] == name.strip()[:3]

"""Power and current of substations over time, with their ratings."""

import numpy as np
import pandas as pd
import pytest
from fake_runs import big_run, small_run

from tractionpower.model.ratings import DutyRow, RectifierUnit
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.supply.panels import MOST_PANELS
from tractionpower.reporting.figures.supply.power_figures import substation_currents, substation_power


@pytest.fixture
def data():
    run = small_run()
    return RunData(run.results, run.scenario)


def rated(data, **more):
    """Return the run with two units of 1700 A at 3300 V in each substation, of a class that bears 1.5 for 2 h."""
    unit = RectifierUnit(unit="U", rated_current_a=1700.0, rated_voltage_v=3300.0, duty_class="D", pulses=12)
    duty = [DutyRow(duty_class="D", window_s=0.0, multiple=1.0), DutyRow(duty_class="D", window_s=7200.0, multiple=1.5)]
    supply = data.scenario.supply
    stations = [each.model_copy(update={"unit": "U", "units": 2} | more) for each in supply.substations]
    scenario = data.scenario.model_copy(
        update={
            "supply": supply.model_copy(update={"substations": tuple(stations)}),
            "rectifier_units": (unit,),
            "duty_classes": tuple(duty),
        }
    )
    return RunData(data.results, scenario)


def levels(axes):
    """Return the values of lines over the whole width of axes, by label."""
    return {line.get_label(): line.get_ydata()[0] for line in axes.lines if list(line.get_xdata()) == [0, 1]}


def test_means_of_both_windows_are_those_of_the_table(data):
    axes = substation_power(data).axes[0]
    rows = data.table("substations").query("substation == 'A'")
    power = rows["power_kw"].to_numpy(float) / 1000.0
    lines = {line.get_label(): line.get_ydata() for line in axes.lines}
    np.testing.assert_allclose(lines["mean of a step"], power)
    assert lines["mean of the last 15 min"][950] == pytest.approx(power[51:951].mean(), rel=1e-6)
    assert "mean of the last 60 min" not in lines  # the run lasts 20 min


def test_the_rated_power_is_that_of_the_units_in_service(data):
    (both,) = [value for label, value in levels(substation_power(rated(data)).axes[0]).items() if "rated power" in label]
    assert both == pytest.approx(2 * 1700.0 * 3300.0 / 1e6)
    one = rated(data, units_in_service=1)
    assert [value for label, value in levels(substation_power(one).axes[0]).items() if "rated power" in label] == [
        pytest.approx(1700.0 * 3300.0 / 1e6)
    ]
    none = rated(data, units_in_service=0)
    assert not [label for label in levels(substation_power(none).axes[0]) if "rated power" in label]
    own = rated(data, unit=None, rated_current_a=1000.0)  # at the nominal voltage, since no type says another
    assert [value for label, value in levels(substation_power(own).axes[0]).items() if "rated power" in label] == [
        pytest.approx(2 * 1000.0 * 3000.0 / 1e6)
    ]


def test_multiples_of_the_duty_class_are_drawn_where_currents_come_near(data):
    top = float(data.table("substations")["current_a"].max())
    low = levels(substation_currents(rated(data, unit="U", rated_current_a=top / 4.0)).axes[0])
    assert low["rated current of the units in service"] == pytest.approx(top / 2.0)
    assert low["1.5 times rated: RMS over 2 h at most"] == pytest.approx(0.75 * top)
    high = levels(substation_currents(rated(data, rated_current_a=10.0 * top)).axes[0])
    assert "rated current of the units in service" in high
    assert not [label for label in high if "times rated" in label]


def test_a_contract_is_drawn_unless_several_substations_share_it(data):
    alone = levels(substation_power(rated(data, contract_power_kw=2500.0)).axes[0])
    assert alone["contracted, quarter of an hour by the clock"] == pytest.approx(2.5)
    shared = levels(substation_power(rated(data, contract_power_kw=2500.0, supply_point="110 kV")).axes[0])
    assert not [label for label in shared if "contracted" in label]


def test_titles_and_legend_stay_within_the_figure_and_apart(no_overlap):
    run = big_run()
    figure = substation_power(RunData(run.results, run.scenario))
    no_overlap(figure, [axes._left_title for axes in figure.axes])
    box = figure.legends[0].get_window_extent()
    assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1


def test_nasty_names_of_substations_are_shown_as_text(no_overlap, data):
    name = "=cmd()$x$<script>" + 280 * "W"
    rows = data.table("substations").copy()
    rows["substation"] = rows["substation"].cat.rename_categories({"A": name})
    supply = data.scenario.supply
    stations = (supply.substations[0].model_copy(update={"id": name}), supply.substations[1])
    scenario = data.scenario.model_copy(update={"supply": supply.model_copy(update={"substations": stations})})
    figure = substation_power(RunData(data.results, scenario, {"substations": rows}))
    assert "=cmd()$x$<script>" in figure.axes[0].get_title(loc="left")
    no_overlap(figure, [axes._left_title for axes in figure.axes])


def test_of_many_substations_the_most_loaded_are_shown(data):
    rows = data.table("substations")
    own = rows[rows["substation"] == "A"]
    supply = data.scenario.supply
    names = [f"S{k:02d}" for k in range(MOST_PANELS + 3)]
    stations = tuple(supply.substations[0].model_copy(update={"id": name, "km": float(k)}) for k, name in enumerate(names))
    parts = [own.assign(substation=name, power_kw=own["power_kw"] * (k + 1)) for k, name in enumerate(names)]
    scenario = data.scenario.model_copy(update={"supply": supply.model_copy(update={"substations": stations})})
    table = pd.concat(parts).astype({"substation": "category"})
    figure = substation_power(RunData(data.results, scenario, {"substations": table}))
    shown = [axes.get_title(loc="left").split(":")[0].removeprefix("▲ ") for axes in figure.axes]
    assert shown[::2] + shown[1::2] == names[3:]  # one column after the other
    assert figure.get_suptitle().endswith(f", the {MOST_PANELS} most loaded of {len(names)}")


def test_without_the_table_there_are_no_figures(data):
    bare = RunData(small_run().without("substations"), data.scenario)
    assert (substation_power(bare), substation_currents(bare)) == (None, None)

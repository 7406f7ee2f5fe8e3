"""Key figures: names, units, and sums in kilowatt hours."""

import numpy as np
import pytest

from tractionpower.results.extremes import Extremes
from tractionpower.results.key_figures import KeyFigure, load_figures, substation_figures


def test_a_key_figure_is_written_with_its_unit():
    figure = KeyFigure("lowest_voltage_v", 3000.0, "km 5", "00:01:00", "lowest").as_dict()
    assert list(figure) == ["name", "value", "unit", "place", "time", "definition", "status"]
    assert figure["unit"] == "V"


def test_powers_become_kilowatts_and_energies_kilowatt_hours():
    time_s = np.array([0.0, 0.5, 1.0, 1.5])
    power, current = Extremes(1), Extremes(1)
    power.add(time_s, np.array([[1.0e6], [3.0e6], [2.0e6], [0.0]]))
    current.add(time_s, np.array([[300.0], [1000.0], [600.0], [0.0]]))
    figures = {figure.name: figure for figure in substation_figures(["A"], current, power, 0.5)}
    assert figures["highest_power_kw"].value == 3000.0
    assert figures["highest_power_kw"].time == "00:00:00.5"
    assert figures["energy_kwh"].value == pytest.approx(3.0e6 / 3.6e6)
    assert figures["rms_current_a"].value == pytest.approx(np.sqrt(np.mean(np.array([300.0, 1000.0, 600.0, 0.0]) ** 2)))
    (load,) = load_figures(["depot"], power, 0.5)
    assert (load.place, load.value) == ("load depot", pytest.approx(3.0e6 / 3.6e6))

"""One train in two runs: currents that follow the voltage, and currents at a constant voltage.

Krzysztozek (2019) names the constant voltage at the pantographs an important simplification; the figure shows what it hides.
"""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from tractionpower.errors import UsageError
from tractionpower.model.base import format_time
from tractionpower.model.limits import system_voltages
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import peaks_kept
from tractionpower.reporting.figures.base.axes import clock_label, draw_limits, set_clock, voltage_range
from tractionpower.reporting.figures.base.style import BLUE, GREY, INK, PAGE, STYLE, VERMILION, new_figure
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.results.results import Results

PANELS = (
    ("speed_kmh", mark("speed [km/h]")),
    ("voltage_v", mark("voltage at the\npantograph [V]")),
    ("current_a", mark("current at the\npantograph [A]")),
)


def compare_coupling(full: Results, constant: Results, scenario: Scenario, train: str) -> Figure:
    """Draw speed, voltage and current of a train with full coupling and with currents at a constant voltage.

    Parameters
    ----------
    full, constant
        Results of the study with ``coupling: full`` and ``coupling: constant_voltage``.
    scenario
        The study.
    train
        Identifier of the train.

    Raises
    ------
    UsageError
        If one of the runs has no rows of the train.
    """
    nominal = system_voltages(scenario.limits, scenario.supply.system).u_n
    fixed = constant.run.get("coupling_voltage_v") or nominal
    shown: tuple[tuple[pd.DataFrame, str, str, Any], ...] = (
        (
            _rows(RunData(constant, scenario), train),
            tr("currents computed at {voltage} V", voltage=number(fixed)),
            VERMILION,
            (0, (5, 2)),
        ),
        (_rows(RunData(full, scenario), train), tr("currents follow the voltage (full coupling)"), BLUE, "-"),
    )
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 5.4)
        panels = figure.subplots(len(PANELS), sharex=True)
        for axes, (column, label) in zip(panels, PANELS, strict=True):
            for rows, words, colour, dashes in shown:
                values = rows[column].to_numpy(float)
                kept = peaks_kept(values, 3000)
                steps: Any = "default" if column == "speed_kmh" else "steps-post"
                axes.plot(rows["time_s"].to_numpy()[kept], values[kept], color=colour, linestyle=dashes, linewidth=1.1,
                          drawstyle=steps, label=words)  # fmt: skip
            axes.set_ylabel(tr(label))
        volts = np.concatenate([rows["voltage_v"].to_numpy(float) for rows, *_ in shown])
        panels[1].set_ylim(*voltage_range(float(np.nanmin(volts)), float(np.nanmax(volts))))
        panels[1].axhline(
            fixed, color=GREY, linewidth=1.0, linestyle=(0, (1, 1.5)), label=tr("voltage that currents are computed at")
        )
        draw_limits(panels[1], scenario)
        panels[0].set_ylim(0.0, None)
        panels[2].axhline(0.0, color=INK, linewidth=0.6)
        set_clock(panels[-1], min(float(rows["time_s"].iloc[0]) for rows, *_ in shown),
                  max(float(rows["time_s"].iloc[-1]) for rows, *_ in shown))  # fmt: skip
        panels[-1].set_xlabel(clock_label(panels[-1]))
        handles, labels = panels[1].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=7.5)
        title = tr("{study}: train {train}, full coupling against a constant voltage", study=scenario.name, train=train)
        figure.suptitle(f"{title.lstrip(': ')}\n{_facts(shown[1][0], shown[0][0])}", x=0.01, ha="left")
        return figure


def _rows(data: RunData, train: str) -> pd.DataFrame:
    rows = data.whole_rows(train)
    if rows is None:
        raise UsageError(f"the run has no rows of train {train!r}")
    return rows


def _facts(full: pd.DataFrame, constant: pd.DataFrame) -> str:
    """Return in words what differs: lowest voltages, highest currents, time on the line."""
    facts = []
    for rows in (full, constant):
        seconds = rows["time_s"].iloc[-1] - rows["time_s"].iloc[0]
        facts.append((f"{rows['voltage_v'].min():.0f} V", f"{rows['current_a'].max():.0f} A", format_time(float(seconds))))
    (volts, amperes, spell), (other_volts, other_amperes, other_spell) = facts
    told = (
        tr("full coupling: lowest voltage {own} instead of {other}", own=volts, other=other_volts),
        tr("highest current {own} instead of {other}", own=amperes, other=other_amperes),
        tr("on the line for {own} instead of {other}", own=spell, other=other_spell),
    )
    return "; ".join(told)

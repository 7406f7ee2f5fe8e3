"""Results of a part of a run, as results of their own: figures and workbook are made of them as of any others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from tractionpower.errors import UsageError, raise_errors
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.results.columns import TABLES
from tractionpower.results.kept import SCENARIOS
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.results import Results
from tractionpower.results.selection.figures import feeders_of, loads_of, substations_of, trains_of, voltages_of
from tractionpower.results.selection.selection import Selection, check_selection, selected_rows
from tractionpower.results.tables import make_table

BIN_KM = 0.5
"""Length of the bins of the profile [km], as in a run."""

PART = (
    "a part of the run: key figures are of the selected rows; verdicts, ledgers and ratings are in the reports of the whole run"
)
"""What a reader of such results has to know."""

BEYOND = "beyond"
"""Status of a train that goes on where the part ends."""

OVER_TIME = ("trains", "calls", "substations", "feeders", "cabins", "switches", "loads", "rails", "earthing", "events")
"""Tables whose rows have a time or a train each, so that a part of them is that of a part of the run."""

OF_TRAINS = ("delays", "sections", "lost_time")
"""Tables that sum up whole journeys of trains; in a window of time they say nothing."""

OF_PLACES = ("profile", "rail_profile")
"""Tables that sum up the whole run at places."""


def select(results: Results, scenario: Scenario, selection: Selection) -> tuple[Results, Scenario]:
    """Return results of a part of a run, with key figures that are computed anew of its rows, and the scenario of that part.

    Sums over the whole run (ratings, ledgers, verdicts) do not belong to a part and are left out; with a window of time also
    what sums up journeys of trains.

    Raises
    ------
    InputError
        If the selection asks for what the study does not have; all problems at once.
    UsageError
        If the results are not those of a run, or no row belongs to the selection.
    """
    if str(results.run.get("kind") or "") not in ("", "feasibility", "size"):
        if results.run["kind"] in SCENARIOS:
            raise UsageError("these are results of train dynamics, whose reports cover the whole run; leave out what selects")
        raise UsageError(f"these are results of `{results.run['kind']}`, which has no rows over time to select from")
    raise_errors(check_selection(selection, scenario))
    tables = dict(_tables(results, scenario, selection))
    if not any(len(rows) for rows in tables.values()):
        raise UsageError(f"nothing of the run is in this selection: {selection.as_dict()}")
    frames: dict[str, pd.DataFrame] = {
        name: tables[name].to_pandas() for name in ("trains", "calls", "substations", "feeders", "loads") if name in tables
    }
    step_s = max(scenario.clock.step_s, scenario.output.every_s or 0.0)
    if len(frames.get("trains", ())) and "profile" not in tables:
        tables["profile"] = make_table("profile", profile_of(frames["trains"]))
    figures = [figure.as_dict() for figure in _figures(frames, scenario, _ways(results), step_s)]
    return Results(_run(results, scenario, selection, frames), figures, tables, scenario), _clock_of(scenario, selection)


def profile_of(rows: pd.DataFrame) -> dict[str, Any]:
    """Return the columns of table ``profile`` from rows of table ``trains``: voltages at pantographs in bins along the line."""
    known = rows[rows["voltage_v"].notna() & rows["position_km"].notna()]
    tracks = sorted(known["track"].astype(str).unique())
    middle = (np.floor(known["position_km"].to_numpy(float) / BIN_KM) + 0.5) * BIN_KM
    found = known.assign(track=known["track"].astype(str), km=middle).groupby(["track", "km"])["voltage_v"]
    sums = found.agg(["min", "mean", "max", "count"]).reset_index()
    return {
        "km": sums["km"].to_numpy(),
        "track": (sums["track"].map(tracks.index).to_numpy(int), tracks),
        "lowest_voltage_v": sums["min"].to_numpy(),
        "mean_voltage_v": sums["mean"].to_numpy(),
        "highest_voltage_v": sums["max"].to_numpy(),
        "count": sums["count"].to_numpy(),
        "where": (np.zeros(len(sums), int), ["pantograph"]),
    }


def _tables(results: Results, scenario: Scenario, selection: Selection) -> Iterator[tuple[str, pa.Table]]:
    for name in results.tables:
        whole = name in OF_TRAINS and not selection.has_window
        whole |= name in OF_PLACES and not selection.has_window and not selection.trains
        if name in TABLES and (name in OVER_TIME or whole):
            parts = [selected_rows(name, rows, selection, scenario) for rows in results.batches(name)]
            rows = pa.concat_tables(parts, promote_options="default").unify_dictionaries()
            if rows.num_rows:
                yield name, rows


def _ways(results: Results) -> dict[str, dict[str, Any]]:
    return {str(train["train"]): train for train in results.run.get("trains", ())}


def _figures(
    frames: dict[str, pd.DataFrame], scenario: Scenario, ways: dict[str, dict[str, Any]], step_s: float
) -> Iterator[KeyFigure]:
    counted = dict(frames)
    for name in ("trains", "substations", "feeders", "loads"):
        if name in counted:
            counted[name] = counted[name][counted[name]["time_s"] >= scenario.clock.counts_from_s]
    yield from voltages_of(counted.get("trains"), counted.get("loads"))
    if len(counted.get("substations", ())):
        yield from substations_of(counted["substations"], step_s)
    if len(counted.get("feeders", ())):
        yield from feeders_of(counted["feeders"])
    if len(counted.get("loads", ())):
        yield from loads_of(counted["loads"], step_s)
    if len(counted.get("trains", ())):
        yield from trains_of(counted["trains"], counted.get("calls"), ways, step_s)


def _run(results: Results, scenario: Scenario, selection: Selection, frames: dict[str, pd.DataFrame]) -> dict[str, Any]:
    """Return ``run.json`` of the part: what it says of the solution holds for the run, verdicts and ledgers go."""
    clock = _clock_of(scenario, selection).clock
    ways = {str(name): rows for name, rows in frames["trains"].groupby("train", observed=True)} if "trains" in frames else {}
    gone = ("verdicts", "ledgers", "overlaps", "links", "return_circuit", "lumping", "files", "feasibility", "kind")
    run = {key: value for key, value in results.run.items() if key not in gone}
    gone_trains = [train for train in selection.trains if train not in ways]
    told = [*results.run.get("trains", ())]
    return run | {
        "notes": [PART, *_notes(scenario, selection, gone_trains), *run.get("notes", ())],
        "selection": selection.as_dict() | ({"without_rows": gone_trains} if gone_trains else {}),
        "whole_run": _counted_verdicts(results.run.get("verdicts", ())),
        "start_s": clock.start,
        "end_s": clock.end,
        "steps": round((clock.end - clock.start) / clock.step_s),
        "trains": [_train(way, ways[way["train"]], scenario) for way in told if way["train"] in ways],
    }


def _notes(scenario: Scenario, selection: Selection, gone_trains: Sequence[str]) -> Iterator[str]:
    """Yield what a reader of the part has to know."""
    clock, every_s = scenario.clock, scenario.output.every_s or 0.0
    if gone_trains:
        yield f"no row of these trains is in the part: {', '.join(gone_trains)}"
    if every_s > clock.step_s:
        yield f"figures of the part rest on rows every {every_s:g} s, which stand for the steps between them"
    if selection.to_s <= clock.counts_from_s:
        yield "the part lies in the warm-up, which does not count: it has no key figures"


def _train(way: dict[str, Any], rows: pd.DataFrame, scenario: Scenario) -> dict[str, Any]:
    """Return what became of a train in the part: when it came and went, and where its voltage was lowest."""
    first_s, last_s = float(rows["time_s"].min()), float(rows["time_s"].max())
    interval_s = max(scenario.clock.step_s, scenario.output.every_s or 0.0)
    told, entered, finished = dict(way), way.get("entered_s"), way.get("finished_s")
    if entered is not None and first_s > entered + interval_s:
        told["entered_s"] = first_s
    if finished is not None and finished > last_s + interval_s + ROUNDING_S:
        told |= {"finished_s": None, "status": BEYOND}
    counted = rows[(rows["time_s"] >= scenario.clock.counts_from_s) & rows["voltage_v"].notna()]
    if len(counted):
        row = counted.iloc[int(counted["voltage_v"].to_numpy(float).argmin())]
        places = (("track", str(row["track"])), ("km", float(row["position_km"])), ("s", float(row["time_s"])))
        told |= {f"lowest_voltage_{name}": value for name, value in places if f"lowest_voltage_{name}" in told}
    return told


def _counted_verdicts(verdicts: Iterable[dict[str, Any]]) -> dict[str, int]:
    """Return how many limits the whole run meets and violates, and how many could not be judged."""
    met = [verdict.get("met") for verdict in verdicts]
    return {"met": met.count(True), "violated": met.count(False), "open": met.count(None)}


def _clock_of(scenario: Scenario, selection: Selection) -> Scenario:
    """Return the scenario with the clock of the part; it is never computed."""
    clock = scenario.clock
    start, end = max(clock.start, selection.from_s), min(clock.end, selection.to_s)
    rest_s = clock.counts_from_s - start
    changed = clock.model_copy(update={"start": start, "end": end, "warm_up": rest_s if 0.0 < rest_s < end - start else None})
    return scenario.model_copy(update={"clock": changed})

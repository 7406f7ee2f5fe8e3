"""``tractionpower compare DIR --measured FILE --map MAP.yaml``: a run beside a measurement."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from tractionpower.cli.messages import DONE, NOT_COMPLETED, echo_json, tell_problems, tell_results

if TYPE_CHECKING:
    from tractionpower.cli.look import Look
    from tractionpower.studies.measured.study import Comparison


def compare_measured(
    folder: Path, measured: Path, map_file: Path, out: Path | None = None, *, force: bool, look: Look | None, as_json: bool
) -> None:
    """Hold a measured file against the run in `folder`, write tables and reports, and say how far they are apart.

    Parameters
    ----------
    folder
        What `tractionpower run` has written.
    measured, map_file
        The measurement, and what its columns are.
    out
        Folder of the comparison; None: ``reports/<study>-measured`` here.
    force, as_json
        Replace what is there; print the errors as JSON.
    look
        How the reports look; None: there are none.
    """
    from tractionpower.errors import UsageError
    from tractionpower.reporting.measured import write_measured_reports
    from tractionpower.results.results import Results
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.measured.study import compare_measured as compared

    results = Results.open(folder)
    target = out if out is not None else Path("reports") / f"{results.run.get('study') or folder.name}-measured"
    if target.resolve() == folder.resolve():
        raise UsageError(f"{target} holds the run itself; choose another --out")
    comparison = compared(results, measured, map_file)
    study, kind, input_hash = (comparison.run[key] for key in ("study", "kind", "input_hash"))
    writer = RunWriter(target, study, input_hash, kind=kind, force=force, scenario=results.scenario)
    for name, table in comparison.tables().items():
        writer.append(name, table)
    run = writer.finish(comparison.run, [])
    tell_problems(comparison.problems)
    if as_json:
        echo_json(_document(comparison, target))
    else:
        _show(comparison)
    reports = [] if look is None else write_measured_reports(Results.open(target), target, look.report(target))
    tell_results(target, reports, writer.beside)
    done = any(each.errors["rows"] for each in comparison.series) and run["status"] == "complete"
    raise typer.Exit(DONE if done else NOT_COMPLETED)


def _document(comparison: Comparison, folder: Path) -> dict[str, Any]:
    note = {key: value for key, value in comparison.run["measured"].items() if key != "map"}
    series = [
        {"series": each.id, "unit": _unit(each.measured.series.quantity)}
        | {name: None if not math.isfinite(value) else float(value) for name, value in each.errors.items()}
        for each in comparison.series
    ]
    return {"format": 1, "folder": str(folder), **note, "series": series}


def _unit(quantity: str) -> str:
    from tractionpower.model.quantity import unit_of

    return unit_of(quantity)


def _show(comparison: Comparison) -> None:
    from tractionpower.cli.console import new_console, new_table

    console, told = new_console(), comparison.run["measured"]
    if told["align"] == "time":
        console.print(_shift_in_words(told))
    numbers = ["rows", "measured", "computed", "mean error", "RMS error", "% of RMS", "correlation"]
    numbers += ["lowest", "highest", "energy %"]
    table = new_table(["series", "unit"], numbers)
    for each in comparison.series:
        e = each.errors
        extremes = [f"{e[f'{end}_measured']:.5g}/{e[f'{end}_computed']:.5g}" for end in ("lowest", "highest")]
        values = [f"{e['mean_measured']:.5g}", f"{e['mean_computed']:.5g}", f"{e['mean_error']:+.4g}", f"{e['rms_error']:.4g}"]
        values += [f"{e['relative_percent']:.2f}", f"{e['correlation']:.4f}", *extremes, f"{e['energy_error_percent']:+.2f}"]
        cells = [f"{e['rows']:.0f}", *(("" if "nan" in value else value) for value in values)]
        table.add_row(each.id, _unit(each.measured.series.quantity), *cells)
    console.print(table)
    console.print("measured and computed are means; lowest and highest are measured/computed; errors are computed less measured")


def _shift_in_words(told: dict[str, Any]) -> str:
    words = f"shift: {told['shift_s']:+.2f} s is added to the times of the measurement"
    if not told["shift_found"]:
        return f"{words}, as the map says"
    if told["correlation"] is None:
        return words
    words += f", found with correlation {told['correlation']:.3f}, uncertain within some {told['width_s']:.1f} s"
    if told["rival_s"] is not None:
        words += f"; next best {told['rival_s']:+.1f} s with {told['rival_correlation']:.3f}"
    return words

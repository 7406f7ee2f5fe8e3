"""Results folders side by side: key figures with differences from a base, verdicts, and the inputs that differ."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from tractionpower.errors import UsageError
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.results.versions import versions
from tractionpower.studies.compare.figures import compared, compared_verdicts, profiles
from tractionpower.studies.compare.folders import Variant, open_variants
from tractionpower.studies.compare.inputs import InputDifference, input_differences
from tractionpower.studies.runner.outcomes import rows_table

MOST_NOTED = 50
"""Differences of inputs that ``run.json`` names for each folder; table ``compare_inputs`` has all."""


HOW = (
    "start_s", "end_s", "step_s", "coupling", "coupling_voltage_v", "steps", "flagged_steps", "worst_residual_a",
    "residual_limit_a", "wall_seconds", "cases",
)  # fmt: skip
"""What ``run.json`` repeats of each folder: how it was computed, and how well."""


@dataclass(frozen=True)
class Comparison:
    """Folders compared.

    Attributes
    ----------
    variants
        The folders, the base first.
    inputs
        What differs from the base, by name of the folder; None where the inputs of either are not known.
    notes
        What is to be said of the folders: other studies, runs that are not complete, nothing that differs.
    figures, verdicts
        Rows of tables ``compare`` and ``compare_verdicts``.
    """

    variants: tuple[Variant, ...]
    inputs: dict[str, list[InputDifference] | None]
    notes: tuple[str, ...]
    figures: list[dict[str, Any]]
    verdicts: list[dict[str, Any]]

    @property
    def study(self) -> str:
        """Name of the study of the base."""
        return self.variants[0].study

    def tables(self) -> dict[str, pa.Table]:
        """Return the tables that have rows."""
        inputs = [{"folder": name, **item._asdict()} for name, found in self.inputs.items() for item in found or ()]
        rows = {"compare": self.figures, "compare_verdicts": self.verdicts, "compare_inputs": inputs}
        rows["compare_profile"] = profiles(self.variants)
        return {name: rows_table(name, found) for name, found in rows.items() if found}

    def run(self) -> dict[str, Any]:
        """Return what ``run.json`` says."""
        base = self.variants[0]
        return {
            "format": 1,
            "status": "complete",
            "kind": "compare",
            "study": self.study,
            "name": str(base.results.run.get("name") or self.study),
            "input_hash": self.input_hash,
            "versions": versions(),
            "verdicts": [],
            "compare": {
                "base": base.name,
                "folders": [self._said_of(variant) for variant in self.variants],
                "definitions": self._definitions(),
                "notes": list(self.notes),
            },
        }

    @property
    def scenario(self) -> Scenario | None:
        """What the base is a run of; None if that is not known."""
        return _scenario(self.variants[0])

    @property
    def input_hash(self) -> str:
        """Hash of what is compared: the inputs of all folders, in their order."""
        told = "".join(f"{variant.name}\0{variant.results.run.get('input_hash')}\0" for variant in self.variants)
        return hashlib.sha256(told.encode()).hexdigest()

    def _definitions(self) -> dict[str, str]:
        """Return how each figure is computed, by the words of the first folder that tells it."""
        told: dict[str, str] = {}
        for variant in self.variants:
            for figure in variant.results.key_figures:
                told.setdefault(figure["name"], str(figure.get("definition") or ""))
        known = {row["figure"] for row in self.figures}
        return {name: words for name, words in told.items() if name in known and words}

    def _said_of(self, variant: Variant) -> dict[str, Any]:
        inputs, run = self.inputs.get(variant.name), variant.results.run
        ledgers = {name: bool(ledger.get("closes")) for name, ledger in (run.get("ledgers") or {}).items()}
        return {
            "name": variant.name,
            "folder": str(variant.folder),
            **{key: run.get(key) for key in ("study", "kind", "status", "input_hash")},
            "run": {key: run[key] for key in HOW if run.get(key) is not None} | {"ledgers_close": ledgers},
            "inputs": None if inputs is None else [str(item) for item in inputs[:MOST_NOTED]],
            "inputs_that_differ": None if inputs is None else len(inputs),
        }


def compare_folders(folders: Sequence[str | Path], base: str | Path | None = None) -> Comparison:
    """Compare results folders; nothing is written.

    Parameters
    ----------
    folders
        ``DIR`` or ``NAME=DIR``.
    base
        The folder, or its name, that the others are compared with; left out: the first.

    Raises
    ------
    UsageError
        If fewer than two are told, or one holds no complete results; all of them are told.
    """
    variants = open_variants(folders, base)
    inputs = {variant.name: _inputs(variants[0], variant) for variant in variants[1:]}
    figures = compared(variants)
    if not any(row["folder"] != variants[0].name and row["difference"] == row["difference"] for row in figures):
        raise UsageError("these folders have no figure in common: one may hold a run and the other cases of a study")
    return Comparison(variants, inputs, tuple(_notes(variants, inputs)), figures, compared_verdicts(variants))


def _inputs(base: Variant, other: Variant) -> list[InputDifference] | None:
    first, second = _scenario(base), _scenario(other)
    return None if first is None or second is None else input_differences(first, second)


def _scenario(variant: Variant) -> Scenario | None:
    try:
        scenario = variant.results.scenario
    except UsageError:  # inputs of another version of the program
        return None
    return scenario if isinstance(scenario, Scenario) else None


def _notes(variants: Sequence[Variant], inputs: dict[str, list[InputDifference] | None]) -> list[str]:
    base, notes = variants[0], []
    for variant in variants:
        run = variant.results.run
        if run.get("status") != "complete":
            notes.append(f"{variant.name}: the run is {run.get('status', 'of unknown status')}")
        if variant is base:
            continue
        if variant.study != base.study:
            notes.append(f"{variant.name} is of another study, {variant.study!r} and not {base.study!r}")
        if variant.has_cases != base.has_cases:
            notes.append(f"only one of {base.name} and {variant.name} holds many cases: their figures differ in kind")
        found = inputs[variant.name]
        if found is None:
            notes.append(f"{variant.name}: which inputs differ is not known, they are not kept with the results")
        elif not found:
            notes.append(f"{variant.name}: no input differs from {base.name}")
        theirs, ours = (each.results.run.get("versions", {}).get("tractionpower") for each in (variant, base))
        if theirs != ours:
            notes.append(f"{variant.name} was computed by version {theirs} of tractionpower, {base.name} by {ours}")
    return notes


def compare(
    folders: Sequence[str | Path], folder: str | Path | None = None, *, base: str | Path | None = None, force: bool = False
) -> Results:
    """Compare results folders, and return tables ``compare``, ``compare_verdicts`` and ``compare_inputs``.

    Parameters
    ----------
    folders, base
        See `compare_folders`.
    folder
        Where to write the comparison; left out, it stays in memory.
    force
        Write even where results of another study are.

    Raises
    ------
    UsageError
        If fewer than two are told, or one holds no complete results.
    OutputError
        If the comparison cannot be written.
    """
    comparison = compare_folders(folders, base)
    if folder is None:
        return Results(comparison.run(), [], comparison.tables(), comparison.scenario)
    write_comparison(comparison, Path(folder), force=force)
    return Results.open(folder)


def write_comparison(comparison: Comparison, folder: Path, *, force: bool = False) -> RunWriter:
    """Write the tables of a comparison into a folder and return the writer."""
    study, scenario = f"{comparison.study}-compare", comparison.scenario
    writer = RunWriter(folder, study, comparison.input_hash, kind="compare", force=force, scenario=scenario)
    for name, rows in comparison.tables().items():
        writer.append(name, rows)
    writer.finish(comparison.run() | {"study": writer.study}, [])
    return writer

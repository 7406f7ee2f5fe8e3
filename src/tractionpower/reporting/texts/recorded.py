"""Sentences that a run records in English, with places for names and numbers, so that reports can tell them in any language."""

from __future__ import annotations

SENTENCES: tuple[str, ...] = (
    "highest mean of a step",
    "mean over the run",
    "root of the mean square over the run",
    "highest sliding mean over {window}, U I; time is the start of the window",
    "highest sliding root mean square over {window}; time is the start of the window",
)
"""Definitions of key figures, notes and verdicts of a run, messages of events, names of quantities."""

"""What the sheets of train dynamics tell, gathered: the run, its case, its tables as arrays."""

from __future__ import annotations

from typing import Any

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.texts import decimal, mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import CaseFacts
from tractionpower.results.results import Results

SIDES = {
    "tension": (mark("greatest tension of couplings {name}"), mark("endurable tension of {name}")),
    "compression": (mark("greatest compression of couplings {name}"), mark("endurable compression of {name}")),
}
"""What is judged of a kind of couplings, and its limit, by the side of the force."""


class ChainFacts(CaseFacts):
    """A run of train dynamics and its case, as the sheets ask for them."""

    def __init__(self, results: Results, scenario: DynamicsScenario) -> None:
        super().__init__(results, scenario)
        self.scenario = scenario
        self.data = ChainData(results, scenario)

    @property
    def about(self) -> str:
        """What the document is about."""
        return tr("Simulation of the longitudinal dynamics of a train")

    @property
    def verdicts(self) -> list[dict[str, Any]]:
        """Verdicts on the forces of couplings, with names for people."""
        return [self._told(verdict) for verdict in super().verdicts]

    def _told(self, verdict: dict[str, Any]) -> dict[str, Any]:
        side, name = kind_of(verdict)
        if side not in SIDES:
            return verdict
        words, limit = SIDES[side]
        return verdict | {
            "name": tr(words, name=name),
            "limit": tr(limit, name=name),
            "time": decimal(str(verdict["time"] or "")),
        }

    def verdict_of(self, coupling: str, side: str) -> dict[str, Any] | None:
        """Return the verdict on a kind of couplings, None where it was not judged."""
        raw = super().verdicts
        return next((self._told(one) for one in raw if kind_of(one) == (side, coupling)), None)

    @property
    def kinds(self) -> list[Coupling]:
        """Kinds of couplings of the train, in their order from the front."""
        found = (self.data.coupling_of(k) for k in range(len(self.data.couplings)))
        return list({one.id: one for one in found if one is not None}.values())


def kind_of(verdict: dict[str, Any]) -> tuple[str, str]:
    """Return the side of the force that a verdict of ``run.json`` is on, and the kind of couplings.

    >>> kind_of({"name": "greatest_tension_kn", "limit": "endurable_tension of uic"})
    ('tension', 'uic')
    """
    side = str(verdict["name"]).removeprefix("greatest_").removesuffix("_kn")
    return side, str(verdict["limit"] or "").removeprefix(f"endurable_{side} of ")


def facts_of(book: Book) -> ChainFacts:
    """Return the facts of a book on train dynamics."""
    if not isinstance(book.subject, ChainFacts):
        raise TypeError("this workbook is not about train dynamics")
    return book.subject

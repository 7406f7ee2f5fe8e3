"""Key figures, gathered while the run lasts, over every step whether its row is written or not."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.quantity import unit_of

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """One number that sums up a run.

    Attributes
    ----------
    name
        Name with the unit as suffix.
    value
        The number in that unit.
    place, time
        Where and when (HH:MM:SS); empty where that means nothing.
    definition
        How it is computed.
    status
        Status of the limit that it is held against; empty without one.
    """

    name: str
    value: float
    place: str = ""
    time: str = ""
    definition: str = ""
    status: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the figure as it is written, with its unit."""
        figure = asdict(self)
        return {"name": self.name, "value": self.value, "unit": unit_of(self.name)} | {
            key: figure[key] for key in ("place", "time", "definition", "status")
        }


def add_up(total: Array, values: Array) -> Array:
    """Return `total` plus all rows of `values`, added one after the other: the sum does not depend on how many come at a time."""
    return np.asarray(np.cumsum(np.concatenate([total[np.newaxis], values]), axis=0)[-1])


class Extremes:
    """Lowest, highest and mean of several series, with the time of the extremes.

    Parameters
    ----------
    width
        Number of series.
    """

    def __init__(self, width: int) -> None:
        self.lowest, self.highest = np.full(width, np.inf), np.full(width, -np.inf)
        self.lowest_s, self.highest_s = np.full(width, np.nan), np.full(width, np.nan)
        self.total, self.squares = np.zeros(width), np.zeros(width)
        self.count = 0

    def add(self, time_s: Array, values: Array) -> None:
        """Add rows: times [s], shape (steps,), and values, shape (steps, width)."""
        if not values.size:
            return
        columns = np.arange(values.shape[1])
        for pick, best, when, better in (
            (values.argmin(axis=0), self.lowest, self.lowest_s, np.less),
            (values.argmax(axis=0), self.highest, self.highest_s, np.greater),
        ):
            found = values[pick, columns]
            new = better(found, best)
            best[new], when[new] = found[new], time_s[pick][new]
        self.total = add_up(self.total, values)
        self.squares = add_up(self.squares, values**2)
        self.count += len(values)

    @property
    def mean(self) -> Array:
        """Mean of each series."""
        return self.total / max(self.count, 1)

    @property
    def rms(self) -> Array:
        """Root of the mean square of each series."""
        return np.asarray(np.sqrt(self.squares / max(self.count, 1)))


class ElectricLedger:
    """The electric ledger of a run: sum E I = trains + loads + line + regulation, in every step.

    A step closes within 1e-9 of the gross power exchanged plus 1 mW.
    """

    NAMES = ("source", "regulation", "load", "conductor")

    def __init__(self) -> None:
        self._total = np.zeros(len(self.NAMES))
        self.worst_gap_w = self.worst_share = 0.0

    def add(self, steps: NDArray[np.void], step_s: float) -> None:
        """Add the results of steps, records of `tractionpower.kernels.tables.STEP_RESULT`."""
        powers = np.stack([steps[f"{name}_w"] for name in self.NAMES], axis=1)
        self._total = add_up(self._total, powers * step_s)
        gap = np.abs(steps["source_w"] - steps["regulation_w"] - steps["load_w"] - steps["conductor_w"])
        gap[np.isnan(gap)] = np.inf  # not a number must not pass for a balance
        if gap.size:
            self.worst_gap_w = max(self.worst_gap_w, float(gap.max()))
            self.worst_share = max(self.worst_share, float((gap / (1e-9 * np.nan_to_num(steps["gross_w"]) + 1e-3)).max()))

    @property
    def energy_j(self) -> dict[str, float]:
        """Energies by name [J]."""
        return dict(zip(self.NAMES, self._total.tolist(), strict=True))

    @property
    def closes(self) -> bool:
        """Whether every step closes."""
        return self.worst_share <= 1.0

    def as_dict(self) -> dict[str, Any]:
        """Return energies [kWh] and the worst gap [W]."""
        energies = {f"{name}_kwh": joule / 3.6e6 for name, joule in self.energy_j.items()}
        return {"closes": self.closes, "worst_gap_w": self.worst_gap_w} | energies

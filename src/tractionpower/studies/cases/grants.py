"""What others grant a supply: contracted powers of supply points, settings of breakers; and what a run takes of them."""

from __future__ import annotations

import math
from typing import Any

from tractionpower.cosimulation.recorder import Watch
from tractionpower.model.scenario import Scenario
from tractionpower.studies.ratings.breakers import BreakerWatch
from tractionpower.studies.ratings.demand import DemandWatch
from tractionpower.studies.ratings.findings import worst_breakers, worst_demand
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.protection import protections


class GrantWatch:
    """Watches demands and peaks, as a study of ratings does.

    Parameters
    ----------
    scenario, supply
        What runs, with all devices in their normal states.

    Attributes
    ----------
    watches
        What is called with the rows of the run.
    """

    def __init__(self, scenario: Scenario, supply: SupplyTables) -> None:
        self._demand = DemandWatch(scenario, supply)
        self._breakers = BreakerWatch(scenario, supply) if protections(scenario.supply, supply.links) else None
        self.watches: tuple[Watch, ...] = (self._demand, *(() if self._breakers is None else (self._breakers,)))

    def figures(self) -> dict[str, Any]:
        """Return the highest demand, and the highest shares of contracts and settings with whose they are."""
        demands = worst_demand(list(self._demand.rows()))
        contracts = [(100.0 * row["power_kw"] / row["contract_power_kw"], row["supply_point"]) for row in demands if row["met"]]
        peaks = () if self._breakers is None else worst_breakers(list(self._breakers.rows({})))
        contract = max(contracts, key=lambda found: found[0], default=(math.nan, ""))
        return {
            "highest_demand_kw": float(max((row["power_kw"] for row in demands), default=math.nan)),
            "contract_share_percent": float(contract[0]),
            "contract_point": contract[1],
            "breaker_share_percent": peaks[0]["share_percent"] if peaks else math.nan,
            "breaker_device": peaks[0]["device"] if peaks else "",
        }

"""Places whose voltage is recorded though nothing stands there: beside loads the voltage bends on other tracks too."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

from tractionpower.model.loads import Load
from tractionpower.supply.bundles import SHARED_KM
from tractionpower.supply.topology import Topology


def find_probes(topology: Topology, loads: Sequence[Load]) -> list[tuple[str, float]]:
    """Return the places beside each load on the tracks that share its return conductor.

    Where a load stands on that track as close as to share a node, its own voltage is recorded anyway.
    """
    kms: dict[str, list[float]] = {}
    beside = set()
    for load in sorted(loads, key=lambda load: load.km):
        kms.setdefault(load.track, []).append(load.km)
        number, _ = topology.locate(load.track, load.km)
        beside |= {(track, load.km) for track in topology.spans[number].tracks}
    return sorted((track, km) for track, km in beside if not _is_near(kms.get(track, ()), km))


def _is_near(kms: Sequence[float], km: float) -> bool:
    """Tell whether one of some rising kilometres is so close to another that devices there share a node."""
    after = bisect_left(kms, km)
    return any(abs(other - km) < SHARED_KM for other in kms[max(after - 1, 0) : after + 1])

"""Where contact lines are, by track and place: what the routes of trains are laid over."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tractionpower.supply.topology import Topology


@dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of a track within one span, with its contact line and rails.

    Attributes
    ----------
    track
        Identifier of the track.
    from_m, to_m, ends_km
        Ends by the distance from the start of the track [m] and by kilometre.
    span, positive, negative
        Numbers of the span and of the conductors.
    length_m
        Length of the span [m].
    no_load_v
        Highest no-load voltage that sources put on the contact line; 0 without one [V].
    earthed
        Whether the rails have a potential against earth.
    """

    track: str
    from_m: float
    to_m: float
    ends_km: tuple[float, float]
    span: int
    positive: int
    negative: int
    length_m: float
    no_load_v: float
    earthed: bool


def find_stretches(
    topology: Topology, first_conductor: Sequence[int], no_load_v: Callable[[int], float], is_earthed: Callable[[int], bool]
) -> Iterator[Stretch]:
    """Yield the stretches of all tracks in the order of the spans.

    Parameters
    ----------
    topology
        The conductors.
    first_conductor
        Number of the first conductor of each span.
    no_load_v, is_earthed
        Of a node: the highest no-load voltage that sources put on it [V], and whether it has a potential against earth.
    """
    ends = _span_ends(topology)
    for number, span in enumerate(topology.spans):
        first = first_conductor[number]
        rail = first + len(span.tracks)
        for contact, track in enumerate(span.tracks):
            from_m, to_m = next(ends[track])
            if from_m < to_m:
                volts = no_load_v(span.conductors[contact].left)
                kms, number_of = (span.from_km, span.to_km), first + contact
                yield Stretch(track, from_m, to_m, kms, number, number_of, rail, span.length_m, volts, is_earthed(span.rail.left))


def _span_ends(topology: Topology) -> dict[str, Iterator[list[float]]]:
    """Return the two ends of every span of each track, in the order of the spans [m]."""
    kms: dict[str, list[tuple[float, float]]] = {}
    for span in topology.spans:
        for track in span.tracks:
            kms.setdefault(track, []).append((span.from_km, span.to_km))
    return {track: iter(topology.metres(track, np.array(pairs)).tolist()) for track, pairs in kms.items()}

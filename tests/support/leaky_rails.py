"""Rails that leak, in closed form and by chain matrices: what the leaky networks must give.

Homogeneous rails of resistance r [ohm/km] and leakage g [S/km] are a line with alpha = sqrt(r g) and Zc = sqrt(r/g). A
current I that enters rails of length L, open at both ends, at x lifts the place y by
I Zc cosh(alpha min(x, y)) cosh(alpha (L - max(x, y))) / sinh(alpha L).
"""

import numpy as np
from scipy.linalg import expm

from tractionpower.model.line import Line, Track
from tractionpower.model.loads import Load
from tractionpower.model.supply import ContactLine, ReturnCircuit, Substation, Supply

RAIL_OHM = 0.0055
CONTACT_OHM = 0.05


def open_line_v(injections, length, y, ohm=RAIL_OHM, leak=0.5):
    """Return the potential at y [km] of rails with open ends, from the currents that enter them: pairs (km, A)."""
    alpha, impedance = np.sqrt(ohm * leak), np.sqrt(ohm / leak)
    return sum(
        i * impedance * np.cosh(alpha * min(x, y)) * np.cosh(alpha * (length - max(x, y))) / np.sinh(alpha * length)
        for x, i in injections
    )


def chained_v(injections, sections, end_ohm):
    """Return the potentials of the injected places, rails of several sections (to km, r, g), earthed at both ends.

    Potential and current along the rails follow d/dx (v, i) = -(r i, g v); every current that enters makes i jump. The
    solution is a particular one plus a multiple of the one that starts at the resistance of the first end.
    """
    places = sorted({0.0, *(x for x, _ in injections), *(km for km, *_ in sections)})
    states = np.array([[0.0, 1.0], [0.0, -1.0 / end_ohm[0]]])  # particular, homogeneous
    found = []
    for k, x in enumerate(places):
        states[1, 0] += sum(i for at, i in injections if at == x)
        found.append(states[0].copy())
        if k + 1 < len(places):
            r, g = next((r, g) for km, r, g in sections if x < km)
            states = expm(-np.array([[0.0, r], [g, 0.0]]) * (places[k + 1] - x)) @ states
    left = states[0] / end_ohm[1] - states[1]  # nothing may remain at the last end
    share = -left[0] / left[1]
    return {x: float(v[0] + share * v[1]) for x, v in zip(places, found, strict=True)}


def leaky_line(loads, length=10.0, *, leak=0.5, stations=((10.0, 3600.0),), ohm=RAIL_OHM, **more):
    """Return supply and line: one track, loads as pairs (km, A), substations as pairs (km, no-load voltage)."""
    supply = Supply(
        substations=tuple(
            Substation(id="ABCD"[k], km=km, no_load_voltage_v=volts, internal_resistance_ohm=0.1, conducts="both")
            for k, (km, volts) in enumerate(stations)
        ),
        contact_lines=(ContactLine(from_km=0.0, to_km=length, resistance_ohm_per_km=CONTACT_OHM),),
        return_circuit=more.pop("return_circuit", None)
        or (ReturnCircuit(from_km=0.0, to_km=length, resistance_ohm_per_km=ohm, leakage_s_per_km=leak),),
        loads=tuple(Load(id=f"T{k}", track="1", km=km, current_a=ampere, limits="none") for k, (km, ampere) in enumerate(loads)),
        **more,
    )
    return supply, Line(tracks=(Track(id="1", from_km=0.0, to_km=length),))

"""Keys of the configuration of Arshad et al.: those that they print, and those that fill what they leave out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tractionpower.io.arshad.units import Dimension

KeyKind = Dimension | Literal["file", "text", "choice"]


@dataclass(frozen=True, slots=True)
class Key:
    """A key of the configuration.

    Attributes
    ----------
    name
        How this program calls it.
    spellings
        How it may be written, the one of messages first; capitals and blanks do not matter.
    kind
        Dimension of its value, or what else it is.
    default
        Text that stands where the key is left out; None if the key must be there, an empty text if nothing is assumed.
    source
        Where the default comes from.
    least, most
        Bounds in the unit of the declaration.
    choices
        Words of a choice.
    printed
        Whether the paper prints the key: in section 7.2 or in Table 3.
    """

    name: str
    spellings: tuple[str, ...]
    kind: KeyKind
    default: str | None = ""
    source: str = ""
    least: float = 0.0
    most: float = float("inf")
    choices: tuple[str, ...] = ()
    printed: bool = False


_PAPER = "Arshad et al., section 7.2"
_FILE = "the name in the paper"
_TPS = "train-propulsion-simulator (lnaz01), secondary"

PRINTED: tuple[Key, ...] = (
    Key("rows", ("State vector size", "Memory Allocation"), "count", least=2, printed=True),
    Key("duration", ("Simulation time",), "time", None, least=1e-6, most=86_400.0, printed=True),
    Key("step", ("Step size",), "time", None, least=1e-6, most=10.0, printed=True),
    Key("distance_limit", ("Distance limit",), "length", least=1e-3, printed=True),
    Key("hard_limit", ("Coupler hard limit",), "length", least=1e-6, most=10.0, printed=True),
    Key("first_stage", ("First stage loading",), "stiffness", "10 kN/mm", "Arshad et al., eq. 8", 1e-6, 1e6, printed=True),
    Key("second_stage", ("Second stage loading",), "stiffness", "25 kN/mm", "Arshad et al., eq. 9", 1e-6, 1e6, printed=True),
    Key("locked", ("Locked stiffness",), "stiffness", "600000 N/mm", _PAPER, 1e-6, 1e6, printed=True),
    Key("relaxing", ("Relaxing stiffness",), "stiffness", "600 N/mm", _PAPER, most=1e6, printed=True),
    Key("slack", ("Slack region width",), "length", "0.1 m", _PAPER, most=2.0, printed=True),
    Key(
        "kinetic", ("Kinetic fric coff", "Kinetic friction coefficient"), "number", "0.2", _PAPER, most=2.0, printed=True
    ),
    Key("static", ("Static fric coff", "Static friction coefficient"), "number", "0.4", _PAPER, most=2.0, printed=True),
    Key("wedge", ("Wedge angle",), "angle", "35 degree", _PAPER, 1e-6, 89.0, printed=True),
    Key("cars", ("Cut of cars",), "count", printed=True),
    Key("gross_ratio", ("Gross Braking Ratio", "GBR"), "share", least=1e-6, most=5.0, printed=True),
    Key("mu", ("Mu",), "number", "0.3", "assumed: composition shoes", most=1.0, printed=True),
    Key(
        "rigging", ("Brake Rigging", "Brake Ragging", "Rigging efficiency"), "share", "0.83", "secondary", 1e-6, 1.0,
        printed=True,
    ),
    Key("drag", ("Wind Resistance Drag Coefficient",), "number", most=1000.0, printed=True),
    Key("rolling", ("Rolling Friction Coefficient",), "resistance", most=100.0, printed=True),
    Key("consist", ("Train Consist Path",), "file", "TrainConsist.csv", _FILE, printed=True),
    Key("track", ("Track Profile Path",), "file", "TrackProfile.csv", _FILE, printed=True),
    Key("commands", ("Dynamic Parameters Path", "Dynamic Parameter Path"), "file", "DynamicParameter.csv", _FILE, printed=True),
)  # fmt: skip
"""Keys of section 7.2 and of Table 3."""

FILLED: tuple[Key, ...] = (
    Key("name", ("Name",), "text"),
    Key("record", ("Record every",), "time", least=1e-6),
    Key("method", ("Method",), "choice", "symplectic", "the paper names none",
        choices=("symplectic", "rk4", "euler", "variable")),
    Key("start", ("Start position",), "length", most=1e7),
    Key("start_couplings", ("Couplings at the start",), "choice", "stretched",
        "a train that stands on a rising grade hangs at its locomotive", choices=("stretched", "centred", "bunched")),
    Key("grade", ("Grade",), "choice", "vehicle", "eq. 11 is exact for uniform trains only", choices=("vehicle", "train")),
    Key("units", ("Units of figures",), "choice", choices=("metric", "imperial")),
    Key("knee", ("First stage deflection",), "length", "50 mm", "Arshad et al., eq. 8", 1e-6, 1.0),
    Key("gears", ("Draft gears in series",), "count", "1", "the stages are read as those of the whole connection", 1.0, 4.0),
    Key("blending", ("Friction blending speed",), "speed", "0.1 m/s", "assumed: v_f has no number in the paper", 1e-6, 10.0),
    Key("locked_damping", ("Locked damping",), "damping", "200 N s/mm", "assumed: some 4 % of the mode of two 25 t cars",
        most=1e5),
    Key("net_ratio", ("Net Braking Ratio", "NBR"), "share", "0.12", "assumed", 1e-6, 5.0),
    Key("speed_resistance", ("Speed Resistance Coefficient",), "speed_resistance", "0.03 lb/ton/mph",
        f"Canadian National, by {_TPS}", most=10.0),
    Key("curve_resistance", ("Curve Resistance",), "curve_resistance", "0.8 lb/ton/deg", "TR0603, US Army, secondary", most=10.0),
    Key("rotating", ("Rotating mass",), "share", "4 %", "assumed", most=1.0),
    Key("notches", ("Notches",), "count", "8", "Arshad et al., section 2.9", 1.0, 100.0),
    Key("pipe", ("Brake pipe pressure",), "pressure", "90 psi", "freight in North America, secondary", 0.1, 15.0),
    Key("full_service", ("Full service reduction",), "pressure", "26 psi", "secondary", 0.01, 15.0),
    Key("cylinder_ratio", ("Cylinder ratio",), "number", "2.5", "Open Rails, default", 0.01, 100.0),
    Key("cylinder", ("Cylinder pressure",), "pressure", "64 psi", "Open Rails, default", 0.01, 15.0),
    Key("cylinder_emergency", ("Emergency cylinder pressure",), "pressure", "74.6 psi",
        f"Boyle, AAR reservoirs by {_TPS}", 0.01, 15.0),
    Key("application", ("Brake application time constant",), "time", "3 s", "assumed", most=600.0),
    Key("release", ("Brake release time constant",), "time", "6 s", "assumed", most=600.0),
    Key("propagation", ("Brake propagation speed",), "speed", "800 ft/s", "altrios, comment, secondary", 1.0, 1e5),
)  # fmt: skip
"""Keys of ours for what the paper leaves out; each has a default, or does nothing."""

KEYS = PRINTED + FILLED

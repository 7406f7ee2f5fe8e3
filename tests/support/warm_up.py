"""Compiles all kernels once, before several workers start and each would compile them: ``python -m tests.support.warm_up``."""

import sys
import tempfile
import time
from pathlib import Path

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.scenario import Scenario


def tiny_scenario() -> Scenario:
    stretch = {"from_km": 0.0, "to_km": 2.0}
    return Scenario.model_validate(
        {
            "line": {"tracks": [stretch | {"id": "1"}]},
            "supply": {
                "substations": [{"id": "A", "km": 0.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12}],
                "contact_lines": [stretch | {"resistance_ohm_per_km": 0.05}],
                "return_circuit": [stretch | {"resistance_ohm_per_km": 0.01}],
                "loads": [{"id": "depot", "track": "1", "km": 1.0, "power_kw": 400.0}],
            },
            "clock": {"start": 0.0, "end": 1.0},
            "limits": shipped_limits(),
        }
    )


def _run_trains() -> None:
    """Compile what journeys and curves of trains need; kinds of drive share the kernels."""
    sys.path.insert(0, str(Path(__file__).parent))
    from small_trains import make_trains  # noqa: PLC0415

    from tractionpower.movement.curves import drive_curves  # noqa: PLC0415
    from tractionpower.movement.journey import theoretical_journeys  # noqa: PLC0415

    scenario = make_trains(0.2)
    theoretical_journeys(make_trains(2.0, end="stop", driving={"kind": "reserve", "percent": 5.0}))
    for form in ("time", "speed"):
        theoretical_journeys(scenario, form=form)
    drive_curves(scenario.trains[0], scenario.vehicles, scenario.limits)


def _run_coupled() -> None:
    """Compile what trains and network need together, with windows, spells and sums, and loads of devices."""
    from coupled import couple, run  # noqa: PLC0415

    from tractionpower.cosimulation.quiet import run_quietly  # noqa: PLC0415
    from tractionpower.cosimulation.simulate import simulate  # noqa: PLC0415
    from tractionpower.cosimulation.tables import compile_scenario  # noqa: PLC0415
    from tractionpower.studies.ratings.watch import RatingsWatch  # noqa: PLC0415

    scenario = couple(run("E"), end_s=5.0)
    run_quietly(scenario, RatingsWatch(scenario, compile_scenario(scenario)).watches)
    simulate(couple(run("E"), run("S", "series_motors"), run("T", "table", "2", 20.0, 0.0, speed_kmh=60.0), end_s=20.0))


def _run_chain() -> None:
    """Compile what a train as many vehicles needs; all methods share one entry."""
    from chains import pulled, spring  # noqa: PLC0415

    from tractionpower.dynamics.session import Session  # noqa: PLC0415

    session = Session(pulled(2, spring(10.0)))
    session.advance(0.1)
    session.snapshot()


def main() -> None:
    from tractionpower.cosimulation.simulate import simulate  # noqa: PLC0415 - importing it is part of what is timed

    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        simulate(tiny_scenario(), folder)
    _run_trains()
    _run_coupled()
    _run_chain()
    print(f"kernels are compiled: {time.perf_counter() - started:.1f} s")


if __name__ == "__main__":
    main()

"""Results of every kind that a workbook is made of, small and with names that nobody should have."""

from pathlib import Path

from fake_dynamics import fake_results, fake_scenario
from fake_feasibility import REMEDIES, judged
from fake_results import NASTY, make_case
from fake_sizing import outages, sized
from small_stations import CASE
from small_stations import make_case as make_stations
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.dynamics.simulate import simulate_case
from tractionpower.io.library import change
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.studies.compare.study import compare
from tractionpower.studies.sweep.study import sweep

RESISTANCE = "supply.substations[A].internal_resistance_ohm"
KINDS = ("run", "feasibility", "size", "contingency", "sweep", "compare", "dynamics", "stations")


def make_kind(kind: str, folder: Path, *, nasty: bool = False) -> tuple[Results, Scenario | DynamicsScenario | StationsCase]:
    """Return results and scenario of a kind of study; `folder` takes the runs that a comparison is made of."""
    if kind == "dynamics":
        return _dynamics(folder, nasty)
    if kind == "stations":
        return _stations(folder, nasty)
    if kind in ("sweep", "compare"):
        return (_sweep if kind == "sweep" else _compare)(folder, nasty)
    results, scenario = make_case(trains=len(NASTY) if nasty else 4, substations=9 if kind == "contingency" else 3, nasty=nasty)
    if kind == "feasibility":
        late = {run.id: {"voltage": 70.0, "driving": 5.0} for run in scenario.runs[1:3]}
        results = judged(results, scenario, late, **REMEDIES)
    elif kind == "size":
        results = sized(results, scenario)
    elif kind == "contingency":
        results = outages(scenario)
    return results, scenario


def _loads(nasty: bool) -> Scenario:
    names = [name for name in NASTY if not name.startswith("#")] if nasty else ["tap", "depot"]
    loads = [load(name, 2.0 + 2.0 * k, power_kw=300.0 + 100.0 * k) for k, name in enumerate(names)]
    return make_scenario(*loads, name='=HYPERLINK("x") & <b> &P' if nasty else "taps & more")


def _sweep(folder: Path, nasty: bool) -> tuple[Results, Scenario]:
    scenario = _loads(nasty)
    varied = {
        "supply.substations[A].internal_resistance_ohm": [0.06, 0.3],
        "supply.section_cabins[C].state": ["closed", "=cmd()"],
    }
    return sweep(scenario, varied), scenario


def _compare(folder: Path, nasty: bool) -> tuple[Results, Scenario]:
    scenario = _loads(nasty)
    names = ("'base' & [x]", "@sum") if nasty else ("base", "strong")
    for name, one in zip(names, (scenario, change(scenario, [f"{RESISTANCE}=0.06"])), strict=True):
        simulate(one, folder / name)
    return compare([folder / name for name in names]), scenario


def _dynamics(folder: Path, nasty: bool) -> tuple[Results, DynamicsScenario]:
    case = {"name": '=HYPERLINK("x") & <b> &P', "source": "@sum(1) & more"} if nasty else {}
    return fake_results(folder, **case), fake_scenario(**case)


def _stations(folder: Path, nasty: bool) -> tuple[Results, StationsCase]:
    named = [CASE["stations"][0] | {"name": "@sum & <A>"}, CASE["stations"][1] | {"name": "-7"}]
    words = {"name": '=HYPERLINK("x") & <b> &P', "source": "@sum(1) & more", "stations": named} if nasty else {}
    case = make_stations(traffic={"trains": 3, "headway_s": 60.0}, gradients=[{"from_m": 500.1, "to_m": 900.0, "permille": 6.0}],
                     curves=[{"from_m": 3000.0, "to_m": 3300.0, "radius_m": 450.0, "turns": "left"}], **words)  # fmt: skip
    return simulate_case(case, folder), case

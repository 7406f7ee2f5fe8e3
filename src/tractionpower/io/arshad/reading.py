"""Reading of a configuration of Arshad et al. with the files that it names, into a case; all problems at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PureWindowsPath
from typing import Any, TypeVar

from pydantic import BaseModel

from tractionpower.errors import Problem
from tractionpower.io.arshad.commands import read_commands
from tractionpower.io.arshad.consist import Consist, read_consist
from tractionpower.io.arshad.conversion import COUPLING, air_mark, brake_data, coupling_data, run_data
from tractionpower.io.arshad.settings import OF_KEYS, Settings, read_settings, spelling_of
from tractionpower.io.arshad.track import Profile, read_track, track_data
from tractionpower.io.case_finder import FoundCase
from tractionpower.io.documents import Reader
from tractionpower.io.problems import Input
from tractionpower.io.provenance import Mark
from tractionpower.io.shapes import shape_of
from tractionpower.io.text_files import Source
from tractionpower.model.dynamics.case import Case, DynamicsScenario
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.vehicle import Vehicle

Model = TypeVar("Model", bound=BaseModel)

PAPER = "M. J. Arshad et al., Mathematical modeling of train dynamics: a step towards PC train simulator"


def read_arshad(reader: Reader, found: FoundCase) -> tuple[DynamicsScenario | None, Mark]:
    """Return what the configuration describes and the files and lines of it; None if there are errors.

    Problems go to `reader`. Also of a broken file the others are read, so that all is told in the same breath.
    """
    root = Mark(found.file.name)
    settings = read_settings(reader, Source(found.file, found.file.name, ""))
    if settings is None:
        return None, root
    of_keys = [problem for problem in reader.problems if problem.code in OF_KEYS]  # the case is whole all the same
    settings_failed = _has_failed(reader, of_keys)
    consist = read_consist(reader, _named(reader, settings, found.file, "consist"), settings)
    profile = read_track(reader, _named(reader, settings, found.file, "track"))
    source = _named(reader, settings, found.file, "commands")
    commands, mark = read_commands(reader, source, int(settings.number("notches")))
    if settings_failed:
        return None, root
    case, case_mark = _case_data(reader, settings, found, consist, profile)
    case["commands"], case_mark.children["commands"] = commands, mark
    coupling, coupling_mark = coupling_data(settings, reader.problems)
    if consist is None or profile is None or _has_failed(reader, of_keys):
        return None, root
    _check_cars(reader, settings, consist, case)
    names = [vehicle["id"] for vehicle in consist.vehicles]
    marks: dict[str | int, Mark] = {k: consist.mark.children[k] for k in range(len(names))}
    root.children |= {
        "case": case_mark,
        "vehicles": Mark(consist.mark.file, 0, marks, {name: k for k, name in enumerate(names)}),
        "couplings": Mark(found.file.name, 0, {0: coupling_mark}, {COUPLING: 0}),
    }
    declared = _validated(reader, Case, "case", case, case_mark, found.file)
    vehicles = [
        _validated(reader, Vehicle, f"vehicles[{name}]", vehicle, consist.mark.children[k], found.file)
        for k, (name, vehicle) in enumerate(zip(names, consist.vehicles, strict=True))
    ]
    connection = _validated(reader, Coupling, f"couplings[{COUPLING}]", coupling, coupling_mark, found.file)
    if declared is None or connection is None or _has_failed(reader, of_keys):
        return None, root
    known = tuple(vehicle for vehicle in vehicles if vehicle is not None)
    return DynamicsScenario(case=declared, vehicles=known, couplings=(connection,)), root


def _has_failed(reader: Reader, aside: Sequence[Problem]) -> bool:
    """Return whether there is an error other than those `aside`."""
    return any(problem.severity == "error" and problem not in aside for problem in reader.problems)


def _case_data(
    reader: Reader, settings: Settings, found: FoundCase, consist: Consist | None, profile: Profile | None
) -> tuple[dict[str, Any], Mark]:
    gear, air = brake_data(settings, reader.problems)
    run, run_mark = run_data(settings, reader.problems)
    mark = Mark(settings.label, 0, {"run": run_mark, "air_brake": air_mark(settings)})
    gear_keys = {"brake_ratio": "gross_ratio" if settings.is_given("gross_ratio") else "net_ratio", "friction": "mu"}
    mark.children["brake"] = Mark(settings.label, 0, {name: settings.mark(key) for name, key in gear_keys.items()})
    assumed = settings.assumed()
    told = f"Assumed, as the configuration leaves it out: {'; '.join(assumed)}." if assumed else "Nothing is assumed."
    case: dict[str, Any] = {
        "name": settings.text("name") or found.name,
        "source": f"{PAPER}. {told}",
        "coupling": COUPLING,
        "brake": gear,
        "air_brake": air,
        "start": {"couplings": settings.text("start_couplings")},
        "run": run,
        "grade": settings.text("grade"),
        "units": settings.text("units") or ("imperial" if profile is not None and profile.feet else "metric"),
    }
    if consist is not None:
        case["vehicles"], mark.children["vehicles"] = consist.parts, consist.mark
    if consist is not None and profile is not None:
        start_m = settings.optional("start")
        curve = settings.number("curve_resistance")
        case["track"], mark.children["track"] = track_data(
            profile, consist.length_m if start_m is None else start_m, consist.length_m, curve
        )
    return case, mark


def _check_cars(reader: Reader, settings: Settings, consist: Consist, case: dict[str, Any]) -> None:
    cars = settings.optional("cars")
    if cars is not None and int(cars) != consist.cars:
        allowed = f"{consist.cars}, as {consist.mark.file} has"
        told = settings.problem("cars", "contradiction", str(int(cars)), allowed, "mend the configuration or the consist")
        reader.problems.append(told)
    brakes = [k for k, command in enumerate(case["commands"]) if command.get("electric")]
    if brakes and not consist.has_electric:
        source = Source(Path(consist.mark.file), consist.mark.file, "")
        found = "no dynamic brake, and the commands apply one"
        remedy = "add the columns Dynamic Brake Effort (kN) and Dynamic Brake Power (kW)"
        reader.problems.append(source.problem("missing_column", found, remedy=remedy, line=1))


def _named(reader: Reader, settings: Settings, namer: Path, key: str) -> Source:
    # The paper's program runs on Windows: its paths may have backslashes.
    name = settings.text(key)
    name = PureWindowsPath(name).as_posix() if "\\" in name else name
    return reader.named(name, namer, "", f"{settings.mark(key).place} {spelling_of(key)}")


def _validated(reader: Reader, model: type[Model], root: str, data: dict[str, Any], mark: Mark, file: Path) -> Model | None:
    # The values obey the bounds of the configuration; what the declarations refuse beyond that is told by our own keys.
    return reader.validated(model, Input(root, data, mark, shape_of(model), file))

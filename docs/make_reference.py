"""Write the reference pages: docs/inputs.md from the declarations, docs/results.md also from a run of the template study,
and the tables of equipment that ships in docs/conductors.md and docs/ratings.md.

What a run writes and this page does not describe, or the other way round, is an error.
"""

from __future__ import annotations

import re
import tempfile
import types
import typing
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

import tractionpower as tp
from tractionpower.cosimulation import events
from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.io.templates import write_template
from tractionpower.kernels.train_tables import LIMITED_BY, PHASES
from tractionpower.model.conductors import Conductor
from tractionpower.model.dynamics.case import Case
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.limits import Limit, common_limits
from tractionpower.model.line import Line
from tractionpower.model.measured import MeasuredMap
from tractionpower.model.quantity import unit_of
from tractionpower.model.ratings import DutyRow, RectifierUnit
from tractionpower.model.report import Report
from tractionpower.model.scenario import StudyFile
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.results import rails
from tractionpower.results.columns import TABLES
from tractionpower.results.touch import touch_limits
from tractionpower.results.windows import WINDOWS_S, window_label

HERE = Path(__file__).parent
FILES = {
    "study.yaml": StudyFile,
    "line.yaml": Line,
    "supply.yaml": Supply,
    "timetable.yaml": Timetable,
    "rollingstock/trains/ID.yaml": Train,
    "rollingstock/vehicles/ID.yaml": Vehicle,
    "limits (CSV)": Limit,
    "conductors (CSV)": Conductor,
    "duty_classes (CSV)": DutyRow,
    "rectifier_units (CSV)": RectifierUnit,
    "map of a measurement (YAML)": MeasuredMap,
    "report.yaml (template of reports)": Report,
    "case.yaml (train dynamics)": Case,
    "case.yaml (train dynamics, kind: stations)": StationsCase,
    "rollingstock/couplings/ID.yaml": Coupling,
}
INPUTS = """Units stand in the names. A list may be the name of a CSV file instead, relative to the file that names it; its
header row names the keys, those of a nested mapping with dots (`start.time`). A column that is a list of rows itself, such as
`calls`, holds names of further CSV files.

Trains, vehicles and couplings are looked for by their id in `rollingstock` of the folder of the study or case, then of the
working folder, then among what ships. A character of an id that a file name cannot hold is written as `%` and two
hexadecimal digits (`a%2Fb.yaml` for a/b).
"""
CONDUCTORS = ("<!-- conductors that ship: made by `make docs`; do not edit -->\n", "<!-- end of the conductors that ship -->\n")
RATINGS = ("<!-- ratings that ship: made by `make docs`; do not edit -->\n", "<!-- end of the ratings that ship -->\n")
KINDS = {"contact_line": "Contact lines", "wire": "Wires", "cable": "Cables", "rail": "Rails (both rails of one track)"}
NOTE = "<!-- made by `make docs` from the declarations; do not edit -->\n"
SIGNS = """Parquet files in the folder of the run. Currents and powers are positive when taken from the line, and when a
substation feeds. A row describes the step that begins at `time_s`: place, speed and phase are those of that instant; forces,
currents, voltages and powers are means of the step, so the sum of `power_kw` times the step is the energy. A train has rows
while it is on the line; where it enters or leaves within a step, the means are those of the whole step. A table that would have
no rows may be missing.
With `output.every_s` only the steps at that interval have rows; key figures use all of them.
"""
PHASE = {
    "accelerating": "gives all the traction that it may and is below its ceiling; on a slope it may lose speed",
    "cruising": "keeps to the speed ceiling",
    "coasting": "rolls: a train without a drive",
    "braking": "brakes towards a lower limit or a stop",
    "dwelling": "stands at a stop, or at the end of its route",
    "waiting": "is not on the line yet at the start of the step",
    "holding": "stands on its way, as its effort does not move it",
    "unpowered": "wishes to pull and gets no traction: below U_min2, with an open undervoltage relay, where the power is off, "
    "on a dead line, at a stop even that it cannot leave",
}
LIMIT = {
    "nothing": "the driver gets the starting effort, or wishes none",
    "speed": "the speed ceiling: the driver wishes no more",
    "adhesion": "adhesion between wheel and rail",
    "drive": "power or characteristic of the drive",
    "line_current": "largest train current of the line (`line.train_current_limits`)",
    "train_current": "largest current of the train itself",
    "voltage": "the voltage: current limit below the knee, power over voltage, natural curve of series motors below U_n, "
    "a dead line",
    "power_off": "a stretch of `line.power_off`, in all of the step or a part of it",
    "standstill_current": "largest current at standstill (`line.train_current_limits`), which cuts heating, then auxiliaries",
}
EVENTS = {
    "train_entered": ("a train comes onto the line", "", ""),
    "train_left": ("a train leaves the line", "", ""),
    "stop": ("a train stops at a station", "", ""),
    "departure": ("a train departs from a station", "", ""),
    "low_voltage": ("spell of a train below U_min2", "lowest voltage [V]", "U_min2"),
    "high_voltage": ("spell of a train above U_max2", "highest voltage [V]", "U_max2"),
    "current_limited": (
        "spell of a train whose effort is cut by voltage, line current or train current, or at standstill its auxiliaries",
        "lowest voltage [V]",
        "",
    ),
    "voltage_lost": ("a train comes onto a dead line, or the line goes dead", "", ""),
    "stopped_without_voltage": ("a train comes to a stand on a dead line", "time without [s]", ""),
    "voltage_back": ("its line has voltage again", "time without [s]", ""),
    "regrouped": ("series motors change their grouping", "motors in series after", "before"),
    "substation_blocked": ("spell in which the rectifiers block", "highest voltage of the busbar [V]", "no-load voltage"),
    "not_servable": ("spell in which all demand had to be cut (`limits: none`)", "smallest share that can be served", "1"),
    "not_converged": ("spell of steps in which a node does not balance", "largest imbalance [A]", "limit of a flag"),
    "switched": ("a device gets another state, by time or by reclosure", "", ""),
    "tripped": ("a breaker opens by overcurrent", "current [A]", "current above which it trips"),
    "vld_closed": ("a voltage-limiting device closes", "rail potential [V]", "potential above which it closes"),
    "line_dead": ("nothing feeds a stretch of contact line any more", "", ""),
    "line_live": ("a stretch of contact line is fed again", "", ""),
    "limit_violated": ("a verdict that is not met, at the time of its worst value", "what was found", "the limit"),
}
SPELLS = "A spell is one event, at its start; `message` tells its end. `track` and `position_km` are those of the start."
RUN_JSON = {
    "format": "1; a newer one is refused",
    "status": "`complete`; `flagged`: a step did not converge or could not be served, or a ledger does not close; `interrupted`",
    "study, name": "folder and name of the study",
    "input_hash": "SHA-256 of the canonical JSON of the resolved inputs, whatever the files were called",
    "seed": "seed of everything that is drawn",
    "step_s, start_s, end_s": "the clock [s]; of an interrupted run, the end of what was computed",
    "coupling": "`full` or `constant_voltage`; then also `coupling_voltage_v`, the voltage [V]",
    "versions": "tractionpower and the packages that results can depend on",
    "wall_seconds, compile_seconds": "time of the run, and of checks, tables, compilation before it [s]",
    "steps, flagged_steps": "steps computed, and those that did not converge or could not be served",
    "worst_residual_a, residual_limit_a": "largest imbalance of a node in any step, and the one from which a step is flagged [A]",
    "mean_iterations": "solutions of the linear network in a step, mean",
    "ledgers": "`electric`, `mechanical`, `pantograph_to_wheel`: `closes`, worst gap, energies [kWh]; formulas: docs/model.md",
    "verdicts": "found values against limits, below",
    "overlaps": "pairs of trains that stood in each other: `count`, and in words which",
    "trains": "each with `status`, `entered_s`, `finished_s`, `distance_m`, `overdue_s` at a call not reached; "
    "status: `left` the line, `before` the clock even, `stays` at its end, `on_line` at the end of the clock, `stuck` there (its "
    "effort has not moved it for a minute or more), `outside`: never came",
    "lumping": "error that lumping the rails into the contact line would make, at the step with the lowest voltage of a train: "
    "`train`, `time`, `voltage_v`, `lumped_voltage_v`, `largest_difference_v` at any train or load; empty without trains",
    "notes": "what a reader has to know: constant voltage, trains that are stuck",
    "links": "feeders, return feeders and switches: each with `place` as in the key figures, `kind` (feeder, cabin, return, "
    "switch), `track`, `km`, `normal_state`, and `trip_current_a` or null",
    "files": "size and SHA-256 of every file",
}
RUN_JSON_OF_RAILS = {
    "return_circuit": "where something defines remote earth: how many places, and `touch_voltage` and `stray_current`, found "
    "against allowed, with what is told and not judged (`met` is null)",
}
"""Keys that only some runs have."""

FILES_OF_A_RUN = """## Other files

| file | holds |
|---|---|
| `run.json` | How the run went, below. Written last: results are what it names. |
| `key_figures.json` | The figures that sum the run up, below. |
| `scenario.json` | What was computed, resolved: all inputs in one file. Its SHA-256 is the `input_hash` of the run. |
| `figures/` | PNG: train graph, voltages along the line, loads of substations, rail potentials; in `trains/` single trains. |
| `report.xlsx` | Verdicts, limits, trains, calls, substations, feeders, rails, energy, charts, events, inputs, definitions. |
| `report.yaml` | The template of the reports with its logo, where there is one: [Reports](reports.md). |
| `.running/` | Complete parts of the tables while a run lasts. `tractionpower report DIR --partial` reads them after a crash. |

Figures and workbook are made from the tables: `tractionpower report DIR` writes them again without a simulation. A file that
another program holds open stays, and the new one stands beside it with `.new` before its suffix. `tractionpower journey`
writes `trains`, `calls`, `key_figures.json` and `run.json` of the same form. `feasibility` keeps the trial runs of a search that
was broken off in `.running/`, and goes on from them when the study is judged into the same folder again.
"""
EXPORT = """## Tables for other programs

`tractionpower export DIR --to csv,xlsx,netcdf [--tables trains,calls] [--out FOLDER]` writes into `DIR/export/`.

- **csv**: one file for each table. UTF-8, comma, decimal point; a missing value is an empty cell. Texts are quoted and stand
  there as they are: Excel takes one that begins with `=` for a formula when it opens a CSV file, so hand on xlsx instead.
- **xlsx**: one workbook `tables.xlsx` with a sheet for each table; nothing in it becomes a formula. A table that is longer
  than a sheet (1 048 575 rows) is refused: export it as CSV.
- **netcdf**: one file for each table (classic format with 64-bit offsets), a variable for each column over the dimension
  `row`, with unit and meaning. A missing number is NaN. Needs SciPy: `pip install tractionpower[netcdf]`.
"""
VERDICTS = """## Verdicts

Each has `name`, `value`, `unit`, `place`, `time`, `limit` with `limit_value`, `source` and `status`, and `met`. A voltage is
beyond a limit when it is so by more than 0.1 V. Limits are rows of `src/tractionpower/data/limits.csv`, overlaid by `limits:` of
the study; a verdict whose limit the system has no row for is left out. Rows of system `dc` hold for all DC systems that have
none of their own. Those of `touch_` and `stray_` are judged where the rails have a potential (docs/model.md, Rail potential);
`limit_value` of a touch voltage is how long a spell above it may last, `voltage_v` the voltage.

| verdict | unit | limit | status of the limit that ships for dc3000 |
|---|---|---|---|"""
FIGURES = """## key_figures.json

A list of `name`, `value`, `unit`, `place`, `time` (HH:MM:SS), `definition`, `status`. The place is `train ID`, `substation ID`,
`load ID`, `feeder AT TRACK SIDE` (of a substation or section cabin; side return: return feeder), `switch ID`, `zone A–B`
(between two neighbouring substations), `earthing ID` or `voltage-limiting device ID`; figures of the whole run have none, or
that of the extreme value.
W in a name is a window: WINDOWS.
Windows longer than the run are left out, as are figures without a value, such as the delay of a train without planned times.
Steps before the end of `clock.warm_up` count in lengths, times, delays, energies of auxiliaries and losses, and the energies of
the whole run only.
"""


def inputs_page() -> str:
    """Return the page of all input keys."""
    parts = [NOTE, "# Input files\n", INPUTS]
    for title, model in FILES.items():
        parts.append(f"## {title}\n")
        parts.append(_table(model))
        parts += [f"### {path}\n\n{_table(part)}" for path, part in _parts(model)]
    return "\n".join(parts)


def results_page() -> str:
    """Return the page of all results."""
    results = run_template()
    parts = [NOTE, "# Results of a run\n", SIGNS]
    for name, columns in TABLES.items():
        parts.append(f"## {name}.parquet\n\n| column | unit | meaning |\n|---|---|---|")
        parts += [f"| `{c.name}` | {c.quantity.unit} | {c.quantity.meaning} |" for c in columns]
        parts.append("")
        if name == "trains":
            parts += [_words("phase", PHASE, PHASES), _words("limited_by", LIMIT, LIMITED_BY)]
    parts += [_kinds_of_events(), FILES_OF_A_RUN, _keys_of_run(results.run)]
    parts += [VERDICTS, *_verdicts(results.run["verdicts"]), *_verdicts_of_rails(), ""]
    parts += [
        FIGURES.replace("WINDOWS", ", ".join(f"`{window_label(window)}`" for window in WINDOWS_S)),
        *_figures(results.key_figures),
        *_figures_of_rails(),
    ]
    return "\n".join([*parts, EXPORT])


def conductors_page() -> str:
    """Return the page of conductors with the table of those that ship."""
    return _with_shipped("conductors.md", CONDUCTORS, _shipped_conductors())


def ratings_page() -> str:
    """Return the page of ratings with the duty classes, rectifier units and limits that ship."""
    return _with_shipped("ratings.md", RATINGS, _shipped_ratings())


def _with_shipped(name: str, marks: tuple[str, str], lines: Iterable[str]) -> str:
    """Return a page with the lines between its two marks replaced."""
    begin, end = marks
    before, _, rest = (HERE / name).read_text(encoding="utf-8").partition(begin)
    return before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.partition(end)[2]


def _shipped_conductors() -> Iterator[str]:
    """Yield a table for each kind of conductor, then their sources, which rows name by number."""
    rows = shipped_conductors()
    sources = {source: number for number, source in enumerate(dict.fromkeys(row.source for row in rows), 1)}
    more = {
        "contact_line": {"wires": "wires"},
        "wire": {"area_mm2": "area [mm²]", "per_kelvin": "coefficient [1/K]", "diameter_mm": "diameter [mm]",
                 "highest_c": "highest permanent temperature [°C]"},
        "cable": {"area_mm2": "area [mm²]", "per_kelvin": "coefficient [1/K]", "rated_current_a": "continuous current [A]"},
        "rail": {"area_mm2": "area [mm²]", "per_kelvin": "coefficient [1/K]", "rated_current_a": "continuous current [A]"},
    }  # fmt: skip
    for kind, title in KINDS.items():
        headings = " | ".join(more[kind].values())
        yield f"### {title}\n\n| name | resistance at 20 °C [Ω/km] | {headings} | status | source |"
        yield "|---" * (len(more[kind]) + 4) + "|"
        for row in rows:
            if row.kind == kind:
                ohm = "by its wires" if row.resistance_ohm_per_km is None else _short(row.resistance_ohm_per_km)
                cells = " | ".join(_short(getattr(row, name)) for name in more[kind])
                yield f"| `{row.name}` | {ohm} | {cells} | {row.status} | {sources[row.source]} |"
        yield ""
    yield from _numbered(sources)


def _shipped_ratings() -> Iterator[str]:
    """Yield the tables of duty classes, of rectifier units and of the limits that ratings use, then their sources."""
    duty, units = DUTY_CLASSES.shipped, RECTIFIER_UNITS.shipped
    limits = [limit for limit in shipped_limits() if limit.name.startswith(("window_", "wire_", "grid_"))]
    every = [row.source for rows in (duty, units, limits) for row in rows]
    sources = {source: number for number, source in enumerate(dict.fromkeys(every), 1)}
    yield "### Duty classes\n"
    yield "| class | window [s] | permitted, in rated currents | meaning | status | source |\n|---|---|---|---|---|---|"
    for row in duty:
        window = _short(row.window_s) if row.window_s else "whole run"
        yield f"| {row.duty_class} | {window} | {row.multiple:g} | {row.meaning} | {row.status} | {sources[row.source]} |"
    yield "\n### Rectifier units\n"
    columns = {"rated_current_a": "rated current [A]", "rated_voltage_v": "rated voltage [V]", "duty_class": "class",
               "pulses": "pulses", "transformer_mva": "transformer [MVA]", "short_circuit_percent": "u_k [%]",
               "load_loss_kw": "load losses [kW]"}  # fmt: skip
    yield f"| unit | {' | '.join(columns.values())} | status | source |\n" + "|---" * (len(columns) + 3) + "|"
    for unit in units:
        cells = " | ".join(_short(getattr(unit, name)) for name in columns)
        yield f"| `{unit.unit}` | {cells} | {unit.status} | {sources[unit.source]} |"
    yield "\n### Limits that ratings and outages use\n"
    yield "| name | value | unit | meaning | status | source |\n|---|---|---|---|---|---|"
    for limit in limits:
        yield f"| `{limit.name}` | {limit.value:g} | {limit.unit} | {limit.meaning} | {limit.status} | {sources[limit.source]} |"
    yield ""
    yield from _numbered(sources)


def _short(value: Any) -> str:
    return "" if value is None else value if isinstance(value, str) else f"{value:g}"


def _numbered(sources: dict[str, int]) -> Iterator[str]:
    yield "### Sources\n"
    yield from (f"{number}. {source}" for source, number in sources.items())
    yield ""


def run_template() -> tp.Results:
    """Return a run of the study that `tractionpower new` writes, long enough for all windows."""
    with tempfile.TemporaryDirectory() as folder:
        write_template(Path(folder) / "study")
        scenario = tp.change(tp.load(Path(folder) / "study"), [f"clock.end={WINDOWS_S[-1] / 3600.0 + 1.0:02.0f}:00:00"])
        return tp.simulate(scenario)


def _agree(what: str, told: Iterable[str], found: Iterable[str]) -> None:
    if set(told) != set(found):
        raise SystemExit(f"docs/make_reference.py: {what}: told or found only {sorted(set(told) ^ set(found))}")


def _words(column: str, meanings: dict[str, str], found: Iterable[str]) -> str:
    _agree(column, meanings, found)
    rows = [f"| `{word}` | {meaning} |" for word, meaning in meanings.items()]
    return "\n".join([f"| `{column}` | meaning |", "|---|---|", *rows, ""])


def _kinds_of_events() -> str:
    _agree("kinds of events", EVENTS, events._TOLD)
    rows = ["| `kind` | what | `value` | `limit` |", "|---|---|---|---|"]
    rows += [f"| `{kind}` | {' | '.join(words)} |" for kind, words in EVENTS.items()]
    return "\n".join([*rows, "", SPELLS, ""])


def _keys_of_run(run: dict[str, Any]) -> str:
    _agree("run.json", [key for keys in RUN_JSON for key in keys.split(", ")], [*run, "files"])
    told = RUN_JSON | RUN_JSON_OF_RAILS
    rows = [f"| {', '.join(f'`{key}`' for key in keys.split(', '))} | {meaning} |" for keys, meaning in told.items()]
    return "\n".join(["## run.json\n\n| key | holds |\n|---|---|", *rows, ""])


def _verdicts(verdicts: list[dict[str, Any]]) -> Iterator[str]:
    for each in verdicts:
        limit = f"`{each['limit']}`, {each['limit_value']:g} {each['unit']}"
        yield f"| {each['name']} | {each['unit']} | {limit} | {each['status']}: {each['source']} |"


def _verdicts_of_rails() -> Iterator[str]:
    limits = shipped_limits()
    for touch in touch_limits(limits, "dc3000", 1.0):
        if touch.judged:
            name, known = touch.limit.name, f"{touch.limit.status}: {touch.limit.source}"
            title = f"longest spell of the rail potential above {touch.voltage_v:g} V"
            yield f"| {title} | s | `{name}`, {touch.may_last_s:g} s | {known} |"
    told = {
        "stray_current": "mean stray current",
        "stray_shift_open": "mean rail potential, leakage up to that of an open formation",
        "stray_shift_closed": "mean rail potential, leakage up to that of a closed formation",
        "stray_leakage_closed": "leakage conductance, where it is higher",
    }
    named = common_limits(limits, "dc3000", "stray_")
    for name, title in told.items():
        limit = named[name]
        yield f"| {title} (a day) | {limit.unit} | `{name}`, {limit.value:g} {limit.unit} | {limit.status}: {limit.source} |"


def _figures_of_rails() -> Iterator[str]:
    for title, figures in (("rails", rails.FIGURES), ("earthing, voltage-limiting device", rails.DEVICE_FIGURES)):
        rows = [f"| `{name}` | {unit_of(name)} | {meaning} |" for name, meaning in figures.items()]
        if figures is rails.FIGURES:
            rows.append(f"| `longest_spell_above_LIMIT_s` | s | {rails.SPELL_FIGURE}; a point in it becomes `_` |")
        yield "\n".join([f"| {title} | unit | definition |", "|---|---|---|", *rows, ""])


def _figures(figures: list[dict[str, Any]]) -> Iterator[str]:
    """Yield a table for each kind of place, windows taken together."""
    count = Counter(figure["name"] for figure in figures)
    labels = "|".join(window_label(window) for window in WINDOWS_S)
    rows: dict[str, dict[str, str]] = {"": {}, "substation": {}, "feeder": {}, "load": {}, "train": {}, "zone": {}}
    for figure in figures:
        kind = figure["place"].split(" ")[0]
        if kind not in ("load", "zone") and count[figure["name"]] == 1:
            kind = ""  # of the whole run: a place is that of the extreme value
        name, meaning = figure["name"], figure["definition"]
        if name.startswith(("highest_mean_power_", "highest_rms_current_")):
            name = re.sub(f"_({labels})_", "_W_", name)
            meaning = re.sub(r"over \d+ \w+", "over W", meaning)
        rows[kind][name] = f"| `{name}` | {figure['unit']} | {meaning.replace('|', chr(92) + '|')} |"
    for kind, own in rows.items():
        title = {"": "whole run", "feeder": "feeder, switch (without `trips`)"}.get(kind, kind)
        yield "\n".join([f"| {title} | unit | definition |", "|---|---|---|", *own.values(), ""])


def _table(model: type[BaseModel]) -> str:
    rows = ["| key | unit | allowed | default | meaning |", "|---|---|---|---|---|"]
    for name, info in model.model_fields.items():
        extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
        source = f" (default: {extra['source']})" if extra.get("source") else ""
        meaning = (info.description or "") + source
        cells = (f"`{info.alias or name}`", extra.get("unit", ""), _allowed(info), _default(info), meaning)
        rows.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(rows) + "\n"


def _allowed(info: FieldInfo) -> str:
    bounds = []
    for item in info.metadata:
        for attribute, sign in (("gt", ">"), ("ge", "≥"), ("lt", "<"), ("le", "≤")):
            if getattr(item, attribute, None) is not None:
                bounds.append(f"{sign} {getattr(item, attribute):g}")
    literals = [kind for kind in _kinds(info.annotation) if get_origin(kind) is typing.Literal]
    if bool in _kinds(info.annotation):
        return "true, false"
    return ", ".join(bounds) or ", ".join(str(choice) for kind in literals for choice in get_args(kind))


def _default(info: FieldInfo) -> str:
    if info.default is PydanticUndefined:
        return "required" if info.default_factory is None else ""
    if isinstance(info.default, bool):
        return str(info.default).lower()
    if info.default is None or info.default == () or isinstance(info.default, BaseModel):
        return ""
    return str(info.default)


def _kinds(annotation: Any) -> Iterator[Any]:
    yield annotation
    if get_origin(annotation) in {typing.Union, types.UnionType, tuple, typing.Annotated}:
        for inner in get_args(annotation):
            yield from _kinds(inner)


def _parts(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    for name, info in model.model_fields.items():
        for kind in _kinds(info.annotation):
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                path = f"{prefix}{info.alias or name}"
                yield path + _which(kind), kind
                yield from _parts(kind, path + ".")


def _which(model: type[BaseModel]) -> str:
    # One of several declarations is told by its only kind.
    kind = model.model_fields.get("kind")
    choices = get_args(kind.annotation) if kind is not None else ()
    return f" (kind: {choices[0]})" if len(choices) == 1 else ""


def main() -> None:
    """Write all pages."""
    (HERE / "inputs.md").write_text(inputs_page(), encoding="utf-8")
    (HERE / "results.md").write_text(results_page(), encoding="utf-8")
    (HERE / "conductors.md").write_text(conductors_page(), encoding="utf-8")
    (HERE / "ratings.md").write_text(ratings_page(), encoding="utf-8")


if __name__ == "__main__":
    main()

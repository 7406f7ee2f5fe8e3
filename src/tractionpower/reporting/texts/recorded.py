"""Sentences that a run records in English, with places for names and numbers, so that reports can tell them in any language.

What lower floors declare as constants is gathered by code (`tractionpower.reporting.texts.sources`); here stand names, sentences
and messages that they put together. A place takes any text, which is looked up in its turn.
"""

from __future__ import annotations

from tractionpower.reporting.texts.recorded_dynamics import OF_DYNAMICS
from tractionpower.reporting.texts.recorded_studies import OF_STUDIES

FIGURES = (
    "auxiliary energy", "breaker share", "drive loss", "energy", "energy fed back", "energy returned", "energy taken",
    "feeder heat", "highest clock 15 min power", "highest current", "highest demand", "highest mean power {window}",
    "highest pantograph voltage", "highest power", "highest rms current {window}", "highest speed", "highest voltage",
    "journey time", "late at end", "late trains", "least reserve left", "length", "load energy",
    "longest spell above {limit}", "longest spell below {limit}", "longest spell without voltage", "lost to low voltage",
    "lowest 10 s mean voltage", "lowest busbar voltage", "lowest pantograph voltage", "lowest voltage",
    "lowest useful voltage {kind} current weighted {window}", "lowest useful voltage {kind} time mean {window}",
    "mean busbar voltage", "mean current", "mean pantograph voltage", "mean speed", "mean useful voltage current weighted",
    "mean useful voltage time mean", "plant heat", "plant regulation", "rail potential", "refused energy", "rms current",
    "running time", "starting resistor energy", "time closed", "time of useful steps", "trips", "useful charge",
    "useful current", "useful energy", "useful power", "utilisation", "voltage of useful steps vs", "voltage of useful steps",
)  # fmt: skip
"""Names of key figures in words."""

HEADINGS = ("area [mm²]", "level [%]", "resistance [Ω]", "resistance [Ω/km]", "every [km]", "highest [°C]", "temperature [°C]")
"""Headings whose words mean something else with another unit."""

SHEETS = ("Differences {count}",)
"""Sheets of which there may be several."""

DEFINITIONS = (
    "at the start of a step",
    "auxiliaries and heating",
    "between pantograph and wheel, without resistors",
    "computed less planned time at the last timed call reached; if another is overdue, the time since it",
    "dissipative resistance times the square of the current, sum over the steps; a part of the regulation",
    "distance run over the running time",
    "distance run, since the start of the clock and its warm-up",
    "fed back into the line",
    "from start to end, stops included; what lies before the clock or in its warm-up is left out",
    "from start to end, without the time at stops; what lies before the clock or in its warm-up is left out",
    "heat in starting resistors",
    "highest mean of a quarter of an hour by the clock, from the grid",
    "highest mean of a step",
    "highest mean of a step at the pantograph",
    "highest mean of a step between contact line and rail, at trains, loads and cross-sections",
    "highest mean of a step, U I",
    "highest mean of a step, in either direction",
    "highest mean over a quarter of an hour by the clock, U I",
    "highest of all feeders: highest mean of a step, of the setting of the breaker",
    "highest of all {kind}: RMS current over {window}, of what the rating permits",
    "highest sliding mean over {window}, U I; time is the start of the window",
    "highest sliding root mean square over {window}; time is the start of the window",
    "how often its breaker trips",
    "least time by which a train could come earlier than planned, flat out on the recorded voltages",
    "longest time of a train {what}, without a break",
    "longest time of a train {what}, without a break, 0.1 V tolerance",
    "longest unbroken time with a rail potential of either sign above the touch voltage of that name, {volts} V",
    "lowest mean of a step",
    "lowest mean of a step at the pantograph",
    "lowest mean of a step between contact line and rail, at trains, loads and cross-sections",
    "lowest mean useful voltage of a {kind}, {definition}, of a given part of the day",
    "lowest mean useful voltage of a {kind}, {definition}, of an hour by the clock",
    "lowest mean useful voltage of a {kind}, {definition}, of the run",
    "lowest sliding mean over 10 s",
    "magnitude of the rail potential, greatest of all cases",
    "mean of all steps with a voltage, at the pantograph",
    "mean of the steps with a voltage",
    "mean over the run",
    "mean useful voltage, current-weighted: sum U |I| dt / sum |I| dt",
    "mean useful voltage, current-weighted: sum U |I| dt / sum |I| dt, every train divided by its time in the zone",
    "mean useful voltage, time mean: over all trains and steps",
    "mean useful voltage, time mean: over steps with traction effort",
    "of all trains, against themselves at nominal voltage; where they gain left out",
    "of the electric brake that the line did not take",
    "resistance times the square of the current, sum over the steps",
    "root of the mean square over the run",
    "share of the steps in which it is closed",
    "sum U dt over all trains and steps; over time_of_useful_steps_s: the mean useful voltage, time mean",
    "sum U dt over steps with traction effort; over time_of_useful_steps_s: the mean useful voltage, time mean",
    "sum U |I| dt; over useful_charge_ah: the mean useful voltage, current-weighted",
    "sum of (E - U) I over the steps",
    "sum of -U I over the steps in which the busbar feeds back",
    "sum of U I over the steps",
    "sum over trains of their mean U |I| in the zone; over useful_current_a: the mean useful voltage",
    "sum over trains of their mean |I| in the zone",
    "sum |I| dt",
    "taken from the line",
    "time of all trains and steps",
    "time of steps with traction effort",
    "trains later than the tolerance at a timed call, or not there",
    "{verdict}, worst of all cases",
    "above U_max1",
    "above U_max2",
    "below U_min2",
    "without voltage",
)
"""Definitions of key figures."""

VERDICTS = (
    "lowest voltage",
    "highest voltage",
    "longest spell above U_max1",
    "longest spell of the rail potential above {volts} V",
    "mean useful voltage of trains, current-weighted",
    "mean useful voltage of trains, time mean",
    "mean useful voltage of zones, current-weighted",
    "mean useful voltage of zones, time mean",
    "mean useful voltage of zones, {definition} (of trains there for {seconds} s or more)",
    "current-weighted, worst hour",
    "current-weighted, worst given part of the day",
    "time mean, worst hour",
    "time mean, worst given part of the day",
    "mean stray current",
    "mean rail potential, leakage up to {leakage} S/km",
    "leakage conductance",
    "utilisation of {kind}",
    "utilisation of devices",
    "peak of feeders, of the setting of the breaker",
    "highest demand of a quarter of an hour",
    "lateness at calls",
    "trips of breakers",
    "trains that stand for good",
    "trains without a voltage for longer than they coast",
    "trains that do not end their run though they do in the base case",
    "loads without a voltage while they should take something",
    "time in which nothing at all is fed",
    "study",
    "contract of the inputs",
    "contracts of the inputs",
    "settings of the inputs",
)
"""Names of verdicts, and sources of limits that a study sets itself."""

FAILURES = (
    "low voltage", "high voltage", "useful voltage", "overload", "contract", "breaker", "late trains", "tripped breakers",
    "stuck trains", "trains without voltage", "unfinished trains", "loads without voltage", "nothing fed",
)  # fmt: skip
"""What a case violates, in a word."""

PLACES = (
    "train {train}",
    "train {train}, track {track}, km {km}",
    "train {train}, from track {track}, km {km}",
    "train {train}, {section}",
    "track {track}, km {km}",
    "track {track}, km {begin} to {end}",
    "track {track} km {begin}-{end}",
    "rails {tracks} km {begin}-{end}",
    "tracks {tracks}, km {km}",
    "load {load}",
    "load {load}, track {track}, km {km}",
    "substation {substation}",
    "section cabin {cabin}",
    "feeder {feeder}",
    "switch {switch}",
    "zone {zone}",
    "supply point {point}",
    "earthing {device}",
    "voltage-limiting device {device}",
    "{device}, whole run",
    "{case}, grid low",
    "{case}, grid high",
    "{case}: km {km}",
    "{case}: track {track}, km {km}",
)
"""Where something was found."""

EVENTS = (
    "{begin} to {end}: the demand cannot be served, first at {subject} (track {track}, km {km}); {share} % of all demand can be,"
    " and is computed",
    "{begin} to {end}: a node balances within {value} A only; the best solution found is given",
    "{begin} to {end}: rectifiers block, the busbar is at up to {value} V, above {limit} V without load",
    "{begin} to {end}: down to {value} V, below {limit} V",
    "{begin} to {end}: up to {value} V, above {limit} V",
    "{begin} to {end}: tractive effort limited by {reasons}, down to {value} V",
    "{begin} to {end}: auxiliaries limited by {reasons}, down to {value} V",
    "the contact line is dead: neither traction nor auxiliaries",
    "comes to a stand on track {track}, km {km}: the contact line is dead, {seconds} s after the voltage was lost",
    "the contact line has voltage again, after {seconds} s",
    "{before} motors in series become {after}",
    "comes onto the line",
    "leaves the line",
    "stops at {station}",
    "departs from {station}",
    "{what}: {value} {unit} at {place}, may last {limit} s ({name}: {volts} V)",
    "{what}: {value} {unit}, may last {limit} s ({name}: {volts} V)",
    "{what}: {value} {unit} at {place}, {name} is {limit} {limit_unit}",
    "{what}: {value} {unit}, {name} is {limit} {limit_unit}",
    "{count} rectifier units in service from now on",
    "feeds nothing: none of its return feeders is closed",
    "{state}, by itself after a trip",
    "{state}, by itself",
    "trips at {value} A, above {limit} A; stays open",
    "trips at {value} A, above {limit} A; stays open, since it has closed by itself as often as it may",
    "trips at {value} A, above {limit} A; closes by itself after {seconds} s (number {number})",
    "closes: the rail potential is {value} V, above {limit} V",
    "nothing feeds the contact line from km {begin} to km {end}",
    "the contact line is fed again from km {begin} to km {end}, after {seconds} s",
)
"""Messages of events."""

NOTES = (
    "trains take the currents of a constant voltage: the voltages that these cause do not limit them",
    "without voltage for up to {seconds} s: {trains}",
    "on a dead contact line at the end: {trains}",
    "stuck, since effort or power lack: {trains}",
    "trains {trains}",
    "trains do not see each other; these overlap: {pairs}",
    "trains do not see each other; these overlap: {pairs} and {count} more pairs",
    "{one} and {other} ({time}, track {track}, km {km}, {count} steps)",
    "windows longer than what counts of the run, {seconds} s, are held against the whole of it: {windows}",
    "without a rating, not judged: {devices}",
    "held against recalled values, which the user may replace: {kinds}",
    "{count} steps did not converge or could not be served",
    "the electric ledger does not close",
    "same inputs as case {case}",
    "{reason}; same inputs as case {case}",
    "no row of these trains is in the part: {trains}",
    "figures of the part rest on rows every {seconds} s, which stand for the steps between them",
    "the part lies in the warm-up, which does not count: it has no key figures",
    "lowest mean of a step between contact line and rail, at trains and loads of the part",
    "highest mean of a step between contact line and rail, at trains and loads of the part",
)
"""Notes of a run, of ratings and of cases."""

TOGETHER = ("{first}; {second}", "{first}: {second}", "{first}, {second}", "{first} + {second}", "{first} and {second}")
"""How parts stand together that are looked up one by one; in the order in which a text is parted."""

SENTENCES: tuple[str, ...] = (
    *FIGURES, *HEADINGS, *SHEETS, *DEFINITIONS, *VERDICTS, *FAILURES, *PLACES, *EVENTS, *NOTES, *OF_STUDIES, *OF_DYNAMICS,
    *TOGETHER,
)  # fmt: skip
"""All of them, those of studies included."""

"""Sentences that studies of timetables, ratings, outages and variants record in English, with places for names and numbers."""

from __future__ import annotations

DEVICES = tuple(
    f"{{count}} {words}"
    for words in (
        "rectifier unit", "rectifier units", "substation", "substations", "feeder", "feeders", "return feeder", "return feeders",
        "feeder of section cabins", "feeders of section cabins", "switch", "switches", "section of contact line",
        "sections of contact line", "section of rails", "sections of rails",
    )
)  # fmt: skip
"""So many devices of a kind."""

RATINGS = (
    "no rating given",
    "no unit is in service",
    "no rating given: neither rated_current_a nor unit",
    "no rating given; the conductors table has none for cable {cable}",
    "no rating given; its wires are not known",
    "no rating given; diameter_mm or highest_c of wire {wire} is not known",
    "no rating given; the limits table lacks the weather of wires",
    "no rating: the limits table lacks {name}",
    "rated_current_a of substation {substation}",
    "unit {unit}: {source}",
    "{units} x {current} A, {in_service} of {all} units in service; {source}",
    "no duty class: taken to bear no overload",
    "class {name}: {source}",
    "rated_current_a of feeder {feeder}",
    "{count} x {current} A, cable {cable}: {source}",
    "feeder_rated_current_a of {station}",
    "return_rated_current_a of {station}",
    "rated_current_a of the contact line",
    "heat balance of its wires, {wire} at its highest temperature; air {air} °C, wind {wind} m/s, sun {sun} W/m²",
    "heat balance of its wires, {wire} at its highest temperature; air {air} °C, wind {wind} m/s, sun {sun} W/m²: it may carry"
    " nothing",
    "rated_current_a of the return circuit",
    "{tracks} x {current} A, rail {rail}: {source}",
    "whole run",
    "below U_min2",
    "U_min2 to U_min1",
    "U_min1 to U_n",
    "U_n to U_max1",
    "U_max1 to U_max2",
    "above U_max2",
)
"""Where ratings come from, and bands of voltages."""

TIMETABLE = (
    "has no call with a planned time: no verdict on delays; {running}",
    "nothing of its run lies within the time that counts",
    "on time",
    "on time, with {seconds} s of reserve left at {station}",
    "on time; the clock ends before its planned time at {station}",
    "on time, with {seconds} s of reserve left at {station}; the clock ends before its planned time at {next}",
    "late {seconds} s at {station}",
    "late {seconds} s at {station}: {parts}",
    "{seconds} s to train current limits",
    "{seconds} s to driving that is not flat out",
    "{seconds} s at stops and turn-rounds",
    "{seconds} s to a timetable that gives too little time",
    "{seconds} s lost to low voltage",
    "{seconds} s lost to low voltage between km {begin} and {end}",
    "{seconds} s lost to low voltage between km {begin} and {end} (area {area})",
    "{seconds} s lost to low voltage (area {area})",
    "{seconds} s lost to low voltage (area {area}; of {all} s lost there its reserve takes up the rest)",
    "{seconds} s lost to low voltage between km {begin} and {end} (area {area}; of {all} s lost there its reserve takes up the"
    " rest)",
    "stuck on track {track} at km {km}, since effort or power lack",
    "does not enter",
    "on track {track} at km {km} when the clock ends",
    "{where}: not at {station}, planned {time}, {seconds} s before the end of the run",
    "alone at nominal voltage it runs {seconds} s, low voltage costs it nothing",
    "alone at nominal voltage it runs {seconds} s, low voltage costs it {lost} s",
    "alone at nominal voltage it runs {seconds} s, higher voltage saves it {saved} s",
)
"""Why a timetable holds for a train, or does not."""

REMEDIES = (
    "Train {train} runs {seconds} s later, all its planned times with it.",
    "Train {train} runs {seconds} s earlier, all its planned times with it.",
    "Train {train} runs {seconds} s later, all its planned times with it; so do {others}.",
    "Train {train} runs {seconds} s earlier, all its planned times with it; so do {others}.",
    "Service {service} runs {seconds} s later, all its planned times with it.",
    "Service {service} runs {seconds} s earlier, all its planned times with it.",
    "{who}: current capped to {value} A, {percent} % below the greatest in the run.",
    "{who}: current capped, {percent} % below the greatest in the run.",
    "{who}: power capped to {value} kW, {percent} % below the greatest in the run.",
    "{who}: power capped, {percent} % below the greatest in the run.",
    "Train {train}",
    "Service {service}",
    "Trains of type {type}",
    "Category {category}",
    "service {service}",
    "trains of type {type}",
    "category {category}",
    "late trains",
    "Service {service}: a run every {seconds} s, {runs} in place of {before}.",
    "{train} is planned up to {seconds} s later, where the time is lost.",
    "{trains} are planned up to {seconds} s later, where the time is lost.",
    "Train {train} is driven with {percent} % of reserve.",
    "Service {service} is driven with {percent} % of reserve.",
    "The timetable holds as it is; nothing was searched.",
    "The search was ended by {reason}.",
    "The search was ended by {reason}; what it had found by then is told.",
    "its wall time, {seconds} s",
    "Ctrl-C",
    "What saves the part of the clock around the late trains does not save the whole: searched again.",
    "Late even alone at nominal voltage, since the timetable gives less than running, dwells and turn-rounds need: {trains}. No"
    " change of supply or of other trains helps them; only later planned times were searched.",
    "Not tried, since they are not running when all of the late trains are: {names}.",
    "Not tried, beyond most_runs of {count}: {names}.",
    "Smallest means cheapest. Points by the study's bounds of the search: {shift} for each second and train of a departure shift,"
    " {reserve} for each second and train of later planned times, {current} for each percent and train of a cap on current and"
    " {power} on power, {headway} for each second and run of a larger headway, {driving} for each percent and train of a driving"
    " plan with reserve.",
    "no load voltage",
    "internal resistance",
    "in service",
    "{count} units in place of {before}",
    "{state} to in_service",
    "{state} to closed",
)
"""Changes that make a timetable feasible, and notes of the search for them."""

SIZING = (
    "all limits are kept with less",
    "{count} rectifier unit",
    "units of {substation}",
    "cables of {feeder}",
    "contact line {number} of track {track}",
    "contact line {number} of tracks {tracks}",
    "{device} at {percent} % of its rating, {allowed} % are allowed",
    "the run is {status}: {reason}",
    "{what} {value} {unit} ({place}) against {limit} {limit_unit}",
)
"""What the search for the least equipment tells."""

OUTAGES = (
    "{contained} pairs: one outage contains the other",
    "{contrary} pairs: they move a device to different states, or one opens what the other bypasses",
    "{grid} grid voltage: left out, for the limits table has no row {name}",
    "{grid} grid voltage: left out, for it is the normal one",
    "{name}: none is in service",
    "{name}: its reserve feeds at once, so nothing changes",
    "{name}: it is open already",
    "{name}: nothing feeds it",
    "{name}: it is {state} already",
    "{count} of {all} in service",
    "{count} of {all} in service, reserve after {seconds} s",
    "{count} of {all} units",
    "{count} of {all} units in service",
    "{count} of {all} units in service, reserve after {seconds} s",
    "{name}: out from {time}, when its units carry most over {lasts} with nothing out, by the root mean square; its reserve feeds"
    " {again} later",
    "{name}: out from {time}, as contingency.begins says; its reserve feeds {again} later",
)
"""Notes of a study of outages, and how its outages are called."""

COMPARE = (
    "{folder}: the run is {status}",
    "of unknown status",
    "{folder} is of another study, {study} and not {base}",
    "only one of {base} and {folder} holds many cases: their figures differ in kind",
    "{folder}: which inputs differ is not known, they are not kept with the results",
    "{folder}: no input differs from {base}",
    "{folder} was computed by version {version} of tractionpower, {base} by {base_version}",
)
"""Notes of a comparison."""

OF_STUDIES: tuple[str, ...] = (*DEVICES, *RATINGS, *TIMETABLE, *REMEDIES, *SIZING, *OUTAGES, *COMPARE)
"""All of them."""

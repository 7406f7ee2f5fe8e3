"""Measure how fast tractionpower is, part by part, also beside general programs. Entry of ``make bench``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable

import day
import dynamics
import line
import many
import peers
import report
import reports
import solver
import startup
import timetable
import train


def _solver(quick: bool) -> str:
    steps, rounds = (300, 5) if quick else (1200, 25)
    return solver.describe(solver.measure(steps, rounds), steps)


def _train(quick: bool) -> str:
    return train.describe(train.measure(9 if quick else 45))


def _day(quick: bool) -> str:
    return day.describe(day.measure(1 if quick else 5))


def _line(quick: bool) -> str:
    return line.describe(line.measure(1 if quick else 5))


def _timetable(quick: bool) -> str:
    return timetable.describe(timetable.measure(1 if quick else 3))


def _many(quick: bool) -> str:
    return many.describe(many.measure_all(quick))


def _reports(quick: bool) -> str:
    return reports.describe(reports.measure(1 if quick else 3))


def _dynamics(quick: bool) -> str:
    return dynamics.describe(dynamics.measure(*((1, 120.0) if quick else (5, 300.0))))


def _peers(quick: bool) -> str:
    return peers.describe(peers.compare(*((30, 3) if quick else (60, 11))))


def _startup(quick: bool) -> str:
    return startup.describe(startup.measure(3 if quick else 9))


PARTS: dict[str, Callable[[bool], str]] = {
    "solver": _solver,
    "train": _train,
    "day": _day,
    "line": _line,
    "timetable": _timetable,
    "many": _many,
    "reports": _reports,
    "dynamics": _dynamics,
    "peers": _peers,
    "startup": _startup,
}


def main() -> int:
    """Run the parts asked for and print markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"what to measure: {', '.join(PARTS)}; default: all")
    parser.add_argument("--quick", action="store_true", help="fewer repeats: a look, not a measurement")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/performance.md, too")
    given = parser.parse_args()
    unknown = sorted(set(given.parts) - set(PARTS))
    if unknown:
        parser.error(f"unknown part {unknown[0]}; there are {', '.join(PARTS)}")
    if given.write and given.parts:
        parser.error("--write needs all parts, so that the page is of one run")
    texts = [report.machine()]
    print(texts[0], flush=True)
    for name, part in PARTS.items():
        if not given.parts or name in given.parts:
            texts.append(part(given.quick))
            print("\n" + texts[-1], flush=True)
    if given.write:
        report.write_page("\n\n".join(texts))
        print(f"\nwritten to docs/{report.PAGE.name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Checks of where contact lines and return conductors lie."""

from __future__ import annotations

from tractionpower.alignment.checks import check_overlaps, check_rows
from tractionpower.alignment.intervals import find_gaps, group, patch, subtract
from tractionpower.errors import Problem
from tractionpower.supply.site import Site


def check_conductor_rows(site: Site) -> list[Problem]:
    """Return rows of conductors that lie off their tracks or over each other, and stretches that lack one."""
    problems = []
    for name in ("contact_lines", "return_circuit"):
        rows = getattr(site.supply, name)
        problems += check_rows(f"supply.{name}", rows, site.axes) + check_overlaps(f"supply.{name}", rows, site.axes)
    return problems + _check_gaps(site) + _check_returns(site)


def _check_gaps(site: Site) -> list[Problem]:
    """Return a warning for each gap on a track that has a contact line elsewhere; a track may have none at all."""
    wired = {track: parts for track, parts in site.contact.items() if parts}
    remedy = "a train or load there has no supply; add a row if the line is wired there"
    return [
        Problem("gap", "supply.contact_lines", f"no contact line on {gap}", remedy=remedy, severity="warning")
        for gap in find_gaps(wired, site.axes)
    ]


def _check_returns(site: Site) -> list[Problem]:
    bare = []
    for track, parts in site.contact.items():
        rails = [(part.start_m, part.end_m) for part in site.returns[track]]
        for part in parts:
            bare += [patch(site.axes[track], gap, (part.row,)) for gap in subtract([(part.start_m, part.end_m)], rails)]
    remedy = "add a row to return_circuit; zero resistance is allowed"
    return [
        Problem(
            "no_return_circuit",
            f"supply.contact_lines[{item.rows[0]}]",
            f"the contact line has no return circuit on {item}",
            remedy=remedy,
        )
        for item in group(bare)
    ]

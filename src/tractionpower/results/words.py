"""What a requirement comes to, as columns ``met`` of the tables say it."""

from __future__ import annotations


def yes_or_no(is_met: bool | None) -> str:
    """Return "yes" or "no"; nothing where nothing is required.

    >>> yes_or_no(True), yes_or_no(False), yes_or_no(None)
    ('yes', 'no', '')
    """
    return "" if is_met is None else "yes" if is_met else "no"

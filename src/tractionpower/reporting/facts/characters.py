"""Characters of names that reports do not show as they are."""

from __future__ import annotations

import re

TURNS = "\u202a-\u202e\u2066-\u2069"
"""Characters that turn round the texts behind them, so that they read as others than they are: a range of a pattern.

Unicode Technical Report 36, "Bidirectional text spoofing".
"""

_TURNS = re.compile(f"[{TURNS}]")


def unturned(text: str) -> str:
    """Return a text with a mark in the place of each character that would turn it round.

    >>> unturned("IC \u202e1")
    'IC \ufffd1'
    """
    return _TURNS.sub("\ufffd", text)

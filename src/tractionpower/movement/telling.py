"""How the checks of this room tell what they found."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Sequence

from tractionpower.errors import Problem
from tractionpower.io.wording import did_you_mean, shown

SHOWN = 8
"""Names of a list that a message shows."""


def doubt(code: str, path: str, found: str, allowed: str = "", remedy: str = "") -> Problem:
    """Return a warning."""
    return Problem(code, path, found, allowed, remedy, "warning")


def unknown(kind: str, path: str, name: str, known: Collection[str], remedy: str) -> Problem:
    """Return that a name of a `kind` of things is not among the `known` ones."""
    allowed = listed(sorted(known)) or f"there is no {kind}"
    return Problem(f"unknown_{kind}", path, shown(name), allowed, did_you_mean(name, known) or remedy)


def listed(names: Iterable[str], shown_names: int = SHOWN) -> str:
    """Return names as text, the first ones of many.

    >>> listed("abc", 2)
    'a, b, ... (3 in all)'
    """
    texts = list(names)
    return ", ".join(texts[:shown_names] + ([f"... ({len(texts)} in all)"] if len(texts) > shown_names else []))


def item_paths(root: str, ids: Sequence[str]) -> list[str]:
    """Return the model path of each item of a list: by its id, or by its index where others have the same id.

    >>> item_paths("trains", ["a", "b", "b"])
    ['trains[a]', 'trains[1]', 'trains[2]']
    """
    counts = Counter(ids)
    return [f"{root}[{name if counts[name] == 1 or str(k) in counts else k}]" for k, name in enumerate(ids)]

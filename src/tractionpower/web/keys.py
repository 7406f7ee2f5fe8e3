"""The keys of the driving page: which key sets which control to which level (Zobory and Bekefi, figure 13).

A key is known by its place on the keyboard, named as on a US keyboard (``KeyboardEvent.code``), not by the letter printed on
it: the rows of the paper stay rows on QWERTZ and AZERTY keyboards. The page reads the map from here.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Any

_BRAKE_ROWS = (("Digit", "1234567890", (*range(1, 10), 0)), ("Key", "QWERTY", tuple(range(10, 16))))
_DRIVE_ROWS = (("Key", "ASDFGHJKL", tuple(range(1, 10))), ("Key", "ZXCVBNM", (*range(10, 16), 0)))

LEVEL_KEYS = MappingProxyType(
    {
        f"{kind}{letter}": (control, level)
        for control, rows in (("brake", _BRAKE_ROWS), ("drive", _DRIVE_ROWS))
        for kind, letters, levels in rows
        for letter, level in zip(letters, levels, strict=True)
    }
)
"""Control and level of each of the 32 keys of the paper."""

STEP_KEYS = MappingProxyType(
    {
        "ArrowUp": ("drive", 1),
        "ArrowDown": ("drive", -1),
        "ArrowRight": ("brake", 1),
        "ArrowLeft": ("brake", -1),
        "KeyI": ("electric", 1),
        "KeyU": ("electric", -1),
    }
)
"""Keys that move a control by a level; they repeat while they are held down."""

ACTION_KEYS = MappingProxyType({"Space": "emergency", "KeyP": "pause", "Enter": "start", "Comma": "slower", "Period": "faster"})
"""Keys of everything else."""


def key_map() -> dict[str, Any]:
    """Return all keys as the page reads them: what is sent for each, and the rows in which they are shown.

    >>> key_map()["keys"]["KeyT"]
    {'set': 'brake', 'level': 14}
    """
    keys: dict[str, dict[str, Any]] = {code: {"set": control, "level": level} for code, (control, level) in LEVEL_KEYS.items()}
    keys |= {code: {"step": control, "by": by} for code, (control, by) in STEP_KEYS.items()}
    keys |= {code: {"do": action} for code, action in ACTION_KEYS.items()}
    rows = [
        {"control": control, "codes": [f"{kind}{letter}" for letter in letters]}
        for control, of_control in (("brake", _BRAKE_ROWS), ("drive", _DRIVE_ROWS))
        for kind, letters, _ in of_control
    ]
    return {"keys": keys, "rows": rows}

"""Identifiers as file names: any text becomes a name that every system can keep, and a name is read back as a text.

What an identifier may hold and a file name may not (slashes, colons, letters beyond ASCII, ...) is written as ``%`` and
the two hexadecimal digits of each of its bytes in UTF-8, as in web addresses. Names that people write need none of this
where their own system keeps them: ``kraków.yaml`` stands for the identifier kraków as ``krak%C3%B3w.yaml`` does.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable
from urllib.parse import quote, unquote

ENDING = ".yaml"
LONGEST = 100
"""Characters of a name without its ending: with a folder before it, that is what every system takes."""

_SAFE = " ()+,=@"  # beside letters, digits and _.-~
_RESERVED = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\..*)?", re.IGNORECASE)  # devices on Windows, with any ending


def file_names(identifiers: Iterable[str]) -> dict[str, str]:
    """Return a file name for each identifier; no two of them are the same on any system.

    >>> file_names(["ep09", "a/b", "nul"])
    {'ep09': 'ep09.yaml', 'a/b': 'a%2Fb.yaml', 'nul': '%6Eul.yaml'}
    """
    stems = {identifier: _stem(identifier) for identifier in identifiers}
    uses = Counter(stem.lower() for stem in stems.values())
    # Where names differ by case only, capitals are written as bytes: some systems take both names for one.
    return {
        identifier: (_short(stem) if uses[stem.lower()] == 1 else _short(_without_capitals(identifier))) + ENDING
        for identifier, stem in stems.items()
    }


def identifier_of(name: str) -> str:
    """Return the identifier that a file name stands for.

    >>> identifier_of("a%2Fb.yaml")
    'a/b'
    """
    return unquote(name.removesuffix(ENDING))


def stands_for(name: str, identifier: str) -> bool:
    """Return whether the file `name` is that of `identifier`."""
    found = identifier_of(name)
    if len(name) > LONGEST and found != identifier:
        return name in {_short(stem) + ENDING for stem in (_stem(identifier), _without_capitals(identifier))}
    return found == identifier


def looks_like(name: str, identifier: str) -> bool:
    """Return whether a file name reads like `identifier`, though its accents are stored in another way."""
    return unicodedata.normalize("NFC", identifier_of(name)) == unicodedata.normalize("NFC", identifier)


def _stem(identifier: str) -> str:
    stem = quote(identifier, safe=_SAFE)
    return f"%{ord(stem[0]):02X}{stem[1:]}" if _RESERVED.fullmatch(stem) or stem.startswith(".") else stem


def _without_capitals(identifier: str) -> str:
    parts = re.split(r"(%[0-9A-F]{2})", _stem(identifier))
    return "".join(part if part.startswith("%") else re.sub("[A-Z]", lambda m: f"%{ord(m[0]):02X}", part) for part in parts)


def _short(stem: str) -> str:
    if len(stem) <= LONGEST:
        return stem
    digest = hashlib.sha256(stem.encode()).hexdigest()[:16]
    return f"{stem[: LONGEST - 17]}~{digest}"

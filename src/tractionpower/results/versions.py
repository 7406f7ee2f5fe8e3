"""Versions of what computed a result, for ``run.json``."""

from __future__ import annotations

from importlib import metadata

NAMES = ("tractionpower", "numba", "numpy", "pyarrow", "pydantic")


def versions() -> dict[str, str]:
    """Return the versions of this package and of what its numbers hang on."""
    found = {}
    for name in NAMES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:  # run from a source folder
            found[name] = "not installed"
    return found

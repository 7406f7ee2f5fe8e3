"""The only door to numba: one set of flags, one cache folder that notices every change of a kernel.

numba's own cache looks at the file of the *calling* function only and returns stale machine code when a called
function in another file has changed. The cache folder is therefore named by everything that the code depends on.
"""

from __future__ import annotations

import hashlib
import logging
import os
import tempfile
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
import numpy as np
from platformdirs import user_cache_path

log = logging.getLogger(__name__)


def _fingerprint() -> str:
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    digest.update(f"{numba.__version__} {llvmlite.binding.get_host_cpu_name()}".encode())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path | None:
    """Return the folder of the compiled kernels, or None when it cannot be written.

    ``TRACTIONPOWER_CACHE_DIR`` moves it away from the user's cache folder.
    """
    root = os.environ.get("TRACTIONPOWER_CACHE_DIR")
    folder = (Path(root) if root else user_cache_path("tractionpower", appauthor=False)) / f"kernels-{_fingerprint()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        log.warning("kernels are compiled anew in every run: the cache folder %s is not writable (%s)", folder, error)
        return None
    return folder


def is_compiled(kernel: str) -> bool:
    """Tell whether the outermost function `kernel` of this version lies compiled in the cache already."""
    folder = cache_folder()
    return folder is not None and any(folder.rglob(f"*.{kernel}-*.nbc"))


FLAGS = {"error_model": "numpy", "nogil": True, "_nrt": False}
"""Flags of every kernel. Kernels allocate nothing, so numba need not count references to arrays: with the counting
(`_nrt`), each array of a bundle costs two atomic operations at each call, ten times the arithmetic of a train's step."""


def njit(function: Callable[..., Any]) -> Any:
    """Compile `function` with the flags of this project; nothing that hides NaN.

    Private ones are for kernels only: without the door to Python they compile in half the time.
    """
    return _compiled(function, FLAGS | {"no_cpython_wrapper": function.__name__.startswith("_")})


def inlined(function: Callable[..., Any]) -> Any:
    """Compile `function` into its callers, which are kernels: for small functions inside the step of a train."""
    return _compiled(function, FLAGS | {"forceinline": True, "no_cpython_wrapper": True})


def _compiled(function: Callable[..., Any], flags: dict[str, Any]) -> Any:
    if numba.config.DISABLE_JIT:
        return _interpreted(function)
    folder = cache_folder()
    if folder is None:
        return numba.njit(**flags)(function)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)  # read while decorating only, so other users of numba keep their own
    try:
        return numba.njit(cache=True, **flags)(function)
    finally:
        numba.config.CACHE_DIR = before


def _interpreted(function: Callable[..., Any]) -> Any:
    """Return `function` so that it runs without numba: numpy gives the fields of a record as attributes in recarrays only."""

    @wraps(function)
    def call(*arguments: Any) -> Any:
        return function(*map(_with_attributes, arguments))

    return call


def _with_attributes(value: Any) -> Any:
    """Return record arrays, alone or in a NamedTuple, as recarrays on the same memory; all else as it is."""
    if isinstance(value, np.ndarray):
        return value.view(np.recarray) if value.dtype.type is np.void else value
    if isinstance(value, tuple) and hasattr(value, "_make"):
        return value._make(map(_with_attributes, value))
    return value

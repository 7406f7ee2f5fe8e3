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
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
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


def is_compiled() -> bool:
    """Tell whether compiled kernels of this version lie in the cache already."""
    folder = cache_folder()
    return folder is not None and any(folder.rglob("advance*.nbc"))


def njit(function: Callable[..., Any]) -> Any:
    """Compile `function` with the flags of this project; nothing that hides NaN."""
    folder = cache_folder()
    if folder is None or numba.config.DISABLE_JIT:
        return numba.njit(error_model="numpy", nogil=True)(function)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)  # read while decorating only, so other users of numba keep their own
    try:
        return numba.njit(cache=True, error_model="numpy", nogil=True)(function)
    finally:
        numba.config.CACHE_DIR = before

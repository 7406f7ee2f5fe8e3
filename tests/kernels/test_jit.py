"""The door to numba: a changed kernel is noticed, a cache folder that cannot be written is told once."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import tractionpower.kernels

KERNELS = Path(tractionpower.kernels.__file__).parent
PROBE = """
import logging
logging.basicConfig(format="%(levelname)s %(message)s")
import numpy as np
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.tables import PORT, SEGMENT
ports = np.zeros(1, PORT)
ports["segments"], ports["scale"] = 1, 1.0
print(port_current(np.array([(-np.inf, 5.0, 0.5, 0.0)], SEGMENT), ports[0], 100.0))
"""


@pytest.fixture
def copy(tmp_path):
    """Return the folder of a copy of the package that holds the kernels alone."""
    package = tmp_path / "source" / "tractionpower"
    shutil.copytree(KERNELS, package / "kernels", ignore=shutil.ignore_patterns("__pycache__"))
    (package / "__init__.py").write_text("")
    return package


def run(copy, cache, **environment):
    """Run the probe on the copy; return what it printed and what it logged."""
    environment = os.environ | {"PYTHONPATH": str(copy.parent), "TRACTIONPOWER_CACHE_DIR": str(cache)} | environment
    for name in ("NUMBA_DISABLE_JIT", "NUMBA_CACHE_DIR"):
        environment.pop(name, None)
    done = subprocess.run([sys.executable, "-c", PROBE], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return float(done.stdout), done.stderr


def test_a_change_of_a_called_kernel_changes_its_caller(copy, tmp_path):
    cache = tmp_path / "cache"
    assert run(copy, cache) == (55.0, "")
    assert any(cache.rglob("*.nbc"))
    assert run(copy, cache) == (55.0, "")
    ports = copy / "kernels" / "ports.py"
    text = ports.read_text()
    assert "    i = segment.a + segment.b * u\n" in text
    ports.write_text(text.replace("    i = segment.a + segment.b * u\n", "    i = segment.a + 2.0 * segment.b * u\n"))
    assert run(copy, cache) == (105.0, "")
    assert len(list(cache.glob("kernels-*"))) == 2


def test_a_called_kernel_in_another_file(copy, tmp_path):
    """The caller's file stays as it is; only a file that it imports from changes."""
    (copy / "kernels" / "inner.py").write_text(
        "from tractionpower.kernels.jit import njit\n\n@njit\ndef twice(x):\n    return 2.0 * x\n"
    )
    ports = copy / "kernels" / "ports.py"
    text = ports.read_text().replace("    i = segment.a + segment.b * u\n", "    i = segment.a + twice(segment.b) * u\n")
    ports.write_text(text.replace("from tractionpower.kernels.jit import njit\n", "from tractionpower.kernels.jit import njit\n"
                                  "from tractionpower.kernels.inner import twice\n"))  # fmt: skip
    assert run(copy, tmp_path)[0] == 105.0
    inner = copy / "kernels" / "inner.py"
    inner.write_text(inner.read_text().replace("2.0", "3.0"))
    assert run(copy, tmp_path)[0] == 155.0


def test_a_cache_folder_that_cannot_be_written_is_told_once(copy, tmp_path):
    """A file stands in place of the folder, so that this holds for the superuser too."""
    file = tmp_path / "file"
    file.write_text("")
    value, told = run(copy, file)
    assert value == 55.0
    assert told.count("WARNING kernels are compiled anew in every run") == 1
    assert told.count("\n") == 1
    assert str(file) in told

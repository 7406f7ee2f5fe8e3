"""What holds for all tests."""

import os
from collections import Counter

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the dense references solve small matrices: threads make them slower

LONGEST = "test_wheel.py"
"""One file that takes two minutes: begun last, it would keep one worker alone."""


def pytest_collection_modifyitems(items):
    """Put the longest file first, then files with many tests: whole files go to workers in this order."""
    counts = Counter(item.path for item in items)
    items.sort(key=lambda item: (item.path.name != LONGEST, -counts[item.path], str(item.path)))

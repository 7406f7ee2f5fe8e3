"""Versions of what computed a result."""

import importlib.metadata

import numpy as np

from tractionpower.results.versions import NAMES, versions


def test_versions_are_those_that_are_installed():
    assert list(versions()) == list(NAMES)
    assert versions()["numpy"] == np.__version__


def test_a_package_that_is_not_installed(monkeypatch):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", missing)
    assert set(versions().values()) == {"not installed"}

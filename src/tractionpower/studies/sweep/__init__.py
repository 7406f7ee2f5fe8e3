"""Sweeps: grids, lists and random samples of changes to any input by path, and what they make of the key figures."""

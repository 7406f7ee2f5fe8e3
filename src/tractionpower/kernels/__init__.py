"""Compiled calculations on arrays: no names, no files, SI units only."""

"""Comparison of results folders: key figures, verdicts and inputs side by side."""

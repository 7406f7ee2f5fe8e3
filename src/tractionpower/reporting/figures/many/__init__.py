"""Figures of studies of many cases: outages, variants, runs side by side."""

"""Runs of many: reference cases and, later, feasibility, outages, sweeps, sizing."""

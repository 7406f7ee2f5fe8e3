"""Figures of delays and of time lost to low voltage."""

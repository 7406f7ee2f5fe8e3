"""Figures of trains as point masses on a line with stations."""

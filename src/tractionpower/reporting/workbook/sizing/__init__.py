"""Sheets on ratings and mean useful voltage."""

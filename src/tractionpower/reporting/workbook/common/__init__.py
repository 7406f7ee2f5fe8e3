"""Sheets of every workbook: cover, limits, inputs, definitions."""

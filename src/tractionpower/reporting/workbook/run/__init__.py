"""The workbook of a run and its sheets."""

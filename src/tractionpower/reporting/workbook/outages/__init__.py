"""The workbook of outages."""

"""The workbook of a case of trains on a line with stations."""

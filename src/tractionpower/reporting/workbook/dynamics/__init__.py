"""The workbook of a run of train dynamics."""

"""Timetables from CSV files and Excel workbooks, as people write them."""

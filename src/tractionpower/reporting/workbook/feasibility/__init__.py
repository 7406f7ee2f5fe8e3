"""Sheets on the timetable: verdict, remedies, delays, sections, lost time."""

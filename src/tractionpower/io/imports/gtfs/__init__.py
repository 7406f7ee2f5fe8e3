"""GTFS feeds: the trips of a day as a timetable, and the line that their shapes draw."""

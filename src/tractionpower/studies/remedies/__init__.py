"""What would save a timetable: a search over cheap changes, each verified by a run; and sensitivities of the lost seconds."""

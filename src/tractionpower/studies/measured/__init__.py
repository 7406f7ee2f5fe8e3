"""A measurement held against a run: reading, shift of its clock, resampling, errors."""

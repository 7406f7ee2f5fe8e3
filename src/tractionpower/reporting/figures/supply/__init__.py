"""Figures of the supply: substations, voltages, rails, ratings."""

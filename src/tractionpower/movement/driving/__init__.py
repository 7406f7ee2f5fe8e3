"""Driving plans: what a driver does on the way, by rules or with the least energy, and when the train is late for it."""

"""Trains that move: traction, resistance, speed ceiling, theoretical journeys."""

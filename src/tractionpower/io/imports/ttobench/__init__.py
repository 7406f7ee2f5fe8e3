"""TTOBench: tracks, trains and journeys."""

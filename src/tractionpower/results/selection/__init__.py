"""A part of a run: some trains, a window of time, a range of kilometres, with key figures of its own; no new simulation."""

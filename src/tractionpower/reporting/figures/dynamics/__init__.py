"""Figures of train dynamics: controls, speeds, forces of couplings, brakes, statistics."""

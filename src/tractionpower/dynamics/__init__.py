"""The train as many vehicles: couplings, air brake, controls, statistics; and as a point mass for discrete events."""

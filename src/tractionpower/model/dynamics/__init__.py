"""What describes a train as many vehicles: couplings, brake gear, controls, the case that is run."""

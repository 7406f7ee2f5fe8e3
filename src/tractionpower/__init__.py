"""Co-simulation of electric-traction power supply and train movement."""

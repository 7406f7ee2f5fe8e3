"""What is measured of each of many cases: one run of which nothing is recorded, watched."""

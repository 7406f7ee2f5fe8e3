"""The figures: of a run, of its supply, trains and delays, of studies of many cases."""

"""Files of railtoolkit, which are those of TrainRuns, too: rolling stock and running paths."""

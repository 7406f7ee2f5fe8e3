"""Files to model and back: YAML and CSV, shipped data, and the memory of which file and line a value came from."""

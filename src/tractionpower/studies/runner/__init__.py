"""Many cases of one study, on one core, local processes or a Dask cluster: each is kept at once, and none is run twice."""

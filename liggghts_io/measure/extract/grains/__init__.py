"""Numbers and curves of the grains in the dumps of a run."""

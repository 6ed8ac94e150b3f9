"""Effects of an apparatus that is not what its drawing says."""

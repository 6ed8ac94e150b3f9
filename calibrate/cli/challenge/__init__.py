"""The commands `challenge make`, `forecast` and `score`."""

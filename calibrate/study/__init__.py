"""The study file and the measured data that belong to it."""

"""Logs of a scale: mass over time, and the numbers in it."""

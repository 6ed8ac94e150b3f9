"""Measured numbers and curves, read from the CSV files of a study."""

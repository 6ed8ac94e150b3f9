"""The same truths, simulator and number of runs for methods of calibration (README.md)."""

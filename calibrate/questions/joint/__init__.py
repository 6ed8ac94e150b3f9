"""Joint calibration: all targets of all materials at once."""

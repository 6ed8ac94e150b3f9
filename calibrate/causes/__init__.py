"""What the calibrated simulation still gets wrong, and which cause fits."""

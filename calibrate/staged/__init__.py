"""Calibration in stages, as in the paper."""

"""Calibration: study file, campaign, surrogates, stages, report and the `bulkcal` command."""

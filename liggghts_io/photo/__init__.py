"""Photographs of the bench: sizes of grains, angle of repose."""

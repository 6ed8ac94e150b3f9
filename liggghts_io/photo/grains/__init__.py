"""Grains on a photograph from above: sizes and circularity."""

"""Observables from dumps, images and tables."""

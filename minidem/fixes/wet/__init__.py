"""Liquid on the surface of particles, as liquid bridges need it."""

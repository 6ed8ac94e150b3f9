"""Neighbour lists of particles and walls."""

"""Meshes that a controller moves until the particles push as they should."""

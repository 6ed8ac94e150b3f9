"""Experiments that a user describes in a folder: a definition, a script, meshes."""

"""Restart files: minidem's own, and the binary ones of LIGGGHTS."""

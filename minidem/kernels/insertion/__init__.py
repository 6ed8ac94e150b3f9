"""Random positions of inserted particles, to the last bit those of LIGGGHTS."""

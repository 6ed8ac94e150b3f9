"""Probability of the parameters of a stage: on a grid, or drawn."""

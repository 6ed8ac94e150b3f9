"""Runs around one point and the surrogate that holds there."""

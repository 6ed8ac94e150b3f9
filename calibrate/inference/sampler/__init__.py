"""Samplers: from a problem to weighted draws of its posterior and the evidence."""

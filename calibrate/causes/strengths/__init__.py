"""Strengths of causes: what is believed of them, and what the data say at a draw of all else."""

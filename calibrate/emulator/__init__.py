"""Emulators: runs of one experiment in, predictions of its outputs with their errors out."""

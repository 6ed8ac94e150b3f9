"""Surrogates of a stage: smt's Kriging with honest error bars, as an emulator."""

"""The command `diagnose`, and what if something had been measured."""

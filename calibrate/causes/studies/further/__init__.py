"""What to try next: further experiments, whose results the engine tells for each answer."""

"""Arrays to the text that LIGGGHTS writes; the engine owns when and where."""

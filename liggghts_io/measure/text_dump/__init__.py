"""Text dumps: split into frames, their heads, their rows as tables of numbers."""

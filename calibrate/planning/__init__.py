"""Which runs to make: where to begin, what to add, when to stop. Knows arrays only."""

"""Many time steps in one call, with one thread or several."""

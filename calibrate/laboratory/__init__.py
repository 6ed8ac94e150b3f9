"""From a scale, a sensor and a notebook to what a study reads."""

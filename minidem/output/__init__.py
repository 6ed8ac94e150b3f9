"""What the engine writes: dumps, log, screen."""

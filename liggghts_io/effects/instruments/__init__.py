"""Effects of instruments that show something else than happened: they cost no run."""

"""Effects of grains and contacts."""

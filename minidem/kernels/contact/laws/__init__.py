"""Models of single contacts that have no loop of their own."""

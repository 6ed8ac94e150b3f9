"""A blind suite: studies whose hidden causes nobody knows, forecasts of them, and their score."""

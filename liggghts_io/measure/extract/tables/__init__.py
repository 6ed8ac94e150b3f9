"""Numbers and curves of the tables that a run prints."""

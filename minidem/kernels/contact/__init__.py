"""Contact laws and the loops over contacts."""

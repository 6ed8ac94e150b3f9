"""Files of instruments: where their table begins, which column is what, times and units."""

"""The report of a study, and its tables on the screen."""

"""A diagnosis in the report, on the screen and on disk, all made from its plain data."""

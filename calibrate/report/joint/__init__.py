"""What a joint calibration leaves behind: record, section of the report, tables on the screen."""

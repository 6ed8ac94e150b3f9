"""What the commands do for joint questions: calibrate, a pilot, what they would do."""

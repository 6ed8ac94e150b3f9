"""The command `sensitivity`: what it is asked, what it would run, what it does."""

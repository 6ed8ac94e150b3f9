"""Case directories: what they hold, how they are run, what came out."""

"""What commands would do: the facts of a dry run, and of -v."""

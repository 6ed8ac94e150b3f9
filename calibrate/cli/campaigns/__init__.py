"""Commands about runs that are stored or under way."""

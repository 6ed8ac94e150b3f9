"""Fast conversion of numbers to text."""

"""The command line `bulkcal`."""

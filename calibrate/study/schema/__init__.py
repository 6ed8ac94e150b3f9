"""The tables of a study file: keys, types, names and limits of single values."""

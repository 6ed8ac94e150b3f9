"""Study files that the program writes: new ones, and old ones in the present form."""

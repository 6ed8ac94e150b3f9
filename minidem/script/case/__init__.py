"""What a script does with the folder of its case."""

"""What a script has set up, and what commands change: particles, box, lists, meshes, fixes."""

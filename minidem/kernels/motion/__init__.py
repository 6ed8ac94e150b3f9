"""What moves particles and meshes, and what counts them."""

"""How kernels become machine code and stay on disk."""

"""Values of single particles besides those that move them."""

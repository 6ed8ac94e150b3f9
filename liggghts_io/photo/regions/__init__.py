"""What stands out in a photograph of a heap, and may be the heap."""

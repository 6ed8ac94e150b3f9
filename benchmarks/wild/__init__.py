"""Scripts of strangers: which of them the engines take, and whether both compute the same."""

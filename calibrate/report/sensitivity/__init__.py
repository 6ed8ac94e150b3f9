"""What moves what, on the screen and as a page."""

"""Commands of the laboratory: what was measured with a scale, by hand, on a moving plate."""

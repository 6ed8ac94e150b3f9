"""The motion of a plate as a sum of cosines."""

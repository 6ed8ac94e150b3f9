"""Going through a script before it is executed."""

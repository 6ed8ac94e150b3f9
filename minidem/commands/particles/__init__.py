"""Commands that copy, delete, move and read particles."""

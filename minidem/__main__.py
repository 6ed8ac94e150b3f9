"""`python -m minidem -in SCRIPT`: the command, where it is not on the path."""

import sys

from minidem.cli import main

if __name__ == "__main__":
    sys.exit(main())

"""Where the `bulkcal` command starts: what Ctrl-C may meet while modules are loaded."""

from __future__ import annotations

__all__ = ["main"]

INTERRUPTED = 130


def main() -> None:
    """Load the command and run it; Ctrl-C ends it without a traceback at any time."""
    try:
        from calibrate.cli.main import main as run

        run()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None

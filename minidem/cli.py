"""The ``minidem`` command: takes what ``liggghts`` takes."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from minidem.errors import DemError
from minidem.simulate import run_script
from minidem.threads import MOST

__all__ = ["main"]


def _parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(
        prog="minidem",
        description="Run a LIGGGHTS script.",
        epilog="Example: minidem -in in.script -var seed 10007",
    )
    parser.add_argument("-in", "-i", dest="script", required=True, help="script to run")
    parser.add_argument(
        "-var", "-v", dest="variables", nargs="+", action="append", default=[],
        metavar=("NAME", "VALUE"), help="set an index-style variable",
    )  # fmt: skip
    parser.add_argument("-log", "-l", default="log.liggghts", help="log file, or none")
    parser.add_argument(
        "-echo", "-e", default="log", choices=("none", "screen", "log", "both"),
        help="where to show commands",
    )  # fmt: skip
    parser.add_argument(
        "-threads", "-t", type=_threads, default=1, metavar="N",
        help="threads that share every step, default 1; the same number gives the same result to "
        "the last bit, another one differs by rounding; worth it from some thousand particles on",
    )  # fmt: skip
    parser.add_argument("-screen", "-sc", default="", help="screen output to a file, or none")
    parser.add_argument(
        "-strict", "--strict", action="store_true",
        help="refuse the words that LIGGGHTS 3.8.0 does not have",
    )  # fmt: skip
    return parser


def _threads(word: str) -> int:
    """Read the number of threads."""
    if not word.isascii() or not word.isdigit() or not 1 <= int(word) <= MOST:
        msg = f"expected a whole number from 1 to {MOST}, found '{word[:20]}'"
        raise argparse.ArgumentTypeError(msg)
    return int(word)


def _stop(number: int, frame: object) -> None:
    """Treat SIGTERM as Ctrl-C: the step in hand and its dumps are finished first."""
    del number, frame
    raise KeyboardInterrupt


def main(argv: Sequence[str] | None = None) -> int:
    """Run a script; return 0, 2 after an error of the user or the simulation, 130 after Ctrl-C."""
    args = _parser().parse_args(argv)
    signal.signal(signal.SIGTERM, _stop)
    variables = {words[0]: words[1:] for words in args.variables}
    screen: TextIO | None = sys.stdout
    target = None
    try:
        if args.screen == "none":
            screen = None
        elif args.screen:
            target = Path(args.screen).open("w", buffering=1)  # noqa: SIM115 - closed below
            screen = target
        run_script(
            Path(args.script), root=Path.cwd(), variables=variables,
            log=None if args.log == "none" else args.log,
            echo=args.echo in ("screen", "both"), screen=screen, threads=args.threads,
            strict=args.strict,
        )  # fmt: skip
    except (DemError, OSError) as err:
        sys.stderr.write(f"minidem: {err}\n")
        return 2
    except KeyboardInterrupt:
        sys.stderr.write("minidem: interrupted; dumps written so far are complete\n")
        return 130
    finally:
        if target is not None:
            target.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

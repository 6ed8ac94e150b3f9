"""The ``minidem`` command: takes what ``liggghts`` takes."""

from __future__ import annotations

import argparse
import gc
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from minidem.errors import DemError, RunInterrupted

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


class _Signals:
    """The first Ctrl-C or SIGTERM asks for a stop between two steps; the second stops at once."""

    def __init__(self) -> None:
        self.asked = False
        wanted = (signal.SIGINT, signal.SIGTERM)
        self._before = {number: signal.signal(number, self._receive) for number in wanted}

    def restore(self) -> None:
        """Leave signals to those who handled them before."""
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _receive(self, number: int, frame: object) -> None:
        del number, frame
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True

    def stop(self) -> bool:
        """Return True after a signal."""
        return self.asked


@contextmanager
def _no_garbage() -> Iterator[None]:
    """Load modules without a search for garbage: it takes a seventh of the start and finds none."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def _threads(word: str) -> int:
    """Read the number of threads."""
    from minidem.run.threads import MOST

    if not word.isascii() or not word.isdigit() or not 1 <= int(word) <= MOST:
        msg = f"expected a whole number from 1 to {MOST}, found '{word[:20]}'"
        raise argparse.ArgumentTypeError(msg)
    return int(word)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a script; return 0, 2 after an error of the user or the simulation, 130 after Ctrl-C."""
    with _no_garbage():
        args = _parser().parse_args(argv)
        from minidem.simulate import run_script
    signals = _Signals()
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
            echo=args.echo in ("screen", "both"), screen=screen, stop=signals.stop,
            threads=args.threads,
            strict=args.strict,
        )  # fmt: skip
    except (DemError, OSError) as err:
        sys.stderr.write(f"minidem: {err}\n")
        return 2
    except RunInterrupted as err:
        kept = f"; continue with read_restart {err.restart}" if err.restart else ""
        sys.stderr.write(f"minidem: {err}; dumps written so far are complete{kept}\n")
        return 130
    except KeyboardInterrupt:
        sys.stderr.write("minidem: interrupted at once; the last dump may be incomplete\n")
        return 130
    finally:
        signals.restore()
        if target is not None:
            target.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

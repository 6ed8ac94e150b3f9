"""Runs fuzzed scripts one after the other in child processes, and judges what became of them.

A case must end in time with exit code 0 or 2, without a traceback, within the memory it is allowed;
a refusal names a place; nothing outside its folder may be read, made or changed, and no half file
may be left.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import resource
import shutil
import signal
import sys
import traceback
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType

from minidem import DemError, check_script, cli
from minidem.commands import runs
from minidem.script import control
from tests.minidem.fuzz.writer import Sample, sample

__all__ = ["judge", "judged"]

MOST_BYTES = 2 * 1024**3
"""Memory beyond what the process has at the start."""
LONGEST_S = 10
"""Processor time of a case; most take a hundredth of a second."""
GIVE_UP_S = 90
"""Wall time after which a child that says nothing is killed."""
BATCH = 100
"""Cases of a child process."""
MOST_STEPS, MOST_COMMANDS = 20, 2000
"""A run that is long because a number says so is no fault; here it is refused."""
ROUNDS = 4
"""How often lines that are refused are taken out of a script."""
SECRET = b"variable secret equal 7342\n"
_PLACE = re.compile(
    r"minidem: (?:[^\n]*?:\d+: |step \d+|cannot (?:write|open|read) |-\w+: |in\.s: |'?\S+: )"
)
_SILENT = ("ZeroDivisionError", "OverflowError", "ValueError: math domain error")
"""What an interpreted kernel says of a division by zero, and a compiled one does without a word."""
_SHORTAGE = "has not enough memory"


class _TooLong(BaseException):
    """Raised in a case that takes too long."""


def _ring(number: int, frame: FrameType | None) -> None:
    del number, frame
    raise _TooLong


def lay_out(top: Path, case: Sample) -> Path:
    """Write a case into a new folder, beside files that it must not touch; return its folder."""
    shutil.rmtree(top, ignore_errors=True)
    folder, outside = top / "case", top / "outside"
    (folder / "sub").mkdir(parents=True)
    outside.mkdir()
    (outside / "x").write_bytes(SECRET)
    for name, data in case.files.items():
        (folder / name).write_bytes(data)
    (folder / "in.s").write_bytes(case.script)
    (folder / "link").symlink_to(outside)
    (folder / "file").symlink_to(outside / "x")
    (folder / "loop").symlink_to("loop")
    return folder


def _repair(script: Path) -> None:
    """Take out the lines of a script that are refused."""
    for _ in range(ROUNDS):
        try:
            found = check_script(script, root=script.parent)
        except (DemError, UnicodeError):
            return
        wrong = {one.error.line for one in found if Path(one.error.file).name == script.name}
        lines = script.read_bytes().split(b"\n")
        if not wrong:
            return
        kept = [line for at, line in enumerate(lines, 1) if at not in wrong]
        script.write_bytes(b"\n".join(kept))


def judge(top: Path, case: Sample) -> str:
    """Run a case; return what is wrong with how it went, '' for nothing."""
    folder = lay_out(top, case)
    said, errors = io.StringIO(), io.StringIO()
    with (
        _limits(),
        contextlib.chdir(folder),
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(errors),
        warnings.catch_warnings(),
    ):
        # compiled kernels divide by zero without a word
        warnings.filterwarnings("ignore", module="minidem.kernels", category=RuntimeWarning)
        try:
            if case.repaired:
                _repair(folder / "in.s")
            code = cli.main(case.arguments)
        except SystemExit as stop:
            code = int(stop.code or 0)
        except _TooLong as late:
            return "too long: " + " < ".join(_where(late))
        except BaseException as fault:
            return f"{type(fault).__name__} left: {' < '.join(_where(fault))}"
    return _fault(top, folder, code, errors.getvalue(), said.getvalue())


def _fault(top: Path, folder: Path, code: int, errors: str, said: str) -> str:
    """Return the first thing that is wrong after a case."""
    trace = folder / cli.TRACEBACK
    if trace.exists():
        lines = [line.strip() for line in trace.read_text().splitlines() if line.strip()]
        places = [line for line in lines if line.startswith("File ")]
        if lines[-1].startswith(_SILENT) and "/minidem/kernels/" in places[-1]:
            return ""
        return f"traceback: {lines[-1][:200]} at {places[-1] if places else ''}"
    outside = top / "outside"
    wrong = {
        f"exit code {code}": code not in (0, 2),
        "something outside its folder": sorted(one.name for one in top.iterdir())
        != ["case", "outside"]
        or [one.name for one in outside.iterdir()] != ["x"]
        or (outside / "x").read_bytes() != SECRET
        or Path("/tmp/escaped").exists(),
        "reads outside its folder": "7342" in errors + said,
        "half a file": any(folder.rglob("?*.part")),
        f"memory: {errors[:200]}": _SHORTAGE in errors,
        f"no place: {errors[:200]}": code == 2
        and bool(errors)
        and "usage:" not in errors
        and not _PLACE.match(errors),
    }
    return next((text for text, is_so in wrong.items() if is_so), "")


def _where(fault: BaseException) -> list[str]:
    """Return the innermost places of an error."""
    frames = traceback.extract_tb(fault.__traceback__)[-4:]
    return [f"{Path(one.filename).name}:{one.lineno} {one.name}" for one in reversed(frames)]


@contextlib.contextmanager
def _limits() -> Iterator[None]:
    """Limit memory, processor time, steps and commands."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    limits = runs.MOST_STEPS, control.MAX_COMMANDS
    ringing = signal.signal(signal.SIGPROF, _ring)
    resource.setrlimit(resource.RLIMIT_AS, (used + MOST_BYTES, before[1]))
    runs.MOST_STEPS, control.MAX_COMMANDS = MOST_STEPS, MOST_COMMANDS
    signal.setitimer(signal.ITIMER_PROF, LONGEST_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, ringing)
        runs.MOST_STEPS, control.MAX_COMMANDS = limits
        resource.setrlimit(resource.RLIMIT_AS, before)


# -- many cases ------------------------------------------------------------------------------------


def judged(seeds: Iterable[int], scratch: Path) -> Iterator[tuple[int, str]]:
    """Run the cases of many seeds; yield each with what is wrong, '' for nothing.

    Parameters
    ----------
    seeds : iterable of int
        Seeds of `sample`.
    scratch : Path
        Folder to work in; its content is lost.
    """
    left = list(seeds)
    while left:
        batch, left = left[:BATCH], left[BATCH:]
        done = 0
        for seed, fault in _child(batch, scratch):
            done += 1
            yield seed, fault
        if done < len(batch):
            yield batch[done], "the process died or did not answer"
            left = batch[done + 1 :] + left


def _child(batch: list[int], scratch: Path) -> Iterator[tuple[int, str]]:
    """Run some cases in a process of their own, as long as it lives."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        with os.fdopen(writing, "w", encoding="utf-8") as pipe:
            for seed in batch:
                signal.alarm(GIVE_UP_S)
                fault = judge(scratch / "arena", sample(seed)).replace("\n", " | ")
                pipe.write(f"{seed}\t{fault}\n")
                pipe.flush()
        sys.stdout.flush()
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8", errors="replace") as pipe:
        for line in pipe:
            seed, _, fault = line.rstrip("\n").partition("\t")
            yield int(seed), fault
    os.waitpid(child, 0)

"""What an engine left: attempts under way, the finished output, and runs made by hand.

An engine works in a folder of its own, `attempt-...`. When it has ended, `end.json` with the
digests of all files is written there and the folder becomes `output` in one rename. Whoever finds
`output` finds a whole run; an attempt without that belongs to a process that runs or that died.
"""

from __future__ import annotations

import shutil
import uuid
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from liggghts_io.case.directory import OUTPUT
from liggghts_io.case.liggghts import SCREEN
from liggghts_io.case.mark import completed_step, last_step
from liggghts_io.case.runner import LOG
from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.files import (
    canonical_json,
    read_signed_json,
    sha256_file,
    sha256_text,
    shell_word,
    signed_json,
    write_bytes,
    write_text,
)
from liggghts_io.measure.dumps import POST, SCRIPT, check_all_dumps, last_frame_step
from liggghts_io.measure.schedule import read_schedule

END: Final = "end.json"
COMPLETE: Final = "complete"
_ATTEMPT: Final = "attempt-"
_TAIL: Final = 20  # lines
_LIGGGHTS_LOG: Final = "LIGGGHTS (Version"


@dataclass(frozen=True)
class End:
    """How a run ended.

    Attributes
    ----------
    case_id : str
    engine : str
        Engine and its version.
    exit : str
        "complete" or "failed".
    reason : str
        Why it failed.
    step, steps : int
        Last step, and the steps that the script asks for.
    wall_s : float
        Duration [s].
    files : Mapping[str, str]
        Sha256 by path in the folder, of every file but `end.json`.
    """

    case_id: str
    engine: str
    exit: str
    reason: str
    step: int
    steps: int
    wall_s: float
    files: Mapping[str, str]

    @property
    def digest(self) -> str:
        """Sha256 of all of this, by which a result names its output."""
        return sha256_text(canonical_json(asdict(self)))


def new_attempt(directory: Path, files: Mapping[str, bytes]) -> Path:
    """Make a fresh folder for an engine with the files it needs; remove those of dead processes.

    The lock is the caller's, so that no attempt that is found is under way.
    """
    clear_leftovers(directory)
    attempt = directory / f"{_ATTEMPT}{uuid.uuid4().hex[:12]}"
    for name, content in files.items():
        write_bytes(attempt / name, content)
    return attempt


def clear_leftovers(directory: Path) -> None:
    """Remove attempts and temporary files of processes that died."""
    for path in directory.glob(f"{_ATTEMPT}*"):
        shutil.rmtree(path, ignore_errors=True)
    for path in directory.glob(".*.tmp*"):
        path.unlink(missing_ok=True)


def finish(attempt: Path, end: End) -> Path:
    """Turn an attempt whose engine has ended into the output of its case.

    Parameters
    ----------
    attempt : Path
    end : End
        Its `files` as `digests` found them.

    Returns
    -------
    Path
        The output folder.
    """
    write_text(attempt / END, signed_json("end", asdict(end)))
    output = attempt.parent / OUTPUT
    if output.exists():
        output.rename(attempt.parent / f"{_ATTEMPT}{uuid.uuid4().hex[:12]}")
    attempt.rename(output)
    clear_leftovers(attempt.parent)
    return output


def digests(folder: Path) -> dict[str, str]:
    """Return the sha256 of every file in a folder but `end.json`, by path in it."""
    paths = (path for path in folder.rglob("*") if path.is_file())
    named = {path.relative_to(folder).as_posix(): path for path in paths}
    return {name: sha256_file(path) for name, path in sorted(named.items()) if name != END}


def read_end(folder: Path, identity: str) -> End:
    """Read how the run in an output folder ended, and check that it belongs to a case.

    Raises
    ------
    DamagedFile
        If the file is missing, damaged or of another case.
    """
    path = folder / END
    try:
        end = End(**read_signed_json(path, "end"))
    except (OSError, ValueError, TypeError) as err:
        msg = f"{path}: missing or damaged ({err}); run the case again with --again"
        raise DamagedFile(msg) from err
    if end.case_id != identity:
        msg = f"{path}: belongs to another case; run the case again with --again"
        raise DamagedFile(msg)
    return end


def verify(folder: Path, identity: str) -> End:
    """Check every file of an output folder against the digests in `end.json`.

    Raises
    ------
    DamagedFile
        Naming the file that was changed, is missing or was added.
    """
    end = read_end(folder, identity)
    now = digests(folder)
    for name, digest in end.files.items():
        if now.get(name) != digest:
            what = "was changed or cut since the run ended" if name in now else "is missing"
            msg = f"{folder / name}: {what}; run the case again with --again"
            raise DamagedFile(msg)
    for name in now.keys() - end.files.keys():
        msg = f"{folder / name}: was not written by the run; remove it"
        raise DamagedFile(msg)
    return end


def progress_of(folder: Path, identity: str) -> tuple[int, int]:
    """Return the last step that a run is known to have reached, and the steps it should have.

    Where the script does not tell the steps, a run whose mark is printed has reached its last one.
    """
    schedule, seen = read_schedule(folder / SCRIPT), shown(folder)
    done = last_step(seen)
    if schedule.steps is not None:
        return max(done, last_frame_step(folder)), schedule.steps
    completed = completed_step(seen, identity)
    return (done, schedule.most or done + 1) if completed is None else (completed, completed)


def check_complete(folder: Path, identity: str) -> int:
    """Return the last step of a run that completed.

    Raises
    ------
    DamagedFile
        If the log lacks the completion mark, or a frame is missing or cut; it says how far the
        run got.
    """
    done, steps = progress_of(folder, identity)
    if completed_step(read_log(folder), identity) != steps:
        msg = f"{folder}: the run stopped at step {done} of {steps}; run it again"
        raise DamagedFile(msg)
    check_all_dumps(folder, steps)
    return steps


def read_log(folder: Path) -> str:
    """Return the log of a run, empty if there is none."""
    try:
        return (folder / LOG).read_bytes().decode("utf-8", errors="replace")
    except OSError:
        return ""


def shown(folder: Path) -> str:
    """Return what an engine showed: the screen of LIGGGHTS, which loses nothing, or the log."""
    with suppress(OSError):
        return (folder / SCREEN).read_bytes().decode("utf-8", errors="replace")
    return read_log(folder)


def log_tail(folder: Path) -> str:
    """Return the last lines that an engine showed, empty if there are none."""
    return "\n".join(shown(folder).splitlines()[-_TAIL:])


def by_hand(directory: Path) -> bool:
    """Return whether an engine was started by hand in a case directory."""
    return (directory / LOG).exists() or (directory / POST).is_dir()


def find_run(directory: Path, identity: str, engine: str) -> tuple[Path, End | None]:
    """Return the folder with the finished run of a case, every file checked, and how it ended.

    Parameters
    ----------
    directory : Path
    identity, engine : str
        Of the case.

    Returns
    -------
    (Path, End or None)
        The output folder; the case directory itself and None for a run by hand.

    Raises
    ------
    CaseError
        If there is none, it did not complete, or there are two of which the one by hand is newer.
    """
    output = directory / OUTPUT
    if output.is_dir():
        end = verify(output, identity)
        if by_hand(directory) and _newer(directory / LOG, output / END):
            msg = (
                f"{directory}: holds {OUTPUT}/ and a newer run by hand; remove {OUTPUT}/, or "
                f"{LOG} and {POST}/"
            )
            raise CaseError(msg)
        return output, end
    if by_hand(directory):
        _check_by_hand(directory, identity, engine)
        return directory, None
    raise CaseError(_why_no_run(directory, identity))


def drawable_run(directory: Path, identity: str) -> Path:
    """Return the folder whose frames show a case, also of a run that failed.

    Raises
    ------
    CaseError
        If no engine left anything, or a file was changed since.
    """
    output = directory / OUTPUT
    if output.is_dir():
        verify(output, identity)
        return output
    if by_hand(directory):
        return directory
    raise CaseError(_why_no_run(directory, identity))


def _why_no_run(directory: Path, identity: str) -> str:
    for attempt in directory.glob(f"{_ATTEMPT}*"):
        with suppress(CaseError):  # of a process that died before it had copied the script
            done, steps = progress_of(attempt, identity)
            return f"{directory}: the last run stopped at step {done} of {steps}; run it again"
    return f"{directory}: has not been run; run it with 'bulkcal run {shell_word(directory)}'"


def _newer(one: Path, other: Path) -> bool:
    try:
        return one.stat().st_mtime_ns > other.stat().st_mtime_ns
    except FileNotFoundError:
        return False


def _check_by_hand(directory: Path, identity: str, engine: str) -> None:
    check_complete(directory, identity)
    used = "liggghts" if read_log(directory).startswith(_LIGGGHTS_LOG) else "minidem"
    if used != engine:
        msg = (
            f"{directory / LOG}: was written by {used}, the case is one for {engine}; generate it "
            f"with --engine {used} into another directory and run that"
        )
        raise CaseError(msg)

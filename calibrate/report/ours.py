"""Which files of a result directory are ours: others of the same names belong to a person."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.report.sections import LINKS_END
from calibrate.runs.stored import (
    DIAGNOSIS,
    DIAGNOSIS_START,
    FIGURE,
    RECORD,
    REPORT,
    SAMPLES,
    SECTION,
    SENSITIVITY,
    SENSITIVITY_PAGE,
    START,
    TABLE,
)
from liggghts_io.experiments import DEFINITION
from liggghts_io.files import shell_word

__all__ = ["default_out", "refuse_foreign"]

_OF_RESULT: Final = "_result"


def default_out(study: Path) -> Path:
    """Return where the result of a study goes that nobody named a directory for.

    Parameters
    ----------
    study : Path
        Study file.

    Returns
    -------
    Path
        Called as the file is, or `NAME_result` where that is the folder of an experiment.
    """
    path = Path(study.stem)
    return Path(f"{path}{_OF_RESULT}") if (path / DEFINITION).is_file() else path


def refuse_foreign(out: Path) -> None:
    """Refuse a directory with files of a person that a result would be written over.

    Files of ours are known by how they begin, so that a damaged one is still ours.

    Parameters
    ----------
    out : Path
        Directory of a result, which need not be there.

    Raises
    ------
    CalibrationError
        With the names of the files, or where it is the folder of an experiment.
    """
    if (out / DEFINITION).is_file():
        msg = (
            f"--out {out}: is the folder of an experiment, which holds nothing else; give another "
            f"--out, such as {shell_word(f'{out}{_OF_RESULT}')}"
        )
        raise CalibrationError(msg)
    foreign = [name for name, ours in _OURS.items() if _there(out / name) and not ours(out / name)]
    if foreign:
        them = "it" if len(foreign) == 1 else "them"
        msg = (
            f"--out {out}: holds {' and '.join(foreign)}, not written by bulkcal, and a result "
            f"would be written over {them}; move {them} away, or give another --out"
        )
        raise CalibrationError(msg)


def _there(path: Path) -> bool:
    """Whether something would be written over; a file without a word is no loss."""
    return path.is_dir() or (path.is_file() and path.stat().st_size > 0)


def _holds(*words: bytes) -> Callable[[Path], bool]:
    """Return whether a file holds one of some words."""

    def holds(path: Path) -> bool:
        try:
            content = path.read_bytes()
        except OSError:  # a folder, or a file that nobody may read
            return False
        return any(word in content for word in words)

    return holds


def _record(path: Path) -> bool:
    """Whether a file is a record of a result, also a damaged one; an empty one holds nothing."""
    return _holds(b'"study"', b'"study_sha256"', b'"joint"', b'"stages"')(path) or _empty(path)


def _empty(path: Path) -> bool:
    try:
        return path.read_bytes().strip() in (b"", b"{}")
    except OSError:
        return False


def _beside(record: str) -> Callable[[Path], bool]:
    """Return whether a file lies beside the record that is written before it."""
    return lambda path: (path.with_name(record)).is_file() and _record(path.with_name(record))


_OURS: Final[dict[str, Callable[[Path], bool]]] = {
    TABLE: _holds(b"case_id,"),
    RECORD: _record,
    REPORT: _holds(LINKS_END.encode(), b"calibration report</title>"),
    SAMPLES: _holds(b"record.npy"),
    START: _record,
    DIAGNOSIS: _record,
    FIGURE: _beside(DIAGNOSIS),
    SECTION: _beside(DIAGNOSIS),
    DIAGNOSIS_START: _record,
    SENSITIVITY: _record,
    SENSITIVITY_PAGE: _beside(SENSITIVITY),
}
"""How each file of a result is told from one of another program."""

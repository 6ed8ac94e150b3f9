"""Where a suite keeps what."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from calibrate.errors import CalibrationError

__all__ = ["FRESH", "REFUSED", "SEALS", "STUDIES", "TABLE", "TRUTHS", "Suite"]

STUDIES: Final = "studies"
SEALS: Final = "sealed.json"
TRUTHS: Final = "truths.json"
FRESH: Final = "fresh"
REFUSED: Final = "refused.txt"
"""In the folder of a study that could not be made: why."""
TABLE: Final = "runs.csv.gz"


@dataclass(frozen=True)
class Suite:
    """The folder of a suite.

    Attributes
    ----------
    path : Path
        Holds `studies/` and `sealed.json`, which who forecasts gets; `truths.json` and `fresh/`,
        which nobody gets before; and the table of its runs.
    """

    path: Path

    @property
    def is_begun(self) -> bool:
        """Whether anything was sealed."""
        return (self.path / SEALS).exists()

    def study(self, number: int) -> Path:
        """Return the folder of a study."""
        return self.path / STUDIES / f"study_{number:04d}"

    def studies(self) -> list[Path]:
        """Return the folders of the studies that are there."""
        return sorted(path.parent for path in (self.path / STUDIES).glob("*/study.toml"))

    def tried(self) -> set[str]:
        """Return the names of the studies that were made, and of those that could not be."""
        refused = {path.parent.name for path in (self.path / STUDIES).glob(f"*/{REFUSED}")}
        return refused | {path.name for path in self.studies()}

    def seals(self) -> dict[str, Any]:
        """Return rules, seed and digests.

        Raises
        ------
        CalibrationError
            If the folder is no suite.
        """
        path, remedy = self.path / SEALS, "'bulkcal challenge make' writes one"
        found = _record(path, remedy)
        if not isinstance(found.get("digests"), dict):
            msg = f"{path}: holds no digests; {remedy}"
            raise CalibrationError(msg)
        return found

    def truths(self) -> dict[str, Any]:
        """Return the truths.

        Raises
        ------
        CalibrationError
            If they are not there.
        """
        return _record(self.path / TRUTHS, "they are published after the forecasts")


def _record(path: Path, remedy: str) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except OSError as err:
        msg = f"{path}: {err.strerror}; {remedy}"
        raise CalibrationError(msg) from err
    except ValueError as err:
        msg = f"{path}: {err}; {remedy}"
        raise CalibrationError(msg) from err
    if not isinstance(found, dict):
        msg = f"{path}: no table of JSON; {remedy}"
        raise CalibrationError(msg)
    return found

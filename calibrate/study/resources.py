"""Where the ready studies lie: beside the packages in a checkout, inside the package in a wheel."""

from __future__ import annotations

from pathlib import Path

from calibrate.errors import CalibrationError

__all__ = ["bundled_particles", "bundled_study", "cases_directory"]


def cases_directory() -> Path:
    """Return the directory of the ready studies.

    Raises
    ------
    CalibrationError
        When the installation lacks them.
    """
    package = Path(__file__).resolve().parents[1]
    for place in (package / "cases", package.parent / "cases"):
        if place.is_dir():
            return place
    msg = f"{package}: the bundled cases are missing; install bulkcal again"
    raise CalibrationError(msg)


def bundled_particles() -> Path:
    """Return the table of the particles that come with the program."""
    return cases_directory() / "proppants" / "particles.csv"


def bundled_study(name: str = "hsp13_steel") -> Path:
    """Return the file of a bundled study."""
    return cases_directory() / "proppants" / f"{name}.toml"
